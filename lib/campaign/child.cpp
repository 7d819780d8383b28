#include "lib/campaign/child.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <iterator>

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
  return job_message(text.substr(at + mark.size()));
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> all;
  for (std::string& t : texts) all.push_back(t.data());
  all.push_back(nullptr);
  return all;
}

/// The environment of this process with other values.
std::vector<std::string> changed_environment(const std::vector<std::string>& changes) {
  std::vector<std::string> all = changes;
  for (char** e = environ; *e; ++e) {
    const std::string entry = *e, name = entry.substr(0, entry.find('=') + 1);
    if (std::ranges::none_of(changes, [&](const auto& c) { return c.starts_with(name); }))
      all.push_back(entry);
  }
  return all;
}

}  // namespace

std::string job_message(std::string text) {
  text.erase(text.find_last_not_of('\n') + 1);
  std::ranges::replace(text, '\n', ' ');
  return text;
}

Child::Child(const std::vector<std::string>& args, int input,
             const std::vector<std::string>& environment) {
  // Allocate everything before the fork: only system calls may follow it.
  std::vector<std::string> words{"pbf"}, values = changed_environment(environment);
  words.insert(words.end(), args.begin(), args.end());
  const std::vector<char*> argv = pointers(words), envp = pointers(values);
  err_ = memfd_create("pbf-batch", MFD_CLOEXEC);
  const int out = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  const pid_t parent = getpid();
  const HeldSignals held;  // a signal may come before the run has its handlers
  pid_ = err_ < 0 || out < 0 ? -1 : fork();
  if (pid_ < 0) {
    const int reason = errno;
    for (const int fd : {err_, out})
      if (fd >= 0) ::close(fd);
    throw Error(ExitCode::unavailable,
                std::string("batch: no process can be started: ") + std::strerror(reason) +
                    "; raise the limit on processes (ulimit -u, or pids of a container), or lower "
                    "--jobs");
  }
  if (pid_ == 0) {
    setpgid(0, 0);  // Ctrl-C in the terminal reaches only the batch, which forwards it
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != parent || dup2(out, 1) < 0 || dup2(err_, 2) < 0) _exit(1);
    if (input >= 0 && dup2(input, 0) < 0) _exit(1);
    execve("/proc/self/exe", argv.data(), envp.data());
    _exit(1);
  }
  ::close(out);
}

Child::~Child() {
  terminate();
  wait();
  ::close(err_);
}

void Child::terminate() const {
  if (!end_) ::kill(pid_, SIGTERM);
}

JobEnd Child::ended(int status) {
  end_ = {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), error_line(err_)};
  return *end_;
}

std::optional<JobEnd> Child::end() {
  int status = 0;
  if (end_) return end_;
  const pid_t found = ::waitpid(pid_, &status, WNOHANG);
  if (found == pid_) ended(status);
  if (found < 0 && errno != EINTR) end_ = JobEnd{-1, ""};
  return end_;
}

JobEnd Child::wait() {
  int status = 0;
  while (!end_)
    if (::waitpid(pid_, &status, 0) == pid_)
      ended(status);
    else if (errno != EINTR)
      end_ = JobEnd{-1, ""};
  return *end_;
}

}  // namespace pbf::campaign_module
