// Particle files, CSV and HDF5: any bytes give finite particles or an Error.
#include <cmath>
#include <cstdlib>

#include "lib/base/error.h"
#include "lib/io/particle_file.h"
#include "tests/fuzz/memory_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const pbf::test::MemoryFile file(data, size);
  try {
    const pbf::Particles p = pbf::read_particle_file(file.path());
    if (p.velocity.size() != p.size()) std::abort();
    for (const auto& x : p.position)
      for (const double value : x)
        if (!std::isfinite(value)) std::abort();
  } catch (const pbf::Error&) {
  }
  return 0;
}
