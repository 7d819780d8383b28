// What the ranks of a run say to each other: messages between two of them, and operations in which
// all take part. Every rank makes the same calls in the same order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace pbf::exec_module {

/// Bytes for another rank.
struct Outgoing {
  int to;
  const void* data;
  std::size_t bytes;
};
/// Bytes from another rank: as many as it sends.
struct Incoming {
  int from;
  void* data;
  std::size_t bytes;
};
using TakePart = std::function<void(const std::vector<char>&)>;

/// Messages and bytes that a rank has sent to others so far, apart from sums and commands.
struct Traffic {
  std::int64_t messages = 0, bytes = 0;
  bool operator==(const Traffic&) const = default;
};

/// One per rank. A call throws Error(unavailable) if another rank has failed, and does not return
/// if the ranks are processes: then all of them end.
class Communicator {
 public:
  virtual ~Communicator() = default;
  virtual int rank() const = 0;
  virtual int size() const = 0;  ///< number of ranks
  /// Number of this rank among those of its machine; -1: they are threads of one process.
  virtual int local_rank() const = 0;
  /// For the run file: "Open MPI v4.1.4", "threads".
  virtual std::string describe() const = 0;

  /// Sends and receives at the same time, at most one message for each ordered pair of ranks.
  /// Returns when all has arrived and what was sent may change.
  virtual void exchange(std::span<const Outgoing> out, std::span<const Incoming> in) = 0;
  /// The bytes of all ranks, equally many of each, in the order of ranks.
  virtual std::vector<char> all_gather(const void* mine, std::size_t bytes) = 0;
  /// Each value becomes its sum over all ranks, modulo 2^64.
  virtual void sum(std::span<std::int64_t> values) = 0;
  /// Calls take(bytes) on rank 0 for the bytes of every rank, in the order of ranks.
  virtual void gather(std::vector<char> mine, const TakePart& take) = 0;
  /// The bytes of rank 0 on all ranks. A rank that waits for it leaves its core to others.
  virtual void broadcast(std::vector<char>& bytes) = 0;
  /// Returns when done() is true, which is asked again and again. done: depends on other ranks, but
  /// not through this object.
  virtual void wait_until(const std::function<bool()>& done);
  /// Tells the other ranks that this one has failed, so that none waits for it, and ends what waits
  /// for them. To be called before the memory of a device is freed: that waits for the device, and
  /// the device may wait for a rank that is gone. code: with which processes end.
  void fail(const std::string& why, int code) noexcept;

  Traffic sent{};
  /// By owner, what fail() calls to end waiting for other ranks outside of this object.
  std::map<const void*, std::function<void()>> end_waiting;

 private:
  virtual void tell_failure(const std::string& why, int code) noexcept = 0;
};

/// On each rank the bytes part(rank) of rank 0, which makes them one after the other.
std::vector<char> scatter(Communicator& ranks, const std::function<std::vector<char>(int)>& part);

}  // namespace pbf::exec_module
