#include "lib/campaign/batch_jobs.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <iterator>
#include <thread>

#include "lib/base/error.h"
#include "lib/run/signals.h"

namespace pbf::campaign_module {
namespace {

/// The error message in the text that a child wrote to stderr.
std::string error_line(int fd) {
  std::ifstream in("/proc/self/fd/" + std::to_string(fd));  // from its first byte
  const std::string text(std::istreambuf_iterator<char>(in), {});
  const std::string mark = "pbf: error: ";
  const std::size_t at = text.rfind(mark);
  if (at == std::string::npos) return {};
  std::string line = text.substr(at + mark.size());
  line.erase(line.find_last_not_of('\n') + 1);
  std::ranges::replace(line, '\n', ' ');
  return line;
}

struct Job {
  pid_t pid;
  std::size_t index;
  int err;  // file descriptor of its stderr
};

Job start(std::size_t index, const std::vector<std::string>& args) {
  // Allocate everything before the fork: only system calls may follow it.
  std::vector<std::string> texts{"pbf"};
  texts.insert(texts.end(), args.begin(), args.end());
  std::vector<char*> argv;
  for (std::string& t : texts) argv.push_back(t.data());
  argv.push_back(nullptr);
  const int err = memfd_create("pbf-batch", MFD_CLOEXEC);
  const int out = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  const pid_t parent = getpid();
  const HeldSignals held;  // a signal may come before the run has its handlers
  const pid_t pid = err < 0 || out < 0 ? -1 : fork();
  if (pid < 0) {
    const int reason = errno;
    for (const int fd : {err, out})
      if (fd >= 0) ::close(fd);
    throw Error(ExitCode::unavailable,
                std::string("batch: no process can be started: ") + std::strerror(reason) +
                    "; raise the limit on processes (ulimit -u, or pids of a container), or lower "
                    "--jobs");
  }
  if (pid == 0) {
    setpgid(0, 0);  // Ctrl-C in the terminal reaches only the batch, which forwards it
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != parent || dup2(out, 1) < 0 || dup2(err, 2) < 0) _exit(1);
    execv("/proc/self/exe", argv.data());
    _exit(1);
  }
  ::close(out);
  return {pid, index, err};
}

}  // namespace

void run_jobs(int jobs, std::size_t count,
              const std::function<std::vector<std::string>(std::size_t)>& args,
              const std::function<bool()>& stop,
              const std::function<void(std::size_t, const JobEnd&)>& ended) {
  std::vector<Job> running;
  std::size_t next = 0;
  bool told = false;
  while (!running.empty() || (next < count && !stop())) {
    while (running.size() < std::size_t(jobs) && next < count && !stop()) {
      try {
        running.push_back(start(next, args(next)));
      } catch (const Error&) {
        if (running.empty()) throw;
        break;  // continue with fewer processes: the next one waits until one ends
      }
      ++next;
    }
    if (stop() && !told) {
      for (const Job& j : running) ::kill(j.pid, SIGTERM);
      told = true;
    }
    bool any = false;
    for (std::size_t k = 0; k < running.size();) {
      int status = 0;
      if (::waitpid(running[k].pid, &status, WNOHANG) != running[k].pid) {
        ++k;
        continue;
      }
      any = true;
      const Job job = running[k];
      running.erase(running.begin() + static_cast<std::ptrdiff_t>(k));
      JobEnd end;
      end.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
      end.message = error_line(job.err);
      ::close(job.err);
      ended(job.index, end);
    }
    if (!any) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

}  // namespace pbf::campaign_module
