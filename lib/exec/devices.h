// The devices that a solver may run on.
#pragma once

#include <cstdint>
#include <string>

namespace pbf::exec_module {

/// One line per CUDA device (name, memory, compute capability, driver), or one line that says why
/// there is none: CUDA not compiled in, no driver, no device.
std::string cuda_device_report();

/// What a process may use of GPUs.
struct DeviceRoom {
  int devices = 0;              ///< that it sees
  std::int64_t free_bytes = 0;  ///< of the first one
};
/// Makes the first GPU ready for this process, which takes some tenths of a second the first time.
/// Nothing where there is none, or none that works.
DeviceRoom device_room();

}  // namespace pbf::exec_module
