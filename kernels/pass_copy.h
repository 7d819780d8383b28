// Copies several arrays in one launch.
#pragma once

#include <cstdint>
#include <cstring>

#include "kernels/vec3.h"

namespace pbf::PBF_VARIANT {

/// Item i copies the i-th `unit` bytes of every array that has so many.
struct CopyPass {
  static constexpr int most = 12;
  static constexpr std::int64_t unit = 16;
  struct Part {
    const char* from = nullptr;  ///< aligned to a unit, like `to`
    char* to = nullptr;
    std::int64_t bytes = 0;
  };
  Part part[most];
  int parts = 0;

  PBF_HD void operator()(int i) const {
    for (int k = 0; k < parts; ++k) copy(part[k], i * unit);
  }

 private:
  PBF_HD static void copy(const Part& p, std::int64_t at) {
    if (at + unit <= p.bytes) {
#if defined(__CUDA_ARCH__)
      *reinterpret_cast<Vec4<float>*>(p.to + at) =
          *reinterpret_cast<const Vec4<float>*>(p.from + at);
#else
      std::memcpy(p.to + at, p.from + at, unit);
#endif
    } else {
      for (; at < p.bytes; ++at) p.to[at] = p.from[at];
    }
  }
};

}  // namespace pbf::PBF_VARIANT
