// Signals ask a token to stop (SIGTERM, SIGINT; SIGUSR2, which mpirun passes on without ending the
// ranks soon after) or to save (SIGUSR1, as sent by Slurm's --signal).
#pragma once

#include <csignal>

#include "lib/run/stop_token.h"

namespace pbf::run_module {

/// From now on SIGTERM, SIGINT or SIGUSR2 asks signal_token() to stop; a second one ends the
/// program at once. A SIGTERM less than 3 s after the first signal is ignored, because Slurm and
/// systemd signal every process and a batch forwards the signal to its runs. SIGUSR1 asks it to
/// save. Signals that HeldSignals blocked arrive now.
void watch_signals();

/// The token of the process; signals are per process.
StopToken& signal_token();

/// Of a process that only serves another: it gets that one's signals, too.
void ignore_signals();

/// Blocks these signals during its lifetime, also in processes started then, until
/// these call watch_signals(): no signal kills a run before its handlers are installed.
class HeldSignals {
 public:
  HeldSignals();
  ~HeldSignals();
  HeldSignals(const HeldSignals&) = delete;
  HeldSignals& operator=(const HeldSignals&) = delete;

 private:
  sigset_t before_;
};

/// Writing to a closed pipe, or beyond the file size limit (ulimit -f), returns an error instead of
/// ending the program.
void see_failed_writes();

}  // namespace pbf::run_module
