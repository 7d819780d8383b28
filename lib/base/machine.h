// Properties of this machine: CPU, threads, memory.
#pragma once

#include <cstddef>
#include <string>

namespace pbf::base_module {

/// Model name of the CPU, or "unknown CPU".
std::string cpu_model();

/// Threads that this process may use (its affinity mask, as a batch system sets it), at least 1.
int usable_threads();

/// Bytes of memory that can still be allocated without swapping: of the machine, or of the control
/// group if its limit leaves less. 0 if unknown.
std::size_t available_memory();

/// Peak memory of this process in bytes (VmHWM). The value of getrusage() is not used: it also
/// counts the memory of the program that started this one.
std::size_t peak_memory();

}  // namespace pbf::base_module
