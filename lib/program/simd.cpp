#include "lib/program/simd.h"

#include <algorithm>
#include <cstdlib>

#include "lib/base/error.h"

namespace pbf::program_module {

const char* simd_name(Simd simd) {
  constexpr const char* names[] = {"scalar", "baseline", "avx2", "avx512"};
  return names[int(simd)];
}

std::vector<Simd> usable_simd() {
  std::vector<Simd> all{Simd::scalar, Simd::baseline};
#ifdef PBF_HAS_AVX
  const auto has = [](bool yes, Simd simd, std::vector<Simd>& to) {
    if (yes) to.push_back(simd);
  };
  has(__builtin_cpu_supports("avx2") && __builtin_cpu_supports("popcnt"), Simd::avx2, all);
  has(__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
          __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw"),
      Simd::avx512, all);
#endif
  return all;
}

Simd chosen_simd() {
  const std::vector<Simd> usable = usable_simd();
  const char* wanted = std::getenv("PBF_SIMD");
  if (!wanted || !*wanted) return usable.back();
  std::string names;
  for (const Simd simd : usable) {
    if (std::string(wanted) == simd_name(simd)) return simd;
    names += names.empty() ? "" : ", ";
    names += simd_name(simd);
  }
  const std::string name = wanted;
  const bool known = name == simd_name(Simd::avx2) || name == simd_name(Simd::avx512);
  throw Error(known ? ExitCode::unavailable : ExitCode::bad_input,
              "PBF_SIMD=" + name + ": " +
                  (known ? "not available on this processor" : "no such instructions") +
                  "; unset it, or take one of " + names);
}

}  // namespace pbf::program_module
