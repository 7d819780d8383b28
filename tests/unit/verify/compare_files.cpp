// pbf compare on two run files: what one file holds and the other does not is a difference, what
// rounding makes is none.
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

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
  /// In place of so many: the particles of a frame, and the most that there may be.
  std::function<std::vector<std::int64_t>(std::int64_t)> ids{};
  std::int64_t capacity = 0;
  int frames = 5, rows = 9;
  double later = 0;  // s, added to the times of frames behind the first
  bool density = true;
  ScalarType type = ScalarType::f64;
  std::function<void(FieldArray&, std::int64_t)> change;  // of a frame's field
};

Snapshot frame_of(const Made& m, std::int64_t k) {
  std::vector<std::int64_t> ids(m.count);
  std::iota(ids.begin(), ids.end(), 0);
  if (m.ids) ids = m.ids(k);
  Snapshot s{10 * k, 0.02 * double(k) + (k > 0 ? m.later : 0), ids.size(), {}};
  std::uint64_t seed = 7 + std::uint64_t(k);
  for (const auto& [name, unit, columns] :
       {std::tuple{"position", "m", 3}, {"velocity", "m/s", 3}, {"density", "kg/m^3", 1}}) {
    FieldArray f{name, unit, ScalarType::f64, columns, {}};
    f.bytes.resize(8 * s.count * std::size_t(columns));
    seed += 100;
    for (std::size_t i = 0; i < s.count; ++i) {  // of each particle, whatever its row
      SplitMix64 random(seed + 1000 * std::uint64_t(ids[i]));
      for (std::size_t c = 0; c < std::size_t(columns); ++c)
        f.as<double>()[std::size_t(columns) * i + c] = columns == 1 ? 1000 : random.uniform();
    }
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
  s.fields.emplace_back();
  return with_ids(std::move(s), ids, m.ids ? ScalarType::i64 : ScalarType::i32);
}

CompareResult compare(const Made& a, const Made& b) {
  const TemporaryFolder folder;
  for (const auto& [m, name] : {std::pair{&a, "a.h5"}, std::pair{&b, "b.h5"}}) {
    RunInfo info = sample_info(std::int64_t(m->count));
    info.capacity = m->capacity;
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

namespace {

/// A run with a sink that takes 20 particles between frames, and an emitter of 10. One whose sink
/// was `lucky` has more particles than others behind frame 1, and `lost` are missing in frame 4.
Made with_sink(const Made& like, std::int64_t lucky = 0, std::int64_t lost = 0) {
  Made m = like;
  m.capacity = 600;
  m.ids = [=](std::int64_t k) {
    std::vector<std::int64_t> ids;
    const std::int64_t gone = k > 1 ? 20 * k - lucky : 20 * k;
    for (std::int64_t id = 0; id < 500 + 10 * k; ++id)
      if (id / 2 >= gone && (k != 4 || id >= 500 || id < 500 - lost)) ids.push_back(2 * id);
    return ids;
  };
  return m;
}

}  // namespace

TEST_CASE("particles are matched by id where they appear and disappear", "[compare]") {
  CHECK(compare(with_sink(Made{}), with_sink(Made{})).same());
  CHECK(compare(with_sink(Made{}), with_sink(another())).same());
  // Three ids that only one file has move all rows behind them.
  const CompareResult r = compare(with_sink(Made{}), with_sink(another(), 3));
  const ComparePart& particles = part(r, "particles");
  CAPTURE(compare_text(r));
  CHECK(r.same());
  CHECK(particles.verdict == Verdict::not_judged);
  CHECK(particles.finding.find("A holds 440 particles at 0.04 s, B 446: 0 are in A alone, 6 in B "
                               "alone; of those in both: 0 h apart (rms)") == 0);
  CHECK(r.horizon < 0);
  CHECK(compare_text(r).find("particles ") != std::string::npos);
}

TEST_CASE("more particles that only one file has than chance makes are a difference", "[compare]") {
  const auto verdict = [](const Made& a, const Made& b, const std::string& name) {
    const CompareResult r = compare(a, b);
    CAPTURE(compare_text(r));
    CHECK(r.same() == (part(r, "particles").verdict != Verdict::differs &&
                       part(r, "distributions").verdict != Verdict::differs));
    return part(r, name).verdict;
  };
  // 200 particles have gone or come, and those that are lost: 82 are five standard errors.
  CHECK(verdict(with_sink(Made{}), with_sink(another(), 0, 70), "distributions") == Verdict::same);
  CHECK(verdict(with_sink(Made{}), with_sink(another(), 0, 90), "distributions") ==
        Verdict::differs);
  // Files that promise the same bits, and runs whose particles stay, have the same particles.
  CHECK(verdict(with_sink(Made{}), with_sink(Made{}, 1), "particles") == Verdict::differs);
  Made stays = with_sink(another(), 1);
  stays.capacity = 0;
  CHECK(verdict(with_sink(Made{}), stays, "particles") == Verdict::differs);
  Made start = with_sink(another());
  start.ids = [ids = start.ids](std::int64_t k) {
    std::vector<std::int64_t> all = ids(k);
    if (k == 0) all.back() = 5000;
    return all;
  };
  CHECK(verdict(with_sink(Made{}), start, "particles") == Verdict::differs);
}
