// CUDA errors as exceptions that name the call.
#pragma once

#include <cuda_runtime.h>

#include <string>

#include "lib/base/error.h"

namespace pbf::exec_module {

/// Throws Error(unavailable) for a missing device or memory, Error(internal) for anything else.
inline void cuda_check(cudaError_t e, const char* call, const char* file, int line) {
  if (e == cudaSuccess) return;
  const bool missing = e == cudaErrorMemoryAllocation || e == cudaErrorNoDevice ||
                       e == cudaErrorInsufficientDriver || e == cudaErrorInitializationError;
  throw Error(missing ? ExitCode::unavailable : ExitCode::internal,
              std::string("CUDA: ") + cudaGetErrorString(e) + " (" + cudaGetErrorName(e) + ") in " +
                  call + " at " + file + ":" + std::to_string(line));
}

}  // namespace pbf::exec_module

#define PBF_CUDA_CHECK(call) ::pbf::cuda_check((call), #call, __FILE__, __LINE__)
