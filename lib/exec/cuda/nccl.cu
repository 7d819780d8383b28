#include "lib/exec/cuda/nccl.h"

#include <dlfcn.h>

namespace pbf::exec_module {

const Nccl* open_nccl(std::string* why) {
  static Nccl table{};
  static bool there = false;
  if (there) return &table;
  void* library = dlopen("libnccl.so.2", RTLD_NOW | RTLD_LOCAL);
  if (!library) {
    if (why) *why = dlerror();
    return nullptr;
  }
  const auto take = [&](auto& function, const char* name) {
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(dlsym(library, name));
    if (!function && why) *why = std::string("libnccl.so.2 has no ") + name;
    return function != nullptr;
  };
  there = take(table.get_version, "ncclGetVersion") &&
          take(table.get_unique_id, "ncclGetUniqueId") &&
          take(table.init_rank, "ncclCommInitRank") && take(table.abort, "ncclCommAbort") &&
          take(table.destroy, "ncclCommDestroy") && take(table.send, "ncclSend") &&
          take(table.receive, "ncclRecv") && take(table.group_start, "ncclGroupStart") &&
          take(table.group_end, "ncclGroupEnd") && take(table.error_text, "ncclGetErrorString");
  return there ? &table : nullptr;
}

}  // namespace pbf::exec_module
