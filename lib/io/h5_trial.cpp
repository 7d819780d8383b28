// trial() of h5_read.h. A fuzzer has one of its own.
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>

#include "lib/base/error.h"
#include "lib/io/h5_read.h"

namespace pbf::io_module::h5 {

void trial(const std::string& path, const std::function<void()>& action, unsigned seconds) {
  const pid_t parent = getpid(), child = [] {
    const Lock alone;  // no other thread is inside HDF5 while the process is copied
    return fork();
  }();
  if (child < 0) return;  // no process to be had: the file is read without a trial
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // it is of no use to anyone else
    if (getppid() != parent) _exit(0);
    const rlimit cpu{seconds, seconds}, core{0, 0};
    setrlimit(RLIMIT_CPU, &cpu);
    setrlimit(RLIMIT_CORE, &core);
    for (const int s : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGTERM, SIGINT, SIGUSR1})
      std::signal(s, SIG_DFL);
    try {
      action();
    } catch (...) {  // told by the next one who reads
    }
    _exit(0);
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return;
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  if (signal == SIGINT || signal == SIGTERM) {  // meant for the whole program
    raise(signal);
    return;
  }
  const bool endless = signal == SIGKILL || signal == SIGXCPU;
  throw Error(ExitCode::io, path + ": the file is damaged: HDF5 " +
                                (endless ? "does not come to an end with it" : "crashes on it") +
                                "; copy or make it anew");
}

}  // namespace pbf::io_module::h5
