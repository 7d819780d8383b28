// Signals ask a token to stop (SIGTERM, SIGINT) or to save (SIGUSR1, as sent by Slurm's --signal).
#pragma once

#include <csignal>

#include "lib/run/stop_token.h"

namespace pbf::inline run_module {

/// From now on SIGTERM or SIGINT asks signal_token() to stop; a second one ends the program at
/// once. A SIGTERM less than 3 s after the first signal is none: Slurm and systemd send theirs to
/// every process, and the run of a batch gets it from the batch once more. SIGUSR1 asks it to save.
/// Signals that HeldSignals kept waiting arrive now.
void watch_signals();

/// The one token of the process, for a signal is the process's.
StopToken& signal_token();

/// While one lives, SIGTERM, SIGINT and SIGUSR1 wait, also in a process that is started then, until
/// that calls watch_signals(): a run is not killed by a signal that comes before it can listen.
class HeldSignals {
 public:
  HeldSignals();
  ~HeldSignals();
  HeldSignals(const HeldSignals&) = delete;
  HeldSignals& operator=(const HeldSignals&) = delete;

 private:
  sigset_t before_;
};

/// Writing to a pipe whose reader has gone, or beyond the limit of a file's size (ulimit -f), gives
/// an error instead of ending the program.
void see_failed_writes();

}  // namespace pbf::inline run_module
