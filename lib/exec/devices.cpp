#include "lib/exec/devices.h"

namespace pbf::exec_module {

#ifndef PBF_HAS_CUDA
std::string cuda_device_report() { return "CUDA is not compiled into this program"; }
DeviceRoom device_room() { return {}; }
#endif

}  // namespace pbf::exec_module
