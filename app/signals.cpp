#include "app/signals.h"

#include <csignal>

namespace pbf {
namespace {

constexpr int kWatched[] = {SIGTERM, SIGINT, SIGUSR1};
volatile std::sig_atomic_t seen = 0;

extern "C" void pbf_on_signal(int number) {
  seen = number;
  for (const int s : kWatched) std::signal(s, SIG_DFL);  // async-signal-safe
}

}  // namespace

void watch_signals() {
  for (const int s : kWatched) {
    struct sigaction action {};
    action.sa_handler = pbf_on_signal;
    action.sa_flags = SA_RESTART;  // a write that is under way goes on
    sigaction(s, &action, nullptr);
  }
}

std::string signal_seen() {
  switch (seen) {
    case SIGTERM:
      return "SIGTERM";
    case SIGINT:
      return "SIGINT";
    case SIGUSR1:
      return "SIGUSR1";
    default:
      return "";
  }
}

void ignore_closed_pipes() { std::signal(SIGPIPE, SIG_IGN); }

}  // namespace pbf
