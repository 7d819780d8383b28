// Lists the CUDA devices of this machine.
#include <cuda_runtime.h>

#include <cstdio>
#include <string>

#include "lib/exec/devices.h"

namespace pbf::exec_module {

std::string cuda_device_report() {
  int driver = 0, runtime = 0, count = 0;
  cudaRuntimeGetVersion(&runtime);
  const cudaError_t e = cudaGetDeviceCount(&count);
  if (e != cudaSuccess || count == 0)
    return std::string("no CUDA device: ") +
           (e == cudaSuccess ? "the driver lists none" : cudaGetErrorString(e));
  cudaDriverGetVersion(&driver);
  std::string out;
  for (int d = 0; d < count; ++d) {
    cudaDeviceProp p{};
    if (cudaGetDeviceProperties(&p, d) != cudaSuccess) continue;
    char line[512];
    std::snprintf(line, sizeof line,
                  "%sdevice %d: %s, %.1f GiB, compute capability %d.%d, %d multiprocessors, "
                  "driver for CUDA %d.%d, runtime %d.%d",
                  d ? "\n" : "", d, p.name, double(p.totalGlobalMem) / (1 << 30), p.major, p.minor,
                  p.multiProcessorCount, driver / 1000, driver % 100 / 10, runtime / 1000,
                  runtime % 100 / 10);
    out += line;
  }
  return out;
}

DeviceRoom device_room() {
  int count = 0;
  std::size_t free = 0, total = 0;
  if (cudaGetDeviceCount(&count) != cudaSuccess || count == 0) return {};
  if (cudaMemGetInfo(&free, &total) != cudaSuccess) return {};
  return {count, std::int64_t(free)};
}

}  // namespace pbf::exec_module
