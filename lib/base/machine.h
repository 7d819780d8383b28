// What this machine offers to run on.
#pragma once

#include <cstddef>
#include <string>

namespace pbf::inline base_module {

/// Model name of the CPU, "unknown CPU" when the system does not tell.
std::string cpu_model();

/// Threads that this process may use (its affinity mask, as a batch system sets it), at least 1.
int usable_threads();

/// Bytes of memory that can still be allocated without swapping: the machine's, or what is left
/// of the control group's limit when that is smaller. 0 when the system does not tell.
std::size_t available_memory();

/// Bytes of memory that this process has held at most (VmHWM). Not getrusage's figure, which starts
/// with what the program that started this one held.
std::size_t peak_memory();

}  // namespace pbf::inline base_module
