#include "lib/io/particle_output.h"

#include <unistd.h>

#include <vector>

#include "lib/base/error.h"
#include "lib/base/own_file.h"
#include "lib/io/h5.h"

namespace pbf::io_module {

void write_particle_file(const std::string& path, const Particles& particles) {
  require_own_file(path);
  ::unlink(path.c_str());
  const h5::Lock lock;
  try {
    h5::File file(H5Fcreate(path.c_str(), H5F_ACC_EXCL, H5P_DEFAULT, H5P_DEFAULT));
    const auto write = [&](const char* name, const char* unit, const std::vector<Double3>& rows) {
      h5::write_dataset(file, name, H5T_IEEE_F64LE, {rows.size(), 3}, H5T_NATIVE_DOUBLE,
                        rows.data(), unit);
    };
    write("position", "m", particles.position);
    write("velocity", "m/s", particles.velocity);
    if (!file.reset()) throw h5::Failure(h5::reason());
  } catch (const h5::Failure& e) {
    throw Error(ExitCode::io, path + ": cannot be written: " + e.what());
  }
}

}  // namespace pbf::io_module
