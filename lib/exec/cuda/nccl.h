// NCCL, opened at run time: the program is not linked with it.
#pragma once

#include <cuda_runtime.h>

#include <cstddef>
#include <string>

namespace pbf::exec_module {

/// Functions of libnccl.so.2, with the types of its interface (nccl.h, unchanged since 2.0). A
/// result is 0, or an error for error_text().
struct Nccl {
  struct Id {
    char bytes[128];
  };
  using Comm = void*;
  static constexpr int kBytes = 0;  ///< ncclInt8

  int (*get_version)(int* version);
  int (*get_unique_id)(Id* id);
  int (*init_rank)(Comm* comm, int ranks, Id id, int rank);
  int (*abort)(Comm comm);
  int (*destroy)(Comm comm);
  int (*send)(const void* from, std::size_t count, int type, int to, Comm comm, cudaStream_t s);
  int (*receive)(void* to, std::size_t count, int type, int from, Comm comm, cudaStream_t s);
  int (*group_start)();
  int (*group_end)();
  const char* (*error_text)(int result);
};

/// Null if the library is not there; why: what is wrong.
const Nccl* open_nccl(std::string* why);

}  // namespace pbf::exec_module
