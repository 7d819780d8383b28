// Particle files, CSV and HDF5: any bytes give finite particles, as many as were counted, or an
// Error.
#include <cmath>
#include <cstdlib>
#include <optional>

#include "lib/base/error.h"
#include "lib/io/particle_file.h"
#include "tests/fuzz/memory_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const pbf::test::MemoryFile file(data, size);
  std::optional<std::int64_t> count;
  try {
    count = pbf::count_particle_file(file.path());
  } catch (const pbf::Error&) {
  }
  try {
    const pbf::Particles p = pbf::read_particle_file(file.path());
    if (!count || *count != static_cast<std::int64_t>(p.size())) std::abort();
    for (const auto& x : p.position)
      for (const double value : x)
        if (!std::isfinite(value)) std::abort();
  } catch (const pbf::Error&) {
  }
  return 0;
}
