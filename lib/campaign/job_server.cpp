#include "lib/campaign/job_server.h"

#include <cstdlib>
#include <mutex>
#include <thread>
#include <utility>

#include "lib/base/error.h"
#include "lib/base/plain_text.h"
#include "lib/base/start_thread.h"
#include "lib/exec/devices.h"

namespace pbf::campaign_module {
namespace {

constexpr std::size_t kMostText = 8000;  // bytes of a message of a run
constexpr const char* kVisible = "CUDA_VISIBLE_DEVICES";

/// The environment in which GPU number `device` of this process is the only one. The first one is
/// the first of all there are.
std::vector<std::string> only_device(int device) {
  if (device == 0) return {};
  std::string name = std::to_string(device);
  if (const char* visible = std::getenv(kVisible)) {
    std::string rest = visible;
    for (int k = 0; k < device && !rest.empty(); ++k) {
      const std::size_t comma = rest.find(',');
      rest = comma == std::string::npos ? "" : rest.substr(comma + 1);
    }
    name = rest.substr(0, rest.find(','));
  }
  return {std::string(kVisible) + "=" + name};
}

/// The jobs under way in this process.
class Serving {
 public:
  Serving(JobChannel& channel, const std::function<JobEnd(const std::vector<std::string>&)>& run)
      : channel_(channel), run_(run) {}
  ~Serving() {
    for (auto& [name, thread] : threads_) thread.join();
  }
  void start(Message message) {
    join_ended();
    const std::string job = message.at(0);
    try {
      threads_.emplace_back(
          job, start_thread([this, job, args = Message(message.begin() + 1, message.end())] {
            tell(job, run_(args));
          }));
    } catch (const Error& e) {
      tell(job, {static_cast<int>(e.code()), e.what()});
    }
  }

 private:
  void tell(const std::string& job, const JobEnd& end) {
    const std::lock_guard alone(mutex_);
    channel_.send({job, std::to_string(end.code), one_line(end.message, kMostText)}, true);
    ended_.insert(job);
  }
  void join_ended() {
    std::set<std::string> ended;
    {
      const std::lock_guard alone(mutex_);
      ended = std::exchange(ended_, {});
    }
    std::erase_if(threads_, [&](auto& t) {
      if (!ended.contains(t.first)) return false;
      t.second.join();
      return true;
    });
  }

  JobChannel& channel_;
  const std::function<JobEnd(const std::vector<std::string>&)>& run_;
  std::mutex mutex_;  // for sending, and for ended_
  std::set<std::string> ended_;
  std::vector<std::pair<std::string, std::thread>> threads_;
};

}  // namespace

void serve_jobs(int fd, const std::function<JobEnd(const std::vector<std::string>&)>& run) {
  JobChannel channel(fd);
  const DeviceRoom room = device_room();
  channel.send({std::to_string(room.devices), std::to_string(room.free_bytes)}, true);
  Serving serving(channel, run);
  while (std::optional<Message> message = channel.receive(true)) serving.start(*message);
}

JobServer::JobServer(int device) : JobServer(JobChannel::pair(), device) {}

JobServer::JobServer(std::pair<JobChannel, JobChannel> ends, int device)
    : device_(device),
      child_(
          std::make_unique<Child>(Message{kServeCommand}, ends.second.fd(), only_device(device))),
      channel_(std::move(ends.first)) {}

int JobServer::give(std::size_t job, const std::vector<std::string>& args) {
  Message message{std::to_string(job)};
  message.insert(message.end(), args.begin(), args.end());
  const int reason = channel_.send(message, false);
  if (reason == 0) jobs_.insert(job);
  return reason;
}

std::string JobServer::last_words() {
  const JobEnd end = child_->wait();
  if (!end.message.empty()) return ": " + end.message;
  return end.code > 128 ? ": killed by signal " + std::to_string(end.code - 128) : "";
}

void JobServer::end() {
  channel_.end();
  ending_ = true;
}

bool JobServer::look(const std::function<void(std::size_t, const JobEnd&)>& ended) {
  bool any = false;
  while (const std::optional<Message> message = channel_.receive(false)) {
    any = true;
    if (!ready_) {
      devices_ = std::stoi(message->at(0));
      free_ = std::stoll(message->at(1));
      ready_ = true;
      continue;
    }
    const std::size_t job = std::stoull(message->at(0));
    jobs_.erase(job);
    ended(job, {std::stoi(message->at(1)), message->at(2)});
  }
  return any;
}

}  // namespace pbf::campaign_module
