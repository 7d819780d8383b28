#include "lib/io/particle_output.h"

#include <unistd.h>

#include <vector>

#include "lib/base/error.h"
#include "lib/base/own_file.h"
#include "lib/io/h5.h"

namespace pbf::inline io_module {

void write_particle_file(const std::string& path, const Particles& particles) {
  require_own_file(path);
  ::unlink(path.c_str());
  const h5::Lock lock;
  try {
    h5::File file(H5Fcreate(path.c_str(), H5F_ACC_EXCL, H5P_DEFAULT, H5P_DEFAULT));
    const auto write = [&](const char* name, const char* unit, const std::vector<Double3>& rows) {
      const hsize_t shape[] = {rows.size(), 3};
      const h5::Space space(H5Screate_simple(2, shape, nullptr));
      const h5::Dataset d(
          H5Dcreate2(file, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
      h5::check(H5Dwrite(d, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data()));
      h5::write_text(d, "units", unit);
    };
    write("position", "m", particles.position);
    write("velocity", "m/s", particles.velocity);
    if (!file.reset()) throw h5::Failure(h5::reason());
  } catch (const h5::Failure& e) {
    throw Error(ExitCode::io, path + ": cannot be written: " + e.what());
  }
}

}  // namespace pbf::inline io_module
