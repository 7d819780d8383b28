#include "lib/run/signals.h"

#include <ctime>

namespace pbf::run_module {
namespace {

constexpr int kStopping[] = {SIGTERM, SIGINT, SIGUSR2};
constexpr std::sig_atomic_t kOneStop = 3;  // s
volatile std::sig_atomic_t seen_at = 0;
constinit StopToken token;

// Calls only async-signal-safe functions.
extern "C" void pbf_on_stop(int number) {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  const auto second = static_cast<std::sig_atomic_t>(now.tv_sec);
  if (seen_at == 0) {  // somebody else may have asked the token
    seen_at = second;
    token.ask(number == SIGTERM ? "SIGTERM" : number == SIGINT ? "SIGINT" : "SIGUSR2");
    std::signal(SIGINT, SIG_DFL);
  } else if (second - seen_at >= kOneStop) {
    std::signal(number, SIG_DFL);
    raise(number);
  }
}

extern "C" void pbf_on_save(int) { token.ask_save(); }

void watch(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;  // interrupted writes continue
  sigaction(signal, &action, nullptr);
}

sigset_t watched() {
  sigset_t set;
  sigemptyset(&set);
  for (const int s : kStopping) sigaddset(&set, s);
  sigaddset(&set, SIGUSR1);
  return set;
}

}  // namespace

void watch_signals() {
  for (const int s : kStopping) watch(s, pbf_on_stop);
  watch(SIGUSR1, pbf_on_save);
  const sigset_t set = watched();
  pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
}

void ignore_signals() {
  for (const int s : kStopping) std::signal(s, SIG_IGN);
  std::signal(SIGUSR1, SIG_IGN);
}

HeldSignals::HeldSignals() {
  const sigset_t set = watched();
  pthread_sigmask(SIG_BLOCK, &set, &before_);
}

HeldSignals::~HeldSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

StopToken& signal_token() { return token; }

void see_failed_writes() {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace pbf::run_module
