// The devices that a solver may run on.
#pragma once

#include <string>

namespace pbf::exec_module {

/// One line per CUDA device (name, memory, compute capability, driver), or one line that says why
/// there is none: CUDA not compiled in, no driver, no device.
std::string cuda_device_report();

}  // namespace pbf::exec_module
