// pbf compare on two run files: what one file holds and the other does not is a difference, what
// rounding makes is none.
#include <cmath>
#include <functional>
#include <limits>

#include "lib/base/error.h"
#include "lib/scene/random.h"
#include "lib/verify/compare.h"
#include "tests/support/catch.h"
#include "tests/support/run_file_samples.h"

using namespace pbf;
using namespace pbf::test;

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// What one side's file is made of.
struct Made {
  std::string status = "finished", precision = "double", end = "0.08";
  std::size_t count = 600;
  int frames = 5, rows = 9;
  double later = 0;  // s, added to the times of frames behind the first
  bool density = true;
  ScalarType type = ScalarType::f64;
  std::function<void(FieldArray&, std::int64_t)> change;  // of a frame's field
};

Snapshot frame_of(const Made& m, std::int64_t k) {
  Snapshot s{10 * k, 0.02 * double(k) + (k > 0 ? m.later : 0), m.count, {}};
  SplitMix64 random(7 + std::uint64_t(k));
  for (const auto& [name, unit, columns] :
       {std::tuple{"position", "m", 3}, {"velocity", "m/s", 3}, {"density", "kg/m^3", 1}}) {
    FieldArray f{name, unit, ScalarType::f64, columns, {}};
    f.bytes.resize(8 * m.count * std::size_t(columns));
    for (double& v : f.as<double>()) v = columns == 1 ? 1000 : random.uniform();
    if (m.change) m.change(f, k);
    if (m.type == ScalarType::f32) {
      FieldArray g{name, unit, m.type, columns, {}};
      g.bytes.resize(f.bytes.size() / 2);
      for (std::size_t i = 0; i < g.as<float>().size(); ++i)
        g.as<float>()[i] = float(f.as<double>()[i]);
      f = g;
    }
    if (columns == 3 || m.density) s.fields.push_back(f);
  }
  s.fields.push_back(sample_field("id", "1", ScalarType::i32, 1, 3, k, m.count));
  return s;
}

CompareResult compare(const Made& a, const Made& b) {
  const TemporaryFolder folder;
  for (const auto& [m, name] : {std::pair{&a, "a.h5"}, std::pair{&b, "b.h5"}}) {
    RunInfo info = sample_info(std::int64_t(m->count));
    info.solver.precision = m->precision;
    info.resolved_scene =
        "domain: {min: [0, 0, 0], max: [1, 1, 1]}\nfluid: {spacing: 0.1}\n"
        "bodies: [{shape: block, min: [0, 0, 0], max: [0.9, 0.9, 0.9]}]\n"
        "time: {step: 0.002, end: " +
        m->end + "}\n";
    RunWriter writer(folder / name, info, false);
    for (int k = 0; k < m->frames; ++k) writer.write(frame_of(*m, k));
    for (int k = 0; k < m->rows; ++k) writer.log(sample_row(k));
    writer.finish({m->status});
  }
  return compare_files(folder / "a.h5", folder / "b.h5");
}

const ComparePart& part(const CompareResult& r, const std::string& name) {
  for (const ComparePart& p : r.parts)
    if (p.name == name) return p;
  throw std::runtime_error("no part " + name);
}

/// A's precision is float, so that the files promise no bits.
Made another() {
  Made m;
  m.precision = "float";
  return m;
}

}  // namespace

TEST_CASE("two files of one content are the same, whatever their precision", "[compare]") {
  for (const Made& b : {Made{}, another()}) {
    const CompareResult r = compare(Made{}, b);
    CAPTURE(compare_text(r));
    CHECK(r.same());
    CHECK(part(r, "extent").finding.find("both are finished, with 5 frames") == 0);
  }
}

TEST_CASE("what one of two files holds and the other does not is a difference, by name",
          "[slow][compare]") {
  Made b = another();
  std::vector<std::string> named;
  SECTION("a side that ended after its first frame") {
    b.frames = 1, b.rows = 1;
    named = {"4 frames of A have no frame of B", "first at 0.02 s", "the log ends at 0.08 s"};
  }
  SECTION("a side without a frame") {
    b.frames = 0;
    named = {"5 frames of A have no frame of B"};
  }
  SECTION("a run that diverged") {
    b.status = "diverged";
    named = {"A is finished, B is diverged"};
  }
  SECTION("a run that was stopped") {
    b.status = "stopped";
    named = {"A is finished, B is stopped"};
  }
  SECTION("a run that goes on, or was killed") {
    b.status = "running";
    named = {"B is running (or killed)"};
  }
  SECTION("another end") {
    b.end = "0.5";
    named = {"time.end is 0.08 s in A, 0.5 s in B"};
  }
  SECTION("more frames") {
    b.frames = 7;
    named = {"2 frames of B have no frame of A at their time, the first at 0.1 s"};
  }
  SECTION("frames at other times") {
    b.later = 0.005;
    named = {"4 frames of A", "4 frames of B", "first at 0.025 s"};
  }
  SECTION("a shorter log") {
    b.rows = 8;
    named = {"the log ends at 0.08 s (update 40, row 9) in A, 0.07 s"};
  }
  SECTION("a field") {
    b.density = false;
    named = {"only A has the field density", "b.h5", "output.fields"};
  }
  const CompareResult r = compare(Made{}, b);
  CAPTURE(compare_text(r));
  CHECK_FALSE(r.same());
  CHECK(part(r, "extent").verdict == Verdict::differs);
  for (const std::string& n : named) CHECK(part(r, "extent").finding.find(n) != std::string::npos);
}

TEST_CASE("files without one frame between them cannot be compared", "[compare]") {
  Made none = another();
  none.frames = 0;
  try {
    compare(none, none);
    FAIL("accepted");
  } catch (const Error& e) {
    CHECK(e.code() == ExitCode::bad_input);
    CHECK(std::string(e.what()).find("no frames to compare") != std::string::npos);
  }
}

TEST_CASE("samples that differ by rounding are equal, by more they are not", "[slow][compare]") {
  const auto [ulps, same] = GENERATE(table<double, bool>({{4, true}, {1e5, false}}));
  const std::string field = GENERATE("position", "velocity", "density");
  CAPTURE(ulps, field);
  Made b = another();
  b.change = [&, ulps = ulps](FieldArray& f, std::int64_t k) {
    if (f.name != field || k == 0) return;
    // A speed of float is known to a way of float over a step.
    const double unit = f.name == "density" ? 1000 : f.name == "velocity" ? 1 / 0.002 : 1;
    for (double& v : f.as<double>()) v += ulps * 0x1p-24 * unit;
  };
  Made a;
  a.change = [&](FieldArray& f, std::int64_t k) {  // of one value, so that the ranks tell all
    if (f.name == field && k > 0)
      for (double& v : f.as<double>()) v = f.name == "density" ? 1000 : 0.5;
  };
  const auto change = b.change;
  b.change = [&](FieldArray& f, std::int64_t k) {
    a.change(f, k);
    change(f, k);
  };
  const CompareResult r = compare(a, b);
  CAPTURE(compare_text(r));
  CHECK(r.same() == same);
  CHECK((part(r, "distributions").verdict == Verdict::same) == same);
}

TEST_CASE("doubles that differ by roundings of float are told apart", "[compare]") {
  Made a, b;
  b.change = [](FieldArray& f, std::int64_t) {
    if (f.name == "density")
      for (double& v : f.as<double>()) v *= 1 + 0x1p-22;
  };
  CHECK_FALSE(compare(a, b).same());
}

TEST_CASE("stored as float and as double, the same numbers are the same", "[compare]") {
  Made b;
  b.type = ScalarType::f32;
  const CompareResult r = compare(Made{}, b);
  CAPTURE(compare_text(r));
  CHECK(r.same());
  b.change = [](FieldArray& f, std::int64_t) {
    if (f.name == "density") f.as<double>()[3] += 0.001;
  };
  CHECK_FALSE(compare(Made{}, b).same());  // both promise the bits of the CPU in double
}

TEST_CASE("values that are no numbers are the same only where both files have them",
          "[slow][compare]") {
  const std::string field = GENERATE("position", "velocity", "density");
  CAPTURE(field);
  Made sick = another();
  sick.change = [&](FieldArray& f, std::int64_t k) {
    if (f.name == field && k == 3) f.as<double>()[5] = kNaN;
  };
  CHECK(compare(sick, sick).same());
  const CompareResult r = compare(Made{}, sick);
  CAPTURE(compare_text(r));
  CHECK_FALSE(r.same());
  CHECK(compare_text(r).find("not finite: " + field) != std::string::npos);
}

TEST_CASE("frames of other numbers of particles differ, empty ones on both sides do not",
          "[compare]") {
  Made none = another(), few = another();
  none.count = 0;
  few.count = 599;
  CHECK(compare(none, none).same());
  const CompareResult r = compare(Made{}, few);
  CHECK_FALSE(r.same());
  CHECK(part(r, "particles").finding.find("600 particles at 0 s, B 599") != std::string::npos);
  CHECK_FALSE(compare(Made{}, none).same());
}
