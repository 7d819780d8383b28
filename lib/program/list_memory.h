// The memory of the executors' neighbor lists, as a part of the memory plan.
#pragma once

#include <cstdint>
#include <string>

#include "lib/program/memory.h"

namespace pbf::program_module {

/// Bytes of a component.
inline std::int64_t size_of(const std::string& type) {
  if (type == "byte") return 1;
  return type == "double" || type == "int64" ? 8 : 4;
}

/// Adds arrays of one lifetime and one place to a plan.
struct Adder {
  MemoryPlan& memory;
  bool on_device;
  Held held;
  void operator()(const char* name, const std::string& type, int components,
                  std::int64_t elements) const {
    if (elements > 0)
      memory.arrays.push_back({name, type, components, elements,
                               size_of(type) * components * elements, on_device, held});
  }
};

void add_cpu_lists(const Scene& scene, const Plan& plan, const Adder& add);
/// rank: of one of several.
void add_cuda_lists(const Scene& scene, const Plan& plan, std::int64_t bins, bool rank,
                    const Adder& add);

}  // namespace pbf::program_module
