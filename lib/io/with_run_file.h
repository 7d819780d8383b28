// Opens a run file anew for every read, so that a file still growing is read as it is.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <thread>

#include "lib/base/error.h"
#include "lib/io/h5_read.h"

namespace pbf::io_module {

/// Whether somebody may be writing the file: the last write was a short while ago.
inline bool alive(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  const auto written = fs::last_write_time(path, error);
  return !error && fs::file_time_type::clock::now() - written < std::chrono::minutes(1);
}

/// Opens the file and runs `action(file)`. What a live file shows while its writer is in the
/// middle of a commit may not fit together, so a failure is final only when it repeats.
template <class Action>
auto with_file(const std::string& path, const std::string& what, Action action) {
  for (int attempt = 1;; ++attempt) {
    try {
      const h5::Reading file(path);
      return action(file);
    } catch (const h5::Failure& f) {
      if (attempt == 3 || !alive(path))
        throw Error(ExitCode::io, path + ": " + what + ": " + f.what());
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

}  // namespace pbf::io_module
