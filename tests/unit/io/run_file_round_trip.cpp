#include <algorithm>

#include "lib/base/error.h"
#include "lib/io/run_file.h"
#include "tests/support/catch.h"
#include "tests/support/run_file_samples.h"

using namespace pbf;
using namespace pbf::test;

namespace {

void check_round_trip(const std::vector<std::size_t>& counts, bool gzip, ScalarType real) {
  const TemporaryFolder folder;
  const std::string path = folder / "run.vtkhdf";
  RunWriter writer(path, sample_info(static_cast<std::int64_t>(counts[0])), gzip);
  for (std::size_t k = 0; k < counts.size(); ++k)
    writer.write(sample(static_cast<std::int64_t>(k), counts[k], real));
  writer.finish({"finished"});
  REQUIRE(writer.frames_written() == static_cast<std::int64_t>(counts.size()));
  REQUIRE(writer.bytes_written() > 0);

  const RunReader reader(path);
  REQUIRE(reader.frames() == static_cast<std::int64_t>(counts.size()));
  REQUIRE(reader.status() == "finished");
  REQUIRE(reader.fields() == std::vector<std::string>{"density", "velocity"});
  for (std::size_t k = 0; k < counts.size(); ++k) {
    const auto frame = static_cast<std::int64_t>(k);
    CHECK(reader.times()[k] == 0.02 * static_cast<double>(k));
    CHECK(same(reader.frame(frame), sample(frame, counts[k], real)));
  }
}

}  // namespace

TEST_CASE("every frame comes back bit for bit", "[slow][run_file]") {
  SECTION("float") { check_round_trip({1000, 1000, 1000, 1000}, false, ScalarType::f32); }
  SECTION("double") { check_round_trip({1000, 1000}, false, ScalarType::f64); }
  SECTION("gzip") { check_round_trip({5000, 5000}, true, ScalarType::f32); }
  SECTION("numbers of particles that change") {
    check_round_trip({100, 101, 100, 7, 0, 350, 100}, false, ScalarType::f32);
  }
  SECTION("changing numbers with gzip") { check_round_trip({64, 640, 1}, true, ScalarType::f64); }
  SECTION("one particle") { check_round_trip({1, 1, 1}, false, ScalarType::f32); }
  SECTION("more rows than one chunk may have") {
    check_round_trip({(std::size_t{1} << 20) + 17, (std::size_t{1} << 20) + 17}, false,
                     ScalarType::f32);
  }
  SECTION("many frames") {
    check_round_trip(std::vector<std::size_t>(700, 3), false, ScalarType::f32);
  }
}

TEST_CASE("gzip makes the file of a smooth field smaller", "[run_file]") {
  const TemporaryFolder folder;
  std::int64_t bytes[2];
  for (const bool gzip : {false, true}) {
    RunWriter writer(folder / (gzip ? "a.h5" : "b.h5"), sample_info(100000), gzip);
    writer.write(sample(0, 100000));
    writer.finish({"finished"});
    bytes[gzip] = writer.bytes_written();
  }
  CHECK(bytes[1] < bytes[0] / 2);
}

TEST_CASE("what the run was comes back", "[run_file]") {
  const TemporaryFolder folder;
  const std::string path = folder / "run.vtkhdf";
  const RunInfo in = sample_info(42);
  RunWriter(path, in, false).finish({"stopped"});
  const RunReader reader(path);
  const RunInfo out = reader.info();
  CHECK(reader.frames() == 0);
  CHECK(reader.status() == "stopped");
  CHECK(out.scene_path == in.scene_path);
  CHECK(out.scene_text == in.scene_text);
  CHECK(out.resolved_scene == in.resolved_scene);
  CHECK(out.scene_files == in.scene_files);
  CHECK(out.scene_sha256 == in.scene_sha256);
  CHECK(out.overrides == in.overrides);
  CHECK(out.program_version == in.program_version);
  CHECK(out.commit == in.commit);
  CHECK(out.compiler == in.compiler);
  CHECK(out.build_flags == in.build_flags);
  CHECK(out.host == in.host);
  CHECK(out.started == in.started);
  CHECK(out.plan == in.plan);
  CHECK(out.solver.backend == in.solver.backend);
  CHECK(out.solver.precision == in.solver.precision);
  CHECK(out.solver.device == in.solver.device);
  CHECK(out.solver.driver.empty());
  CHECK(out.solver.threads == in.solver.threads);
  CHECK(out.solver.vol == in.solver.vol);
  CHECK(out.solver.wall_scale == in.solver.wall_scale);
  CHECK(out.solver.bytes == in.solver.bytes);
  CHECK(out.domain_min == in.domain_min);
  CHECK(out.domain_max == in.domain_max);
  CHECK(out.spacing == in.spacing);
  CHECK(out.smoothing_length == in.smoothing_length);
  CHECK(out.rest_density == in.rest_density);
  CHECK(out.particles == in.particles);
}

TEST_CASE("the log keeps every row, and stages that come later", "[run_file]") {
  const TemporaryFolder folder;
  const std::string path = folder / "run.vtkhdf";
  RunWriter writer(path, sample_info(10), false);
  const std::int64_t rows = 1500;
  for (std::int64_t k = 0; k < rows; ++k) {
    LogRow row = sample_row(k);
    if (k >= 1000) row.stages.push_back({"xsph", 7, 1});
    writer.log(row);
    if (k % 100 == 0) writer.write(sample(k, 10));
  }
  writer.finish({"finished"});
  const RunReader reader(path);
  const auto get = [&](const char* name) {
    const auto values = reader.log_column(name);
    REQUIRE(values.size() == static_cast<std::size_t>(rows));
    return values;
  };
  const auto time = get("time"), update = get("update"), mean = get("compression_mean"),
             momentum = get("momentum_z"), neighbors = get("neighbors_max"), dt = get("dt"),
             predict = get("stage/predict"), xsph = get("stage/xsph");
  for (std::size_t k = 0; k < static_cast<std::size_t>(rows); ++k) {
    const LogRow row = sample_row(static_cast<std::int64_t>(k));
    REQUIRE(time[k] == row.measures.time);
    REQUIRE(update[k] == static_cast<double>(row.measures.update));
    REQUIRE(mean[k] == row.measures.compression_mean);
    REQUIRE(momentum[k] == row.measures.momentum[2]);
    REQUIRE(neighbors[k] == static_cast<double>(row.measures.neighbors_max));
    REQUIRE(dt[k] == row.dt);
    REQUIRE(predict[k] == row.stages[0].seconds);
    REQUIRE(xsph[k] == (k >= 1000 ? 7 : 0));
  }
  const auto names = reader.log_columns();
  CHECK(names.size() == 39);
  CHECK(std::count(names.begin(), names.end(), "stage/lambda") == 1);
  CHECK(reader.log_column("no_such_column").empty());
  CHECK(reader.log_column("stage/no_such_stage").empty());
}

TEST_CASE("a live file reads as running with the frames written so far", "[run_file]") {
  const TemporaryFolder folder;
  const std::string path = folder / "run.vtkhdf";
  RunWriter writer(path, sample_info(500), false);
  CHECK(RunReader(path).frames() == 0);
  for (std::int64_t k = 0; k < 20; ++k) {
    writer.write(sample(k, 500));
    const auto sure = writer.frames_written();
    const RunReader reader(path);  // in the same process, while the writer's thread works
    REQUIRE(reader.frames() >= sure);
    REQUIRE(reader.status() == "running");
    if (reader.frames() > 0) {
      const auto last = reader.frames() - 1;
      REQUIRE(same(reader.frame(last), sample(last, 500)));
    }
  }
  writer.finish({"diverged"});
  CHECK(RunReader(path).status() == "diverged");
}

TEST_CASE("a writer that goes away without finish leaves all its frames and stopped",
          "[run_file]") {
  const TemporaryFolder folder;
  const std::string path = folder / "run.vtkhdf";
  {
    RunWriter writer(path, sample_info(50), false);
    for (std::int64_t k = 0; k < 5; ++k) writer.write(sample(k, 50));
  }
  const RunReader reader(path);
  CHECK(reader.frames() == 5);
  CHECK(reader.status() == "stopped");
}
