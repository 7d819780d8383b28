// The state of a run in a checkpoint: as a whole, or in pieces where no process has memory for all.
// Both make the same datasets. Functions throw h5::Failure, and are called under an h5::Lock.
#pragma once

#include "lib/io/checkpoint.h"
#include "lib/io/h5.h"

namespace pbf::io_module {

void write_state(hid_t file, const SolverState& state);
/// Of n particles; all but their rows goes to `head` as well.
void write_pieces(hid_t file, const GiveState& give, std::int64_t n, SolverState& head);

void read_state(hid_t file, std::int64_t particles, SolverState& state);
/// Checks all rows, and keeps fields of others than particles. Those of few rows are kept too: they
/// may be of something else.
void read_head(hid_t file, std::int64_t particles, SolverState& state);

}  // namespace pbf::io_module
