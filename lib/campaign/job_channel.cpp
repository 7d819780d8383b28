#include "lib/campaign/job_channel.h"

#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "lib/base/error.h"

namespace pbf::campaign_module {

JobChannel::~JobChannel() {
  if (fd_ >= 0) ::close(fd_);
}

std::pair<JobChannel, JobChannel> JobChannel::pair() {
  int fds[2];
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, fds) != 0)
    throw Error(ExitCode::unavailable,
                std::string("batch: no socket can be made: ") + std::strerror(errno));
  return {JobChannel(fds[0]), JobChannel(fds[1])};
}

int JobChannel::send(const Message& message, bool wait) const {
  std::string bytes;
  for (const std::string& text : message) bytes += text + '\0';
  ssize_t sent = -1;
  const int flags = MSG_NOSIGNAL | (wait ? 0 : MSG_DONTWAIT);
  do sent = ::send(fd_, bytes.data(), bytes.size(), flags);
  while (sent < 0 && errno == EINTR);
  return sent < 0 ? errno : 0;
}

std::optional<Message> JobChannel::receive(bool wait) {
  const auto look = [&](void* to, std::size_t size, int flags) {
    ssize_t got = -1;
    do got = ::recv(fd_, to, size, flags | (wait ? 0 : MSG_DONTWAIT));
    while (got < 0 && errno == EINTR);
    return got;
  };
  const ssize_t size = look(nullptr, 0, MSG_PEEK | MSG_TRUNC);
  if (size <= 0) {
    gone_ = size == 0 || (errno != EAGAIN && errno != EWOULDBLOCK);
    return {};
  }
  std::string bytes(static_cast<std::size_t>(size), '\0');
  if (look(bytes.data(), bytes.size(), 0) != size) return {};
  Message message;
  for (std::size_t at = 0, end = 0; at < bytes.size(); at = end + 1) {
    end = bytes.find('\0', at);
    if (end == std::string::npos) end = bytes.size();
    message.push_back(bytes.substr(at, end - at));
  }
  return message;
}

void JobChannel::end() const { ::shutdown(fd_, SHUT_WR); }

}  // namespace pbf::campaign_module
