// The arithmetic of a study's table on results made by hand; results on disk.
#include <cmath>

#include "lib/base/error.h"
#include "tests/support/catch.h"
#include "tests/support/study_support.h"

using namespace pbf;
using pbf::test::result_of;
using pbf::test::set;
using pbf::test::StudyFolder;

TEST_CASE("measures are means, root mean squares, maxima and last values over the window") {
  const StudyFolder folder;
  const Study study = folder.study("from: 0.02\n");
  MemberResult r = result_of(4, {0, 0.01, 0.02, 0.03});
  set(r, "compression_mean", {9, 9, 1, 2});
  set(r, "compression_rms", {9, 9, 3, 4});
  set(r, "compression_max", {9, 9, 6, 5});
  set(r, "energy_rise", {0, 0, 0.001, 0.002});
  set(r, "height_kept", {9, 9, 0.9, 1.0});
  r.ratios = {0.75, 1.5};
  const StudyRow row = study_row(study, study.members[0], r, nullptr);
  const auto value = [&](const char* name) { return measure_of(study, row, name); };
  CHECK(value("compression_mean") == Approx(1.5));
  CHECK(value("compression_rms") == Approx(std::sqrt(12.5)));
  CHECK(value("compression_max") == 6);
  CHECK(value("energy_rise") == 0.002);
  CHECK(value("height_kept") == Approx(0.95));
  CHECK(value("height_error") == Approx(0.05));
  CHECK(row.status == "finished");
  CHECK(r.seconds_median() == 4);  // of 3, 4 and 6
  CHECK(r.seconds_spread() == Approx(3));
}

TEST_CASE("a run that made energy, diverged or never ran is neither on the front nor cheapest") {
  const StudyFolder folder;
  const Study study = folder.study("grid: {solver.iterations: [1, 2, 3, 4, 5, 6]}\n");
  const double seconds[] = {1, 2, 3, 4, 0.5, 0.1}, error[] = {0.02, 0.009, 0.01, 0.0005, 0, 0};
  std::vector<StudyRow> rows;
  for (std::size_t k = 0; k < 6; ++k) {
    MemberResult r = result_of(seconds[k], {0, 0.04});
    set(r, "compression_mean", {error[k], error[k]});
    if (k == 4) set(r, "energy_rise", {0, 0.5});
    if (k == 5) r.status = "diverged";
    rows.push_back(study_row(study, study.members[k], r, nullptr));
  }
  MemberResult absent;
  absent.status = "unavailable";
  rows.push_back(study_row(study, study.members[0], absent, nullptr));
  mark_front(study, rows);
  const bool on_front[] = {true, true, false, true, false, false, false};
  for (std::size_t k = 0; k < 7; ++k) CHECK(rows[k].pareto == on_front[k]);
  CHECK(rows[4].status == "energy_rose");
  CHECK(cheapest(study, rows, "compression_mean", 0.01, "") == &rows[1]);
  CHECK(cheapest(study, rows, "compression_mean", 0.001, "") == &rows[3]);
  CHECK(cheapest(study, rows, "compression_mean", 0.0001, "") == nullptr);
  const std::string text = study_text(study, rows);
  for (const char* part :
       {"* solver.iterations=2", "  solver.iterations=3", "energy_rose by 50 %", "unavailable",
        "cheapest setting for compression_mean <= 1 %: solver.iterations=2 on cpu float, 2 s",
        "cheapest setting for compression_mean <= 0.1 %: solver.iterations=4"})
    CHECK(text.find(part) != std::string::npos);
  const std::string csv = study_table(study, rows).csv();
  CHECK(csv.rfind("solver.iterations,backend,precision,threads,particles,updates,seconds_median,"
                  "seconds_spread,compression_mean,compression_rms,compression_p99,compression_max,"
                  "share_above_1,share_above_10,height_kept,hydrostatic_deviation,",
                  0) == 0);
  CHECK(csv.find("\n2,cpu,float,1,64,20,2,0,0.009,") != std::string::npos);
  CHECK(study_json(study, rows).find("\"seconds\": 4") != std::string::npos);
}

TEST_CASE("every variant is judged by its own limit on the energy, which its message names") {
  const StudyFolder folder;
  const Study study =
      folder.study("variants:\n  - {name: ours}\n  - {name: paper, energy_limit: 0.03}\n");
  const auto row = [&](std::size_t member, double rise) {
    MemberResult r = result_of(1, {0, 0.04});
    set(r, "energy_rise", {0, rise});
    return study_row(study, study.members[member], r, nullptr);
  };
  CHECK(row(0, 0.01).status == "finished");
  CHECK(row(0, 0.0104).message == "by 1.04 % of its start, the limit is 1 %");
  CHECK(row(1, 0.03).status == "finished");
  CHECK(row(1, 0.031).message == "by 3.1 % of its start, the limit is 3 %");
  CHECK(row(1, NAN).status == "energy_rose");
}

TEST_CASE("variants are compared with the first one that gets there") {
  const StudyFolder folder;
  const Study study = folder.study("variants:\n  - {name: a}\n  - {name: b}\n  - {name: c}\n");
  std::vector<StudyRow> rows;
  for (std::size_t k = 0; k < 3; ++k) {
    MemberResult r = result_of(k == 0 ? 8 : 2, {0, 0.04});
    set(r, "compression_mean", {k == 2 ? 0.5 : 0.001, k == 2 ? 0.5 : 0.001});
    rows.push_back(study_row(study, study.members[k], r, nullptr));
  }
  const std::string text = study_text(study, rows);
  CHECK(text.find("0.25 times the time of a") != std::string::npos);
  CHECK(text.find("does not get there") != std::string::npos);
}

TEST_CASE("the distance to the reference is that of the centres of mass, whatever their samples") {
  const StudyFolder folder;
  const Study study =
      folder.study("reference: {solver.iterations: 8}\nerror: reference_distance\n");
  REQUIRE(study.reference);
  CHECK(study.reference->scene.solver.iterations == 8);
  MemberResult fine = result_of(1, {0, 0.01, 0.02, 0.03, 0.04}),
               coarse = result_of(1, {0, 0.02, 0.04});
  set(fine, "center_of_mass_x", {0, 1, 2, 3, 4});
  set(coarse, "center_of_mass_x", {0.016, 2 + 0.016, 4 + 0.016});
  const double volume = 64 * std::pow(0.04, 3);  // cube root: 0.16 m
  const StudyRow row = study_row(study, study.members[0], coarse, &fine);
  CHECK(measure_of(study, row, "reference_distance") == Approx(0.016 / std::cbrt(volume)));
}

TEST_CASE("a front is compared at the published times that the run covers") {
  const StudyFolder folder;
  folder.write("data.csv", "# a source\nt_s,T,Z\n0,0,1\n9,1,2.5\n9,2,3\n9,9,50\n");
  const FrontData data = read_front_data(folder / "data.csv");
  CHECK(data.name == "data");
  CHECK(data.T == std::vector<double>{0, 1, 2, 9});
  std::size_t points = 0;
  // Z = 1 + T: off by -0.5 at T = 1.
  CHECK(front_deviation({{0, 0.5, 4}, {1, 1.5, 5}}, data, &points) == Approx(0.5 / std::sqrt(3)));
  CHECK(points == 3);
  CHECK(std::isnan(front_deviation({{10, 11}, {1, 2}}, data)));
  Front front;
  front.origin = 0.1, front.length = 0.5, front.factor = 2;
  const FrontCurve c = front_curve(front, 4, 0.02, {0, 0.5}, {0.59, 1.09});
  CHECK(c.T[1] == Approx(2));  // 0.5 sqrt(2 4/0.5)
  CHECK(c.Z[0] == Approx(1));
  CHECK(c.Z[1] == Approx(2));
  for (const char* bad :
       {"", "a,b\n1,2\n", "T,Z\n1\n", "T,Z\n", "T,Z\n2,1\n1,1\n", "T,Z\n1,nan\n"}) {
    CAPTURE(bad);
    CHECK_THROWS_AS(read_front_data(folder.write("bad.csv", bad)), Error);
  }
}

TEST_CASE("a run gives the same result again, also from disk, and its key is its content") {
  const StudyFolder folder;
  const Study study = folder.study("repeats: 2\ngrid: {solver.iterations: [2, 4]}\n");
  double share = 0;
  const auto run = [&](const StudyMember& m) {
    return *run_member(
        study, m, [] { return false; }, [&](double s) { share = s; });
  };
  const MemberResult a = run(study.members[0]), b = run(study.members[0]);
  CHECK(share == 1);
  CHECK(a.status == "finished");
  CHECK(a.series("time") == std::vector<double>{0, 0.01, 0.02, 0.03, 0.04});
  CHECK(a.series("compression_mean") == b.series("compression_mean"));
  CHECK(a.ratios.size() == 1);
  CHECK(a.seconds > 0);

  const std::string path = folder / "member.json";
  CHECK_FALSE(read_member(path));
  write_member(path, a);
  const auto back = read_member(path);
  REQUIRE(back);
  CHECK(back->log == a.log);
  CHECK(back->ratios == a.ratios);
  CHECK(back->seconds == a.seconds);
  CHECK(back->device == a.device);
  CHECK(back->particles == 64);
  folder.write("member.json", "{\"status\": \"finished\", \"message\": 3");
  CHECK_THROWS_AS(read_member(path), Error);

  const auto key = [](const Study& s, std::size_t k) { return member_key(s, s.members[k]); };
  CHECK(key(study, 0) != key(study, 1));
  CHECK(key(study, 0) == key(folder.study("repeats: 2\nset: {name: other, solver.iterations: 2}\n"
                                          "targets: [0.5]\n"),
                             0));
  CHECK(key(study, 0) != key(folder.study("repeats: 3\nset: {solver.iterations: 2}\n"), 0));
  CHECK_FALSE(run_member(
      study, study.members[0], [] { return true; }, [](double) {}));
}

TEST_CASE("a stored result that is not whole is refused by file and column") {
  const StudyFolder folder;
  const MemberResult good = result_of(4, {0, 0.01, 0.02});
  const std::string path = folder / "member.json";
  const auto error = [&](const std::string& from, const std::string& to) -> std::string {
    write_member(path, good);
    std::ifstream in(path);
    std::string text{std::istreambuf_iterator<char>(in), {}};
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    folder.write("member.json", text.replace(at, from.size(), to));
    try {
      read_member(path);
    } catch (const Error& e) {
      CHECK(e.code() == ExitCode::bad_input);
      CHECK(std::string(e.what()).rfind(path + ":", 0) == 0);
      return e.what();
    }
    return "accepted";
  };
  const std::vector<std::array<std::string, 3>> cases{
      {"\"compression_mean\"", "\"compression_men\"", "log has no column compression_mean"},
      {"\"front_x\"", "\"front\"", "log has no column front_x"},
      {"\"time\":[", "\"time\":[0.5,", "has 3 rows, time has 4"},
      {"\"log\"", "\"lok\"", "key 'log' not found"},
      {"\"seconds\":4", "\"seconds\":null,\"was\":4", "seconds: not a time"},
      {"\"updates\":20", "\"updates\":20.5", "updates is 20.5, expected a whole number"},
      {"\"particles\":64", "\"particles\":1e300", "particles is 1e+300, expected a whole number"},
      {"\"particles\":64", "\"particles\":1e400", "number overflow"},
      {"\"particles\":64", "\"particles\":18446744073709551615", "expected a whole number"},
      {"\"threads\":1", "\"threads\":-1", "threads is -1, expected a whole number not below 0"},
      {"\"finished\"", "\"finish\"", "neither finished nor diverged"},
      {"\"device\":\"none\"", "\"device\":[1]", "device is [1], expected text"},
      {"\"ratios\":[]", "\"ratios\":3", "ratios is 3, expected a list"},
      {"\"log\":{", "\"log\":[],\"lok\":{", "log has no column time"},
      {"\"time\":[", "\"time\":[\"x\",", "log.time is \"x\", expected a number"},
      {"\"time\":[", "\"time\":[x,", "parse error at line 1"}};
  for (const auto& [from, to, message] : cases) {
    CAPTURE(from, to);
    CHECK_THAT(error(from, to), Catch::Contains(message));
  }
  write_member(path, result_of(4, {}));
  CHECK_THROWS_WITH(read_member(path), Catch::Contains("a run has one at least"));
  const std::string first = PBF_SOURCE_DIR "/tests/samples/first_edition/study/members/";
  CHECK_THROWS_WITH(read_member(first + "0b4f9b13665633e4.json"),
                    Catch::Contains("0b4f9b13665633e4.json: log has no column iterations_done"));
}

TEST_CASE("a run that is thrown out of every number stops and says when") {
  const StudyFolder folder;
  const Study study = folder.study(
      "set: {domain.open: [z_min], gravity: [0, 0, -1e12], time.step: 1e8, time.end: 1e9, "
      "measure_every: 1}\n");
  const auto r = run_member(
      study, study.members[0], [] { return false; }, [](double) {});
  REQUIRE(r);
  CHECK(r->status == "diverged");
  CHECK(r->message.find("update 1") != std::string::npos);
  const StudyRow row = study_row(study, study.members[0], *r, nullptr);
  CHECK(row.status == "diverged");
}
