// Messages between a batch and a process that serves it: lists of texts over a socket.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pbf::campaign_module {

using Message = std::vector<std::string>;

/// One end of a pair of connected sockets, which keep the bounds of messages. Texts have no zeros
/// in them.
class JobChannel {
 public:
  explicit JobChannel(int fd) : fd_(fd) {}
  JobChannel(JobChannel&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  JobChannel& operator=(JobChannel&&) = delete;
  ~JobChannel();
  /// Both ends; neither is inherited by programs that this process starts. Throws
  /// Error(unavailable).
  static std::pair<JobChannel, JobChannel> pair();

  /// 0 when the other end gets it, or an errno: EMSGSIZE when it is too long, EAGAIN when there is
  /// no room and it shall not wait, others when the other end is gone.
  int send(const Message& message, bool wait) const;
  /// The next message; waits for it if it shall. None when none has come, or the other end is gone.
  std::optional<Message> receive(bool wait);
  bool gone() const { return gone_; }  ///< the other end, and all it sent was received
  void end() const;                    ///< the other end hears that no more will be sent
  int fd() const { return fd_; }

 private:
  int fd_;
  bool gone_ = false;
};

}  // namespace pbf::campaign_module
