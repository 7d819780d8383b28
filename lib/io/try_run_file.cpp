// Reads all of a run file that may be damaged.
#include "lib/io/h5_read.h"
#include "lib/io/run_file.h"

namespace pbf::io_module {

void try_run_file(const std::string& path) {
  h5::trial(path, [&path] {
    const RunReader run(path);
    run.info();
    run.status();
    run.sessions();
    run.log();
    for (const std::string& name : run.gauges()) run.gauge(name);
    if (run.frames() > 0) {
      run.frame(0);
      run.frame(run.frames() - 1);
    }
  });
}

}  // namespace pbf::io_module
