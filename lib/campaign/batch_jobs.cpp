#include "lib/campaign/batch_jobs.h"

#include <fmt/core.h>
#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <deque>
#include <map>
#include <memory>

#include "lib/base/error.h"
#include "lib/base/machine.h"
#include "lib/campaign/job_server.h"

namespace pbf::campaign_module {
namespace {

constexpr int kLookEvery = 10;       // ms, whether a process has ended
constexpr int kLostInARow = 3;       // servers of a GPU without a success, before it has no more
constexpr double kMostMemory = 0.9;  // of what is free, for jobs that share a process

class Jobs {
 public:
  Jobs(const JobLimits& limits, const std::vector<JobNeeds>& needs, const JobCalls& calls)
      : limits_(limits), needs_(needs), calls_(calls) {
    for (std::size_t k = 0; k < needs.size(); ++k)
      (needs[k].shares ? shared_ : alone_).push_back(k);
  }

  void run() {
    while (!running_.empty() || under_way() > 0 || (waiting() && !calls_.stop())) {
      if (calls_.stop()) {
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
  using Servers = std::vector<std::unique_ptr<JobServer>>;

  bool waiting() const { return !(alone_.empty() && shared_.empty() && again_.empty()); }
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

  /// Starts processes of their own: of jobs that are repeated only when no server has memory and
  /// devices that they may lack.
  void start() {
    if (shared_.empty() && under_way() == 0 && !again_.empty()) {
      for (const auto& s : servers_) s->end();
      if (servers_.empty()) {
        alone_.insert(alone_.end(), again_.begin(), again_.end());
        again_.clear();
      }
    }
    while (running_.size() < std::size_t(limits_.alone) && !alone_.empty() && !calls_.stop()) {
      const std::size_t job = alone_.front();
      try {
        running_.emplace(job, std::make_unique<Child>(calls_.args(job)));
      } catch (const Error&) {
        if (running_.empty() && under_way() == 0) throw;
        break;  // continue with fewer processes: the next one waits until one ends
      }
      alone_.pop_front();
    }
  }

  int& lost(int device) { return lost_[device]; }
  bool works(int device) { return lost(device) < kLostInARow; }
  void serve(int device) {
    try {
      servers_.push_back(std::make_unique<JobServer>(device));
    } catch (const Error&) {
      lost(device) = kLostInARow;
    }
  }

  /// Gives jobs to servers, the one with the fewest first, and starts those. Jobs without a GPU go
  /// to the first server; it says how many GPUs there are.
  void give() {
    if (shared_.empty()) return;
    const int wanted = needs_[shared_.front()].device ? devices_ : 1;
    bool any = false;
    for (int d = 0; d < wanted; ++d) {
      if (!works(d)) continue;
      any = true;
      if (std::ranges::none_of(servers_,
                               [&](const auto& s) { return s->device() == d && !s->ending(); }))
        serve(d);
    }
    if (!any) {
      calls_.note("runs share no process any more: each has one of its own");
      alone_.insert(alone_.end(), shared_.begin(), shared_.end());
      return shared_.clear();
    }
    while (!shared_.empty() && !calls_.stop()) {
      JobServer* s = least_busy();
      if (!s || !s->ready() || !has_room(*s, shared_.front()) || !give_next(*s)) return;
    }
  }
  /// Of those that take jobs, or soon will.
  JobServer* least_busy() {
    JobServer* least = nullptr;
    for (const auto& s : servers_) {
      if (s->ending() || (s->device() > 0 && !needs_[shared_.front()].device)) continue;
      devices_ = std::max(devices_, s->devices());
      if (s->ready() && s->device() > 0 && s->devices() == 0) {  // a GPU that does not work
        lost(s->device()) = kLostInARow;
        s->end();
      } else if (!least || s->jobs().size() < least->jobs().size()) {
        least = s.get();
      }
    }
    return least;
  }
  /// False if no more can be given now.
  bool give_next(JobServer& s) {
    const std::size_t job = shared_.front();
    shared_.pop_front();
    if (needs_[job].device && s.devices() == 0) return alone_.push_back(job), true;
    const int reason = s.give(job, calls_.args(job));
    if (reason == EMSGSIZE) return alone_.push_back(job), true;
    if (reason == 0) return true;
    shared_.push_front(job);
    if (reason != EAGAIN) s.end();  // it cannot be reached, and is soon gone
    return false;
  }

  bool has_room(const JobServer& s, std::size_t job) const {
    if (under_way() == 0 && running_.empty()) return true;
    std::int64_t device = needs_[job].device_bytes, host = needs_[job].host_bytes, before = 0;
    for (const auto& each : servers_)
      for (const std::size_t k : each->jobs()) {
        host += needs_[k].host_bytes;
        if (each.get() != &s) continue;
        before += needs_[k].particles;
        device += needs_[k].device_bytes;
      }
    for (const auto& [k, child] : running_) host += needs_[k].host_bytes;
    const bool fits = s.jobs().empty() || s.devices() == 0 ||
                      double(device) < kMostMemory * double(s.free_bytes());
    return s.jobs().size() < std::size_t(limits_.shared) && before < limits_.particles && fits &&
           (host_ == 0 || double(host) < kMostMemory * double(host_));
  }

  bool look_at_servers() {
    bool any = false;
    for (const auto& s : servers_)
      any |= s->look([&](std::size_t job, const JobEnd& end) { server_told(*s, job, end); });
    std::erase_if(servers_, [&](const std::unique_ptr<JobServer>& s) {
      if (!s->gone()) return false;
      again_.insert(again_.end(), s->jobs().begin(), s->jobs().end());
      if (!s->jobs().empty() || !s->ready()) {
        ++lost(s->device());
        calls_.note(
            fmt::format("a process that runs share has ended{}; {} under way in it are "
                        "repeated by themselves at the end",
                        s->last_words(), s->jobs().size()));
      }
      return any = true;
    });
    return any;
  }
  void server_told(JobServer& s, std::size_t job, const JobEnd& end) {
    const auto is = [&](ExitCode code) { return end.code == static_cast<int>(code); };
    if (is(ExitCode::internal) || is(ExitCode::unavailable) || is(ExitCode::io)) {
      again_.push_back(job);
      calls_.note("a run that shares a process has failed, and is repeated by itself at the end: " +
                  end.message);
      if (is(ExitCode::io)) return;
      if (!s.ending()) ++lost(s.device());
      return s.end();  // its GPU may be of no more use
    }
    lost(s.device()) = 0;
    if (is(ExitCode::resumable) && !calls_.stop()) s.end();  // it was asked to stop, not the batch
    calls_.ended(job, end);
  }

  bool look_at_processes() {
    return std::erase_if(running_, [&](const auto& r) {
             const std::optional<JobEnd> end = r.second->end();
             if (end) calls_.ended(r.first, *end);
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
  const JobCalls& calls_;
  std::deque<std::size_t> alone_, shared_, again_;  ///< not started; again_: failed in a server
  std::map<std::size_t, std::unique_ptr<Child>> running_;
  Servers servers_;
  const std::size_t host_ = available_memory();  ///< bytes, 0: not known
  std::map<int, int> lost_;                      ///< servers in a row, by device
  int devices_ = 1;
  bool told_ = false;
};

}  // namespace

void run_jobs(const JobLimits& limits, const std::vector<JobNeeds>& needs, const JobCalls& calls) {
  Jobs(limits, needs, calls).run();
}

}  // namespace pbf::campaign_module
