// Errors of motion: what a study file may ask for, and the numbers on results made by hand.
#include <cmath>

#include "lib/base/error.h"
#include "tests/support/catch.h"
#include "tests/support/study_support.h"

using namespace pbf;
using pbf::test::result_of;
using pbf::test::set;
using pbf::test::StudyFolder;

namespace {

/// Halved steps, 21 readings each, at the same times.
const char* const kHalved =
    "grid:\n  - {time.step: [0.002, 0.001, 0.0005, 0.00025], measure_every: [1, 2, 4, 8]}\n";

/// A result whose energy is off by `error` at all of the 21 readings of a line from 0 to 20 J.
MemberResult off_by(double error, double seconds = 1) {
  std::vector<double> time, energy;
  for (int k = 0; k <= 20; ++k) time.push_back(0.002 * k), energy.push_back(k + error);
  MemberResult r = result_of(seconds, time);
  set(r, "energy", energy);
  return r;
}

/// The rows of these errors against a reference without one.
std::vector<StudyRow> rows_of(const Study& study, const std::vector<double>& errors,
                              double of_reference = 0) {
  const MemberResult reference = off_by(of_reference);
  std::vector<StudyRow> rows;
  for (std::size_t k = 0; k < errors.size(); ++k)
    rows.push_back(
        study_row(study, study.members[k], off_by(errors[k], 1 + double(k)), &reference));
  find_orders(study, rows);
  return rows;
}

std::string message_of(const auto& f) {
  try {
    f();
  } catch (const Error& e) {
    CHECK(e.code() == ExitCode::bad_input);
    return e.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE(
    "an error that falls with the square of the step has order 2, in every row that can tell") {
  const StudyFolder folder;
  const Study study = folder.study(
      kHalved +
      std::string("error: {log: energy}\nreference: {solver.iterations: 64, measure_every: 1}\n"));
  CHECK(study.errors == std::vector<std::string>{"energy_rms_relative"});
  CHECK_FALSE(study.reference_member);
  std::vector<double> errors;
  for (const StudyMember& m : study.members)
    errors.push_back(-1e6 * std::pow(m.scene.time.step, 2));
  const std::vector<StudyRow> rows = rows_of(study, errors);
  CHECK_FALSE(rows[0].motion[0].order);
  CHECK(rows[0].motion[0].note == "no order: no run with a longer step");
  for (std::size_t k = 0; k < 4; ++k) {
    CHECK(rows[k].motion[0].difference.value().rms == Approx(-errors[k]));
    CHECK(measure_of(study, rows[k], "energy_rms_J") == Approx(-errors[k]));
    CHECK(measure_of(study, rows[k], "energy_rms_relative") == Approx(-errors[k] / 20));
    if (k > 0) CHECK(rows[k].motion[0].order.value() == Approx(2));
    if (k > 0) CHECK(rows[k].motion[0].note.empty());
  }
}

TEST_CASE("a reference of the same steps makes orders too high, by as much as the note says") {
  const StudyFolder folder;
  const Study study = folder.study(kHalved + std::string("error: {log: energy}\n"));
  REQUIRE(study.reference_member == 3);  // the finest, if no other is named
  for (const double p : {1, 2}) {
    std::vector<double> errors;
    for (const StudyMember& m : study.members)
      errors.push_back(1e3 * std::pow(m.scene.time.step, p));
    const std::vector<StudyRow> rows = rows_of(study, errors, errors[3]);
    CHECK(rows[3].is_reference);
    CHECK(rows[3].motion[0].note == "the reference");
    CHECK(rows[3].motion[0].difference.value().rms == 0);
    CHECK_FALSE(rows[3].motion[0].order);
    // (4 - 1)/(2 - 1) and (16 - 1)/(4 - 1) in units of the reference's error.
    CHECK(rows[2].motion[0].order.value() == Approx(std::log2(p == 1 ? 3 : 5)));
    CHECK(rows[2].motion[0].note == "order 1 would show as 1.58, 2 as 2.32");
    CHECK(rows[1].motion[0].note == "order 1 would show as 1.22, 2 as 2.07");
  }
}

TEST_CASE("where an order cannot be told, the reason is") {
  const StudyFolder folder;
  const std::string errors =
      "error: {log: energy}\nreference: {solver.iterations: 64, measure_every: 1}\n";
  const auto note = [](const std::vector<StudyRow>& rows, std::size_t k) {
    CHECK_FALSE(rows[k].motion[0].order);
    return rows[k].motion[0].note;
  };
  const Study study = folder.study(kHalved + errors);
  std::vector<StudyRow> rows = rows_of(study, {4, 5, 5, 0});
  CHECK(note(rows, 1) == "no order: not less than with the longer step");
  CHECK(note(rows, 2) == "no order: not less than with the longer step");
  CHECK(note(rows, 3) == "no order: no difference");
  // A run that failed is left out: the next one is held to the run before it.
  rows = rows_of(study, {4, 2, 1, 0.5});
  MemberResult blown = off_by(2), gone = off_by(2);
  blown.status = "diverged";
  set(gone, "energy_rise", std::vector<double>(21, 0.5));
  const MemberResult exact = off_by(0);
  rows[1] = study_row(study, study.members[1], blown, &exact);
  rows[2] = study_row(study, study.members[2], gone, &exact);
  find_orders(study, rows);
  CHECK(note(rows, 1) == "diverged");
  CHECK_FALSE(rows[1].motion[0].difference);
  CHECK(std::isnan(measure_of(study, rows[1], "energy_rms_J")));
  CHECK(note(rows, 2) == "energy_rose");
  CHECK(rows[3].motion[0].order.value() == Approx(1));

  const Study twice = folder.study(
      "grid:\n  - {time.step: [0.002, 0.001, 0.001, 0.0005], measure_every: [1, 2, 1, 4]}\n" +
      errors);
  rows = rows_of(twice, {4, 2, 2, 1});
  CHECK(note(rows, 1) == "no order: two runs have this time.step");
  CHECK(note(rows, 2) == "no order: two runs have this time.step");
  CHECK(rows[3].motion[0].order.value() == Approx(1));
  const Study together = folder.study(
      "grid:\n  - {time.step: [0.002, 0.001], measure_every: [1, 2], solver.iterations: [1, 2]}\n" +
      errors);
  rows = rows_of(together, {4, 2});
  CHECK(note(rows, 1) == "no order: no run with a longer step");
  const Study long_one =
      folder.study(kHalved + std::string("error: {log: energy}\nreference: {time.step: 0.001}\n"));
  rows = rows_of(long_one, {4, 0, 1, 2});
  CHECK(note(rows, 2) == "no order: the reference has no shorter step");
}

TEST_CASE("every variant has its own order, and the reference is on no front of motion") {
  const StudyFolder folder;
  const Study study = folder.study(
      "variants: [{name: a}, {name: b, set: {solver.iterations: 8}}]\n"
      "grid:\n  - {time.step: [0.002, 0.001], measure_every: [1, 2]}\n"
      "error: [compression_mean, {log: energy}]\nreference: {variant: b, time.step: 1e-3}\n");
  REQUIRE(study.reference_member == 3);
  std::vector<StudyRow> rows = rows_of(study, {4, 2, 3, 0});
  mark_front(study, rows);
  CHECK(rows[1].motion[0].order.value() == Approx(1));
  CHECK_FALSE(rows[2].motion[0].order);
  CHECK(pareto_front(study, rows, "energy_rms_relative") ==
        std::vector<bool>{true, true, false, false});
  CHECK(cheapest(study, rows, "energy_rms_relative", 0.1, "") == &rows[1]);
  CHECK(cheapest(study, rows, "energy_rms_relative", 0.01, "") == nullptr);
  const std::string text = study_text(study, rows);
  for (const char* part :
       {"energy: difference from b time.step=0.001, from 0 s on; range 20 J, 21 points", "RMS, J",
        "10 %", "the reference", "cheapest setting for energy_rms_relative <= 1 %: none",
        "cheapest setting for compression_mean <= 1 %: a"}) {
    CAPTURE(part, text);
    CHECK(text.find(part) != std::string::npos);
  }
  const std::string csv = study_table(study, rows).csv();
  CHECK(
      csv.find(",energy_rms_J,energy_rms_relative,energy_order,device,status,message,error,par") !=
      std::string::npos);
  CHECK(csv.find(",2,0.1,1,none,finished,,compression_mean,") != std::string::npos);
  const std::string json = study_json(study, rows);
  for (const char* part : {"\"reference\": \"b time.step=0.001\"", "\"bias\": 4", "\"unit\": \"J\"",
                           "\"note\": \"the reference\""})
    CHECK(json.find(part) != std::string::npos);
}

TEST_CASE("a finished run that cannot be compared has no number but a reason") {
  const StudyFolder folder;
  const Study study = folder.study(kHalved + std::string("error: [{log: height_kept}]\n"));
  MemberResult r = off_by(0);
  set(r, "height_kept", std::vector<double>(21, NAN));
  StudyRow row = study_row(study, study.members[0], r, &r);
  CHECK(row.status == "finished");
  CHECK_FALSE(row.motion[0].difference);
  CHECK(row.message.rfind("height_kept: 0 of the reference's 0 readings can be compared", 0) == 0);
  // One that stays as it is has an RMS alone.
  const MemberResult still = off_by(0);
  row = study_row(study, study.members[0], still, &still);
  CHECK(measure_of(study, row, "height_kept_rms") == 0);
  CHECK(std::isnan(measure_of(study, row, "height_kept_rms_relative")));
  CHECK(row.motion[0].note == "the reference never changes");
}

TEST_CASE("a reference that did not finish, or made energy, is refused by place and name") {
  const StudyFolder folder;
  const Study study = folder.study(kHalved + std::string("error: {log: energy}\n"));
  MemberResult r = off_by(0);
  CHECK_NOTHROW(check_reference(study, r));
  set(r, "energy_rise", std::vector<double>(21, 0.5));
  const std::string rose = message_of([&] { check_reference(study, r); });
  CHECK(rose.find("study.yaml: reference: the energy of time.step=0.00025 rose by 50 % of its "
                  "start, the limit is 1 %") != std::string::npos);
  r.status = "diverged", r.message = "at update 3";
  const std::string blown = message_of([&] { check_reference(study, r); });
  CHECK(blown.find("time.step=0.00025 diverged at update 3; nothing can be compared with it: name "
                   "another run") != std::string::npos);
}

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
      kHalved +
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
  const std::string grid = kHalved;  // 2 lines, after the scene's
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

TEST_CASE("a run keeps its gauges and the work of its motion, and differs from itself by nothing") {
  const StudyFolder folder;
  const Study study = folder.study(
      "set:\n  measure_every: 1\n  gauges:\n    - {name: H, kind: level, at: [0.08, 0.08]}\n"
      "    - {name: U, kind: velocity, at: [0.08, 0.08, 0.04]}\n"
      "  tank_motion: {kind: sine, direction: [1, 0, 0], amplitude: 0.01, period: 0.5}\n"
      "repeats: 1\ngrid: {solver.iterations: [2, 4]}\n"
      "error: [{gauge: H}, {gauge: U/x}, {log: work}, {log: center_of_mass_z}]\n");
  const MemberResult r = *run_member(
      study, study.members[0], [] { return false; }, [](double) {});
  for (const char* column : {"gauge/H", "gauge/U/x", "gauge/U/y", "gauge/U/z", "work"})
    CHECK(r.series(column).size() == 21);
  CHECK(r.series("gauge/H")[0] == Approx(0.16).margin(0.02));
  CHECK(r.series("work").back() != 0);
  const StudyRow row = study_row(study, study.members[0], r, &r);
  for (const MotionResult& m : row.motion) CHECK(m.difference.value().rms == 0);

  const std::string path = folder / "member.json";
  const Scene& scene = study.members[0].scene;
  write_member(path, r);
  const MemberResult back = read_member(path, scene).value();
  for (const char* column : {"gauge/H", "gauge/U/x", "work"})
    CHECK(back.series(column) == r.series(column));
  MemberResult less = r;
  less.log.erase("gauge/U/y");
  write_member(path, less);
  CHECK(message_of([&] { read_member(path, scene); }).find("log has no column gauge/U/y") !=
        std::string::npos);
}
