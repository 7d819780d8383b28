// Errors of motion and their orders, on results made by hand.
#include <cmath>

#include "lib/base/error.h"
#include "tests/support/catch.h"
#include "tests/support/study_support.h"

using namespace pbf;
using pbf::test::kHalvedSteps;
using pbf::test::message_of;
using pbf::test::result_of;
using pbf::test::set;
using pbf::test::StudyFolder;

namespace {

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

}  // namespace

TEST_CASE(
    "an error that falls with the square of the step has order 2, in every row that can tell") {
  const StudyFolder folder;
  const Study study = folder.study(
      kHalvedSteps +
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
  const Study study = folder.study(kHalvedSteps + std::string("error: {log: energy}\n"));
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
  const Study study = folder.study(kHalvedSteps + errors);
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
  const Study long_one = folder.study(
      kHalvedSteps + std::string("error: {log: energy}\nreference: {time.step: 0.001}\n"));
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
  const Study study = folder.study(kHalvedSteps + std::string("error: [{log: height_kept}]\n"));
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
  const Study study = folder.study(kHalvedSteps + std::string("error: {log: energy}\n"));
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
