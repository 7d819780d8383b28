// Files for tests/python: not a test by itself, hence hidden; ctest runs it before the scripts.
#include <cmath>
#include <cstdlib>

#include "lib/io/run_file.h"
#include "tests/support/catch.h"
#include "tests/support/run_file_samples.h"

using namespace pbf;

namespace {

/// A block of n^3 particles that falls and spreads; frame k at time 0.02 k.
Snapshot falling_block(std::int64_t frame, std::int64_t n, ScalarType real) {
  const auto count = static_cast<std::size_t>(n * n * n);
  Snapshot s = test::sample(frame, count, real);
  const auto set = [&](const char* name, std::size_t at, double v) {
    auto& f = *const_cast<FieldArray*>(s.find(name));
    if (real == ScalarType::f64) {
      f.as<double>()[at] = v;
    } else {
      f.as<float>()[at] = static_cast<float>(v);
    }
  };
  const double t = s.time;
  for (std::size_t i = 0; i < count; ++i) {
    const auto k = static_cast<std::int64_t>(i);
    const double cell[3] = {static_cast<double>(k % n), static_cast<double>(k / n % n),
                            static_cast<double>(k / (n * n))};
    for (std::size_t c = 0; c < 3; ++c) {
      const double gravity = c == 2 ? -9.81 : 0, spread = c == 2 ? 0 : 0.5 * cell[c] * 0.02;
      set("position", 3 * i + c, cell[c] * 0.02 + spread * t + 0.5 * gravity * t * t);
      set("velocity", 3 * i + c, spread + gravity * t);
    }
    set("density", i, 1000 - 20 * t);
  }
  return s;
}

void write_sample(const std::string& path, bool varying, bool gzip, ScalarType real) {
  RunWriter writer(path, test::sample_info(1000), gzip);
  for (std::int64_t k = 0; k < 8; ++k) {
    writer.log(test::sample_row(k));
    writer.write(falling_block(k, varying ? 10 + k % 3 - k / 4 : 10, real));
  }
  writer.finish({"finished"});
}

/// In frame k the particles 2e8 j, j from 3k to 3k + 19 but for every fourth; none in frame 5.
void write_changing(const std::string& path) {
  RunInfo info = test::sample_info(15);
  info.capacity = 15;
  info.resolved_scene =  // holds the first of the particles
      "domain: {min: [-1, -1, -1], max: [20, 3000, 3000]}\nfluid: {spacing: 0.5}\n"
      "bodies: [{shape: block, min: [0, 0, 0], max: [1, 1, 1]}]\ntime: {step: 0.002, end: 1}\n";
  RunWriter writer(path, info, true);
  for (std::int64_t k = 0; k < 8; ++k) {
    std::vector<std::int64_t> ids;
    for (std::int64_t j = 3 * k; j < 3 * k + 20 && k != 5; ++j)
      if (j % 4 != 1) ids.push_back(200000000 * j);
    writer.log(test::sample_row(k));
    writer.write(test::with_ids(test::sample(k, ids.size()), ids, ScalarType::i64));
  }
  writer.finish({"finished"});
}

/// Two free bodies: in frame k the first is k/10 m higher and turned by k * 10 degrees about z.
void write_bodies(const std::string& path) {
  RunInfo info = test::sample_info(8);
  info.bodies = {"float", "raft"};
  for (const std::string& name : info.bodies)
    for (const ReadingColumn& c : body_columns(name)) info.columns.push_back(c);
  RunWriter writer(path, info, false);
  for (std::int64_t k = 0; k < 4; ++k) {
    Snapshot s = falling_block(k, 2, ScalarType::f32);
    s.bodies.resize(2);
    const double angle = 0.17453292519943295 * double(k);
    s.bodies[0] = {{0.5, 0.25, 1 + 0.1 * double(k)},
                   {Double3{std::cos(angle), -std::sin(angle), 0},
                    Double3{std::sin(angle), std::cos(angle), 0}, Double3{0, 0, 1}},
                   {0, 0, 0.1},
                   {0, 0, 2}};
    s.bodies[1].middle = {2, 2, double(k)};
    LogRow row = test::sample_row(k);
    row.measures.time = s.time;
    for (const BodyMotion& body : s.bodies)
      BodyMotion::each(body, [&](double x) { row.poses.push_back(x); });
    writer.log(row);
    writer.write(std::move(s));
  }
  writer.finish({"finished"});
}

}  // namespace

TEST_CASE("run files for the Python checks", "[.][sample]") {
  const char* folder = std::getenv("PBF_SAMPLE_FOLDER");
  REQUIRE(folder != nullptr);
  const std::string path = folder;
  std::filesystem::remove_all(path);
  std::filesystem::create_directories(path);
  write_sample(path + "/constant.h5", false, false, ScalarType::f32);
  write_sample(path + "/varying.h5", true, false, ScalarType::f32);
  write_sample(path + "/gzip_double.h5", false, true, ScalarType::f64);
  write_changing(path + "/changing.h5");
  write_bodies(path + "/bodies.h5");
}
