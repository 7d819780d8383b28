// Signals set a flag that asks a run to stop (SIGTERM, SIGINT) or to save its state (SIGUSR1, as
// sent by Slurm's --signal).
#pragma once

#include <csignal>
#include <string>

namespace pbf::inline run_module {

/// From now on SIGTERM or SIGINT sets the flag of signal_seen(); a second one ends the program at
/// once. A SIGTERM less than 3 s after the first signal is none: Slurm and systemd send theirs to
/// every process, and the run of a batch gets it from the batch once more. SIGUSR1 sets that of
/// save_asked(). Signals that HeldSignals kept waiting arrive now.
void watch_signals();

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

/// Name of the signal that asked to stop ("SIGTERM"), empty when none did.
std::string signal_seen();

/// Whether SIGUSR1 came since the last call.
bool save_asked();

/// Writing to a pipe whose reader has gone, or beyond the limit of a file's size (ulimit -f), gives
/// an error instead of ending the program.
void see_failed_writes();

}  // namespace pbf::inline run_module
