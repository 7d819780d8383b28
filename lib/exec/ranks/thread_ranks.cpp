#include "lib/exec/ranks/thread_ranks.h"

#include <condition_variable>
#include <cstring>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>

#include "lib/base/error.h"

namespace pbf::exec_module {
namespace {

/// What the threads share: messages that have not been taken, and who has failed.
class Exchange {
 public:
  explicit Exchange(int ranks) : ranks_(ranks), boxes_(std::size_t(ranks) * std::size_t(ranks)) {}
  int ranks() const { return ranks_; }

  void put(int from, int to, std::vector<char> bytes) {
    {
      const std::lock_guard lock(mutex_);
      box(from, to).push_back(std::move(bytes));
    }
    changed_.notify_all();
  }
  std::vector<char> take(int from, int to) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !box(from, to).empty() || failed_; });
    if (box(from, to).empty()) throw Error(ExitCode::unavailable, why_);
    std::vector<char> bytes = std::move(box(from, to).front());
    box(from, to).pop_front();
    return bytes;
  }
  void fail(const std::string& why) {
    {
      const std::lock_guard lock(mutex_);
      if (!failed_) why_ = why;
      failed_ = true;
    }
    changed_.notify_all();
  }

 private:
  std::deque<std::vector<char>>& box(int from, int to) {
    return boxes_[std::size_t(from) * std::size_t(ranks_) + std::size_t(to)];
  }
  const int ranks_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::deque<std::vector<char>>> boxes_;
  bool failed_ = false;
  std::string why_;
};

class ThreadRank final : public Communicator {
 public:
  ThreadRank(Exchange& exchange, int rank) : exchange_(exchange), rank_(rank) {}
  int rank() const override { return rank_; }
  int size() const override { return exchange_.ranks(); }
  int local_rank() const override { return -1; }
  std::string describe() const override { return "threads"; }

  void exchange(std::span<const Outgoing> out, std::span<const Incoming> in) override {
    for (const Outgoing& o : out) send(o.to, bytes_of(o.data, o.bytes));
    for (const Incoming& i : in) {
      const std::vector<char> bytes = exchange_.take(i.from, rank_);
      if (bytes.size() != i.bytes)
        throw Error(ExitCode::internal, "a message of another size than its receiver expects");
      if (i.bytes) std::memcpy(i.data, bytes.data(), i.bytes);
    }
  }
  std::vector<char> all_gather(const void* mine, std::size_t bytes) override {
    to_others(bytes_of(mine, bytes));
    std::vector<char> all;
    for (int r = 0; r < size(); ++r) {
      const std::vector<char> one = r == rank_ ? bytes_of(mine, bytes) : exchange_.take(r, rank_);
      all.insert(all.end(), one.begin(), one.end());
    }
    return all;
  }
  void sum(std::span<std::int64_t> values) override {
    const std::vector<char> all = all_gather(values.data(), values.size_bytes());
    std::vector<std::uint64_t> sums(values.size());
    for (std::size_t k = 0; k < sums.size() * std::size_t(size()); ++k) {
      std::uint64_t term;
      std::memcpy(&term, all.data() + k * sizeof term, sizeof term);
      sums[k % sums.size()] += term;
    }
    std::memcpy(values.data(), sums.data(), values.size_bytes());
  }
  void gather(std::vector<char> mine, const TakePart& take) override {
    if (rank_ != 0) return exchange_.put(rank_, 0, std::move(mine));
    take(mine);
    for (int r = 1; r < size(); ++r) take(exchange_.take(r, 0));
  }
  void broadcast(std::vector<char>& bytes) override {
    if (rank_ == 0)
      to_others(bytes);
    else
      bytes = exchange_.take(0, rank_);
  }

 private:
  void tell_failure(const std::string& why, int) noexcept override { exchange_.fail(why); }
  static std::vector<char> bytes_of(const void* data, std::size_t bytes) {
    const char* at = static_cast<const char*>(data);
    return {at, at + bytes};
  }
  void send(int to, std::vector<char> bytes) {
    ++sent.messages;
    sent.bytes += std::int64_t(bytes.size());
    exchange_.put(rank_, to, std::move(bytes));
  }
  void to_others(const std::vector<char>& bytes) {
    for (int r = 0; r < size(); ++r)
      if (r != rank_) exchange_.put(rank_, r, bytes);
  }
  Exchange& exchange_;
  const int rank_;
};

}  // namespace

void run_thread_ranks(int ranks, const std::function<void(Communicator&)>& work) {
  Exchange exchange(ranks);
  std::mutex mutex;
  std::exception_ptr first;
  const auto run = [&](int rank) {
    ThreadRank mine(exchange, rank);
    try {
      work(mine);
    } catch (const std::exception& e) {
      const std::lock_guard lock(mutex);
      if (!first) first = std::current_exception();
      mine.fail("rank " + std::to_string(rank) + ": " + e.what(), 1);
    }
  };
  std::vector<std::thread> others;
  for (int r = 1; r < ranks; ++r) others.emplace_back(run, r);
  run(0);
  for (std::thread& t : others) t.join();
  if (first) std::rethrow_exception(first);
}

}  // namespace pbf::exec_module
