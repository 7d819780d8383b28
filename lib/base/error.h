// The one exception type of the library and the exit codes of the program.
#pragma once

#include <stdexcept>
#include <string>

namespace pbf::base_module {

/// Exit codes of `pbf`, the same for every command (listed in the README and in `pbf --help`).
enum class ExitCode : int {
  done = 0,
  internal = 1,     ///< a defect of the program itself
  bad_input = 2,    ///< bad command line or scene
  guard = 3,        ///< run stopped by the stability guard
  unavailable = 4,  ///< backend, device or memory not available
  io = 5,           ///< file cannot be read or written (disk full)
  difference = 6,   ///< `compare` or a suite found a difference or failure, --strict a warning
  resumable = 75,   ///< stopped early after saving
};

/// Thrown by the library, caught once in main(): what() is printed after "pbf: error: ".
class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ExitCode code() const noexcept { return code_; }

 private:
  ExitCode code_;
};

/// Throws Error(bad_input): `where` (a file, line, option or key) and what is wrong there.
[[noreturn]] inline void bad_input(const std::string& where, const std::string& what) {
  throw Error(ExitCode::bad_input, where + ": " + what);
}

}  // namespace pbf::base_module
