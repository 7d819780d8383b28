#include "lib/campaign/batch_jobs.h"

#include <poll.h>

#include <algorithm>
#include <deque>
#include <map>
#include <memory>

#include "lib/base/error.h"
#include "lib/base/machine.h"
#include "lib/campaign/job_server.h"

namespace pbf::campaign_module {
namespace {

constexpr int kLookEvery = 10;       // ms, whether a process has ended
constexpr int kLostInARow = 3;       // servers without a success, before there are no more
constexpr double kMostMemory = 0.9;  // of what is free, for jobs that share a process
constexpr double kNoLimit = 1e30;    // bytes

class Jobs {
 public:
  Jobs(const JobLimits& limits, const std::vector<JobNeeds>& needs,
       const std::function<std::vector<std::string>(std::size_t)>& args,
       const std::function<bool()>& stop,
       const std::function<void(std::size_t, const JobEnd&)>& ended)
      : limits_(limits), needs_(needs), args_(args), stop_(stop), ended_(ended) {
    for (std::size_t k = 0; k < needs.size(); ++k)
      (needs[k].shares ? shared_ : alone_).push_back(k);
  }

  void run() {
    while (!running_.empty() || under_way() > 0 ||
           (!(alone_.empty() && shared_.empty()) && !stop_())) {
      if (stop_()) {
        terminate();
      } else {
        give();
        start();
      }
      const bool looked = look_at_servers(), ended = look_at_processes();
      if (!looked && !ended) wait();
    }
  }

 private:
  std::size_t under_way() const {
    std::size_t sum = 0;
    for (const auto& s : servers_) sum += s->jobs().size();
    return sum;
  }

  void terminate() {
    if (told_) return;
    for (const auto& [job, child] : running_) child->terminate();
    for (const auto& s : servers_) s->terminate();
    told_ = true;
  }

  /// Starts processes of their own.
  void start() {
    while (running_.size() < std::size_t(limits_.alone) && !alone_.empty() && !stop_()) {
      const std::size_t job = alone_.front();
      try {
        running_.emplace(job, std::make_unique<Child>(args_(job)));
      } catch (const Error&) {
        if (running_.empty()) throw;
        break;  // continue with fewer processes: the next one waits until one ends
      }
      alone_.pop_front();
    }
  }

  /// Without servers all jobs are alone.
  void share_no_more() {
    alone_.insert(alone_.end(), shared_.begin(), shared_.end());
    shared_.clear();
  }
  void serve(int device) {
    try {
      servers_.push_back(std::make_unique<JobServer>(device));
    } catch (const Error&) {
      lost_ = kLostInARow;
    }
  }

  /// Gives jobs to servers, and starts those.
  void give() {
    if (shared_.empty()) return;
    if (lost_ >= kLostInARow) return share_no_more();
    for (int d = 0; d < devices_; ++d)
      if (std::ranges::none_of(servers_, [&](const auto& s) { return s->device() == d; })) serve(d);
    for (const auto& s : servers_) {
      if (!s->takes_jobs()) continue;
      devices_ = std::max(devices_, s->devices());
      while (!shared_.empty() && !stop_() && has_room(*s, shared_.front())) {
        const std::size_t job = shared_.front();
        shared_.pop_front();
        if ((s->devices() == 0 && needs_[job].device) || !s->give(job, args_(job)))
          alone_.push_back(job);
      }
    }
  }

  bool has_room(const JobServer& s, std::size_t job) const {
    if (s.jobs().empty()) return true;
    JobNeeds sum = needs_[job];
    std::int64_t before = 0;
    for (const std::size_t k : s.jobs()) {
      before += needs_[k].particles;
      sum.device_bytes += needs_[k].device_bytes;
      sum.host_bytes += needs_[k].host_bytes;
    }
    return s.jobs().size() < std::size_t(limits_.shared) && before < limits_.particles &&
           double(sum.device_bytes) <
               kMostMemory * (s.devices() > 0 ? double(s.free_bytes()) : kNoLimit) &&
           double(sum.host_bytes) * double(servers_.size()) < kMostMemory * host_;
  }

  bool look_at_servers() {
    bool any = false;
    for (const auto& s : servers_)
      any |= s->look([&](std::size_t job, const JobEnd& end) { server_told(*s, job, end); });
    std::erase_if(servers_, [&](const std::unique_ptr<JobServer>& s) {
      if (!s->gone()) return false;
      for (const std::size_t job : s->jobs()) alone_.push_back(job);
      if (!s->jobs().empty() || !s->ready()) ++lost_;
      any = true;
      return true;
    });
    return any;
  }
  void server_told(JobServer& s, std::size_t job, const JobEnd& end) {
    const bool doubtful = end.code == static_cast<int>(ExitCode::internal) ||
                          end.code == static_cast<int>(ExitCode::unavailable);
    if (!doubtful) {
      lost_ = 0;
      return ended_(job, end);
    }
    alone_.push_back(job);
    if (s.takes_jobs()) ++lost_;
    s.end();  // its GPU may be of no more use
  }

  bool look_at_processes() {
    return std::erase_if(running_, [&](const auto& r) {
             const std::optional<JobEnd> end = r.second->end();
             if (end) ended_(r.first, *end);
             return end.has_value();
           }) > 0;
  }

  void wait() const {
    std::vector<pollfd> all;
    for (const auto& s : servers_) all.push_back({s->fd(), POLLIN, 0});
    ::poll(all.data(), all.size(), kLookEvery);
  }

  const JobLimits& limits_;
  const std::vector<JobNeeds>& needs_;
  const std::function<std::vector<std::string>(std::size_t)>& args_;
  const std::function<bool()>& stop_;
  const std::function<void(std::size_t, const JobEnd&)>& ended_;
  std::deque<std::size_t> alone_, shared_;  ///< not started yet
  std::map<std::size_t, std::unique_ptr<Child>> running_;
  std::vector<std::unique_ptr<JobServer>> servers_;
  const double host_ = available_memory() > 0 ? double(available_memory()) : kNoLimit;
  int lost_ = 0, devices_ = 1;  ///< servers lost in a row; GPUs, as the first server says
  bool told_ = false;
};

}  // namespace

void run_jobs(const JobLimits& limits, const std::vector<JobNeeds>& needs,
              const std::function<std::vector<std::string>(std::size_t)>& args,
              const std::function<bool()>& stop,
              const std::function<void(std::size_t, const JobEnd&)>& ended) {
  Jobs(limits, needs, args, stop, ended).run();
}

}  // namespace pbf::campaign_module
