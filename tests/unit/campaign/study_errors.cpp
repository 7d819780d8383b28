// Errors of motion and the reference in study files: what is taken, and what is said of wrong ones.
#include "tests/support/catch.h"
#include "tests/support/study_support.h"

using namespace pbf;
using pbf::test::kHalvedSteps;
using pbf::test::message_of;
using pbf::test::StudyFolder;

TEST_CASE("the reference is the finest run, the run that is named, or one of its own") {
  const StudyFolder folder;
  const std::string head =
      "variants: [{name: a}, {name: b, set: {solver.method: chebyshev}, energy_limit: 0.2}]\n"
      "grid:\n  - {solver.iterations: [2, 4]}\n"
      "  - {time.step: [0.002, 0.001], measure_every: [1, 2]}\nerror: {log: energy}\n";
  const auto member = [&](const std::string& text) { return folder.study(text).reference_member; };
  CHECK(member(head + "reference: {variant: b, solver.iterations: 4.0, time.step: 1e-3}\n") == 7);
  CHECK(member(head + "reference: {variant: a, solver.iterations: 2, measure_every: 2}\n") == 1);
  CHECK(member("variants: [{name: a}, {name: b, set: {solver.substeps: 2}}]\n" +
               head.substr(head.find("grid")) + "reference: finest\n") == 7);
  // Finer in space comes first.
  CHECK(member("set: {time.end: 0.1}\ngrid:\n  - {fluid.spacing: [0.02, 0.04], time.step: [0.002, "
               "0.001], measure_every: [1, 2]}\nerror: {log: energy}\n") == 0);
  const Study own = folder.study(head + "reference: {variant: b, time.step: 5e-4}\n");
  CHECK_FALSE(own.reference_member);
  CHECK(own.reference->scene.time.step == 5e-4);
  CHECK(own.reference->scene.solver.method == SolverMethod::chebyshev);
  CHECK(own.reference->energy_limit == 0.2);
  CHECK_FALSE(folder.study("grid: {solver.iterations: [1, 2]}\n").reference);
}

TEST_CASE("the names of errors end in their unit") {
  const StudyFolder folder;
  const Study study = folder.study(
      kHalvedSteps +
      std::string("set:\n  gauges:\n    - {name: H, kind: level, at: [0.2, 0.1]}\n"
                  "    - {name: U, kind: velocity, at: [0.2, 0.1, 0.1]}\n"
                  "    - {name: Q, kind: flow, center: [0.2, 0.1, 0.2], normal: [1, 0, 0], size: "
                  "[0.2, 0.4]}\n"
                  "error: [{log: momentum_x}, {log: front_x}, {log: height_kept}, {gauge: H}, "
                  "{gauge: U/x}, {gauge: Q}, {gauge: Q/total}]\n"));
  std::vector<std::string> names;
  for (const MotionError& e : study.motion) names.push_back(e.rms());
  CHECK(names == std::vector<std::string>{"momentum_x_rms_kg_m_s", "front_x_rms_m",
                                          "height_kept_rms", "gauge/H_rms_m", "gauge/U/x_rms_m_s",
                                          "gauge/Q_rms_kg_s", "gauge/Q/total_rms_kg"});
}

TEST_CASE("what is wrong with an error or a reference is said with its place and a remedy") {
  const StudyFolder folder;
  const std::string grid = kHalvedSteps;  // 2 lines, after the scene's
  const std::string two = "variants: [{name: a}, {name: b, set: {solver.method: chebyshev}}]\n";
  const std::vector<std::pair<std::string, std::string>> cases{
      {grid + "error: {log: energi}",
       "study.yaml:4:8: error.log: \"energi\" is no column for errors, did you mean energy?"},
      {grid + "error: {log: qqqqqqqqq}", "is no column for errors; there are compression_mean "},
      {grid + "error: [{lag: energy}]", ":4:10: error.lag: unknown key, did you mean log?"},
      {grid + "error: [{log: energy, gauge: H}]", ":4:9: error: needs one of log and gauge"},
      {grid + "error: [{}]", "needs one of log and gauge in an entry"},
      {grid + "error: {log: [a]}", "error.log: is a list of 1"},
      {grid + "error: []", "error: is an empty list; name a measure"},
      {grid + "error: [[energy]]", "error: is a list of 1"},
      {grid + "error: [{log: energy}, {log: energy}]", ":4:24: error: energy is given twice"},
      {grid + "error: [compression_mean, compression_mean]", "compression_mean is given twice"},
      {grid + "error: [compression_mean, front_x_rms_m]", "is no measure of this study"},
      {grid + "error: {log: work}",
       ":4:8: error.log: work is not in the log of time.step=0.002, where nothing moves"},
      {grid + "error: {gauge: H}", "\"H\" is no gauge of time.step=0.002, which has none; add it"},
      {grid + "set: {gauges: [{name: H2, kind: level, at: [0.2, 0.1]}]}\nerror: {gauge: H3}",
       ":5:8: error.gauge: \"H3\" is no gauge of time.step=0.002; there are H2"},
      {"error: {log: energy}", ": reference: is the finest run, and there is only one; give its"},
      {two + "error: {log: energy}",
       ": reference: the finest is not one run but 2 runs: a, b; name"},
      {two + grid + "error: {log: energy}\nreference: {time.step: 0.001}",
       ":6:12: reference: these values are those of 2 runs: a time.step=0.001, b time.step=0.001; "
       "name one by its values, such as {time.step: 0.001} and its variant: NAME"},
      {two + grid + "reference: {variant: c, time.step: 1}",
       ":5:22: reference.variant: \"c\" is no variant of this study"},
      {grid + "reference: {variant: c}", "\"c\" is no variant of this study"},
      {grid + "reference: coarsest", ":4:12: reference: is \"coarsest\", expected finest, or keys"},
      {grid + "reference: [finest]", "expected finest, or keys of the scene"},
      {grid + "reference: {time.stp: 1}", "time.stp: unknown key, did you mean time.step?"},
      {"grid: {time.step: [0.002, 0.001]}\nerror: {log: energy}",
       "study.yaml: reference: time.step=0.001 is measured at 9 times from 0 s on, and a "
       "difference "
       "over time needs 10: lower measure_every or `from`"},
      {grid + "error: {log: energy}\nreference: {solver.iterations: 64}",
       ":5:12: reference: this run is measured at 5 times from 0 s on, and a difference over time "
       "needs 10: lower its measure_every"},
      {"grid: {time.end: [0.04, 0.1]}\nset: {measure_every: 1}\nerror: {log: energy}\n"
       "reference: {time.end: 0.1}",
       "time.end=0.04 can be compared at 21 of the 51 times"},
      {"grid: {time.adaptive: [on, off]}\nerror: {log: energy}", "time.adaptive: a study compares"},
      {grid + "from: 0.03\nerror: {log: energy}", "is measured at 6 times from 0.03 s on"}};
  for (const auto& [text, message] : cases) {
    CAPTURE(text, message);
    const std::string said = message_of([&] { folder.study(text + "\n"); });
    CAPTURE(said);
    CHECK(said.find(message) != std::string::npos);
    CHECK(said.find("study.yaml:") != std::string::npos);
  }
}
