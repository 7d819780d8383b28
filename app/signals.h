// Asking a run to stop: SIGTERM, SIGINT and SIGUSR1 (Slurm's warning) set a flag.
#pragma once

#include <string>

namespace pbf {

/// From now on the first of the signals sets the flag; a second one ends the program at once.
void watch_signals();

/// Name of the signal that came ("SIGTERM"), empty when none did.
std::string signal_seen();

/// Writing to a pipe whose reader has gone gives an error instead of ending the program.
void ignore_closed_pipes();

}  // namespace pbf
