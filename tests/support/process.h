// Runs the real program as a user does, and a scratch folder to run it in.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/catch.h"

namespace pbf::test {

struct Outcome {
  int code = -1;         ///< exit code; 128 + signal when a signal ended it
  std::string out, err;  ///< stdout and stderr
};

/// A program under way; its output goes to files in the folder it runs in.
class Process {
 public:
  /// Starts `pbf args...` with `folder` as its working directory and NAME=VALUE added to its
  /// environment, which says nothing of how threads wait: this program too has set that for itself.
  Process(const std::vector<std::string>& args, const std::filesystem::path& folder,
          const std::vector<std::string>& environment = {});
  /// The same with another program: its path, then its arguments.
  static Process program(const std::vector<std::string>& words, const std::filesystem::path& folder,
                         const std::vector<std::string>& environment = {});
  void send(int signal) const;
  bool running() const;  ///< false also when it has ended and not been waited for
  /// user_seconds: CPU time outside the kernel, of all its threads.
  Outcome wait(double* user_seconds = nullptr);
  pid_t id() const { return pid_; }

 private:
  Process() = default;
  void start(const std::vector<std::string>& words, const std::filesystem::path& folder,
             const std::vector<std::string>& environment);
  pid_t pid_ = -1;
  std::filesystem::path out_, err_;
};

/// Waits until `there` holds, at most so many seconds; whether it does.
template <class Condition>
bool comes_true(Condition there, int most) {
  for (int i = 0; i < 100 * most && !there(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return there();
}
/// The same for what must come; a minute is a hang. The test goes on, to end what it has started.
template <class Condition>
void wait_until(Condition there) {
  CHECK(comes_true(there, 60));
}

/// A process that `parent` has started, with this word in its command line; 0 when there is none.
pid_t child_of(pid_t parent, const std::string& word = "");

using Args = std::vector<std::string>;

/// Runs `pbf args...` to its end.
Outcome pbf(const std::vector<std::string>& args, const std::filesystem::path& folder,
            const std::vector<std::string>& environment = {});

/// Runs lines of bash, where "$PBF" is the program and "$STRANGER" starts one as a user who has no
/// other processes; exit code 124 when they have not come to an end after a minute.
Outcome shell(const std::string& lines, const std::filesystem::path& folder);

/// An empty folder of its own, removed with everything in it at the end.
class Scratch {
 public:
  Scratch();
  ~Scratch();
  std::filesystem::path path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  /// Writes a file and returns its path.
  std::string write(const std::string& name, const std::string& text) const;

 private:
  std::filesystem::path path_;
};

/// Runs the folder's s.yaml on one thread into the folder `out` of it.
Outcome run_scene(const Scratch& folder, const std::string& out, const Args& more = {});

std::string read_text(const std::filesystem::path& path);

/// A scene of 64 particles and 20 updates with frames; `more` is appended.
std::string tiny_scene(const std::string& more = "");

/// Whether `part` stands somewhere in `text`.
inline bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// How often `part` stands in `text`, without overlaps.
inline std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++n;
  return n;
}

}  // namespace pbf::test
