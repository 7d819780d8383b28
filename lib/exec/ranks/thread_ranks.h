// Ranks that are threads of one process.
#pragma once

#include <functional>
#include <memory>

#include "lib/exec/ranks/communicator.h"

namespace pbf::exec_module {

/// Calls work(rank) at once on `ranks` threads. If one throws, the calls of the others throw, too,
/// and the first error is thrown here.
void run_thread_ranks(int ranks, const std::function<void(Communicator&)>& work);

}  // namespace pbf::exec_module
