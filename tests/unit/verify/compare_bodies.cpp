// pbf compare on two run files with free bodies: where these are in frames and in the log.
#include <cmath>

#include "lib/verify/compare.h"
#include "tests/support/catch.h"
#include "tests/support/run_file_samples.h"

using namespace pbf;
using namespace pbf::test;

namespace {

/// One side's file: how far a frame and a row of the log are off in the place of the second body.
struct Floating {
  std::string precision = "double", obstacles = "";
  double frame = 0, row = 0;  // m
};

constexpr const char* kTwoBodies =
    "obstacles:\n"
    "  - {name: ball, shape: sphere, center: [0.3, 0.5, 0.5], radius: 0.2, free: {density: 500}}\n"
    "  - {name: post, shape: sphere, center: [0.5, 0.5, 0.9], radius: 0.2}\n"
    "  - {name: buoy, shape: sphere, center: [0.7, 0.5, 0.5], radius: 0.2, free: {mass: 2}}\n";

std::vector<BodyMotion> bodies_at(std::int64_t k, double off) {
  std::vector<BodyMotion> all(2);
  all[0].middle = {0.3, 0.5, 0.5 + 0.01 * double(k)};
  all[1].middle = {0.7, 0.5 + off, 0.5};
  all[1].spin = {0, 0, 3};
  return all;
}

CompareResult compare_floating(const Floating& a, const Floating& b) {
  const TemporaryFolder folder;
  for (const auto& [side, name] : {std::pair{&a, "a.h5"}, std::pair{&b, "b.h5"}}) {
    RunInfo info = sample_info(40);
    info.solver.precision = side->precision;
    info.resolved_scene =
        "domain: {min: [0, 0, 0], max: [1, 1, 1]}\nfluid: {spacing: 0.1}\n"
        "bodies: [{shape: block, min: [0, 0, 0], max: [0.9, 0.9, 0.2]}]\n" +
        side->obstacles + "time: {step: 0.002, end: 0.08}\n";
    const bool free = !side->obstacles.empty();
    if (free) info.bodies = {"ball", "buoy"};
    for (const std::string& body : info.bodies)
      for (const ReadingColumn& c : body_columns(body)) info.columns.push_back(c);
    RunWriter writer(folder / name, info, false);
    for (std::int64_t k = 0; k < 5; ++k) {
      Snapshot s = sample(k, 40, ScalarType::f64);
      if (free) s.bodies = bodies_at(k, k == 3 ? side->frame : 0);
      writer.write(std::move(s));
    }
    for (std::int64_t k = 0; k < 9; ++k) {  // every second one without a frame
      LogRow row = sample_row(k);
      if (free)
        for (const BodyMotion& body : bodies_at(k, k == 5 ? side->row : 0))
          BodyMotion::each(body, [&](double x) { row.poses.push_back(x); });
      writer.log(row);
    }
    writer.finish({"finished"});
  }
  return compare_files(folder / "a.h5", folder / "b.h5");
}

const ComparePart* bodies_part(const CompareResult& r) {
  for (const ComparePart& p : r.parts)
    if (p.name == "bodies") return &p;
  return nullptr;
}

const CompareRow& body_row(const CompareResult& r, const std::string& what) {
  for (const CompareRow& row : bodies_part(r)->rows)
    if (row.what == what) return row;
  throw std::runtime_error("no row " + what);
}

}  // namespace

TEST_CASE("two files whose bodies are in the same places say so", "[compare]") {
  const CompareResult r = compare_floating({"double", kTwoBodies}, {"float", kTwoBodies});
  CAPTURE(compare_text(r));
  REQUIRE(bodies_part(r));
  CHECK(bodies_part(r)->verdict == Verdict::same);
  CHECK(bodies_part(r)->rows.size() == 8);
  CHECK(body_row(r, "pose/buoy spin").unit == "rad/s");
  CHECK(r.same());
}

TEST_CASE("a body elsewhere is a difference where bits are promised, else it is told",
          "[compare]") {
  for (const bool exact : {true, false})
    for (const bool in_log : {true, false}) {
      Floating b{exact ? "double" : "float", kTwoBodies};
      (in_log ? b.row : b.frame) = 0.003;
      const CompareResult r = compare_floating({"double", kTwoBodies}, b);
      CAPTURE(compare_text(r), exact, in_log);
      const Verdict verdict = exact ? Verdict::differs : Verdict::not_judged;
      CHECK(bodies_part(r)->verdict == verdict);
      CHECK(bodies_part(r)->finding.find(in_log ? "at 0.05 s, buoy is 0.003 m"
                                                : "at 0.06 s, buoy is 0.003 m") == 0);
      CHECK(body_row(r, "pose/buoy").verdict == verdict);
      CHECK(body_row(r, "pose/buoy").error == Approx(0.003));
      CHECK(body_row(r, "pose/buoy").rms == Approx(0.003 / std::sqrt(14.0)));
      CHECK(body_row(r, "pose/ball").verdict == Verdict::same);
      CHECK(body_row(r, "pose/buoy velocity").error == 0);
      CHECK(r.same() != exact);
    }
}

TEST_CASE("files without free bodies have no part about them", "[compare]") {
  CHECK_FALSE(bodies_part(compare_floating({}, {})));
}
