// A run in a folder of its own, with a solver that only counts.
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "lib/run/run.h"
#include "tests/support/watched_session.h"

namespace pbf::scene_test {

/// While it lives, nothing is printed on stdout.
class Silence {
 public:
  Silence() {
    std::fflush(stdout);
    const int nowhere = ::open("/dev/null", O_WRONLY);
    ::dup2(nowhere, 1);
    ::close(nowhere);
  }
  ~Silence() {
    std::fflush(stdout);
    ::dup2(stdout_, 1);
    ::close(stdout_);
  }
  Silence(const Silence&) = delete;

 private:
  int stdout_ = ::dup(1);
};

/// A run of such a solver in a folder of its own.
struct CountedRun {
  Folder temporary{};
  Start start;
  CountingSolver solver{};
  StopToken stop{};
  Log log{true};
  Control control{stop, log};
  StageClock clock{};
  RunFolder folder{temporary / "run", ExistingFolder::refuse};
  ResumePoint from{};
  RunParts run{start, solver, control, clock, folder, from};

  explicit CountedRun(const Scene& scene)
      : start{{scene, {}, {}, {}, {}, {}, {}, {}}, make_plan(scene, CountingSolver::particles)} {
    std::size_t numbers = 0;
    for_each_number(start.plan.columns, Series::measures, [&](auto&&...) { ++numbers; });
    solver.measures = std::max<std::size_t>(1, numbers);
  }
  /// "no error", or the exit code and the message.
  std::string error() {
    const Silence silence;
    return error_of([&] {
      open_files(run, "2026-01-01T00:00:00Z");
      run_session(run);
    });
  }
  UpdateNumbers frames() const { return RunReader(folder.file(kRunFile)).updates(); }
  std::string status() const { return RunReader(folder.file(kRunFile)).status(); }
  std::vector<double> column(const std::string& name) const {
    return RunReader(folder.file(kRunFile)).log_column(name);
  }
  /// Of each frame: the steps that its state has behind it.
  UpdateNumbers steps_of_frames() const {
    const RunReader file(folder.file(kRunFile));
    UpdateNumbers out;
    for (std::int64_t k = 0; k < file.frames(); ++k)
      out.push_back(std::int64_t(file.frame(k).fields.at(0).as<float>()[0]));
    return out;
  }
  std::optional<SavedRun> saved() const {
    std::vector<std::string> notes;
    std::optional<SavedRun> saved = read_checkpoint(folder.path(), notes);
    CHECK(notes.empty());
    return saved;
  }
  void stop_at(std::int64_t update) {
    solver.flow = [this, update](Diagnostics& m) {
      if (m.update >= update) control.max_walltime = 1e-9;
    };
  }
};

inline Scene saving_always(Scene s) {
  s.checkpoint.emplace().every = 0;
  return s;
}

inline std::int64_t frames_until(std::int64_t update) { return update / 3 + 1; }

}  // namespace pbf::scene_test
