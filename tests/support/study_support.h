// Studies for tests: a small scene, and results made by hand.
#pragma once

#include "lib/base/error.h"
#include "lib/campaign/study_table.h"
#include "lib/io/run_layout.h"
#include "tests/support/catch.h"
#include "tests/support/folder.h"

namespace pbf::test {

/// A folder with a scene of 64 particles, 20 updates of 0.002 s, measured every 5.
struct StudyFolder : TemporaryFolder {
  StudyFolder() {
    write("scene.yaml",
          "domain: {min: [0, 0, 0], max: [0.4, 0.2, 0.4]}\n"
          "fluid: {spacing: 0.04}\n"
          "bodies:\n  - {shape: block, min: [0, 0, 0], max: [0.16, 0.16, 0.16]}\n"
          "time: {step: 0.002, end: 0.04}\nmeasure_every: 5\nthreads: 1\n");
  }
  Study study(const std::string& text) const {
    return load_study(write("study.yaml", "scene: scene.yaml\n" + text), {});
  }
};

/// Halved steps, 21 readings each, at the same times.
inline const char* const kHalvedSteps =
    "grid:\n  - {time.step: [0.002, 0.001, 0.0005, 0.00025], measure_every: [1, 2, 4, 8]}\n";

/// What the Error(bad_input) of f() says; "accepted" without one.
inline std::string message_of(const auto& f) {
  try {
    f();
  } catch (const Error& e) {
    CHECK(e.code() == ExitCode::bad_input);
    return e.what();
  }
  return "accepted";
}

/// A finished run of `seconds` with a log of these times; every other column 0.
inline MemberResult result_of(double seconds, const std::vector<double>& time) {
  MemberResult r;
  r.backend = "cpu", r.precision = "float", r.device = "none";
  r.threads = 1, r.particles = 64, r.updates = 20;
  r.seconds = seconds;
  for (const auto& c : run_layout::log_columns()) r.log[c.name].resize(time.size());
  r.log["time"] = time;
  return r;
}
inline void set(MemberResult& r, const std::string& name, const std::vector<double>& values) {
  r.log.at(name) = values;
}

}  // namespace pbf::test
