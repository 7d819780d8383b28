// What gauges and loads were like: columns of a batch's summary.
#include <fmt/core.h>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "lib/base/json.h"
#include "lib/io/run_file.h"
#include "tests/support/catch.h"
#include "tests/support/process.h"

using namespace pbf::test;

namespace {

/// A column of water that falls against a post.
std::string falling_column(const std::string& more = "") {
  return "name: s\ndimensions: 2\n"
         "domain: {min: [0, 0], max: [1, 0.8]}\n"
         "fluid: {spacing: 0.04}\n"
         "bodies: [{shape: block, min: [0, 0], max: [0.4, 0.48]}]\n"
         "obstacles: [{name: post, shape: box, min: [0.6, 0, 0], max: [0.7, 1, 0.2], loads: "
         "true}]\n"
         "gauges:\n"
         "  - {name: H, kind: level, at: [0.1]}\n"
         "  - {name: U, kind: velocity, at: [0.2, 0.02, 0.1]}\n"
         "  - {name: Q, kind: flow, center: [0.5, 0, 0.4], normal: [1, 0], size: [0.8]}\n"
         "time: {step: 0.0025, end: 0.5}\nmeasure_every: 4\n"
         "output: {every: 0.1, gauges_every: 0.01}\n" +
         more;
}

Outcome in_folder(const Scratch& folder, const Args& args) {
  return pbf::test::pbf(args, folder.path(), {"OMP_NUM_THREADS=1"});
}

pbf::Json rows_of(const Scratch& folder, const std::string& batch) {
  return pbf::Json::parse(read_text(folder / (batch + "/summary.json"))).at("rows");
}

/// The mean of readings at `time` from `from` on, each one the mean since the one before or not.
double mean_from(const std::vector<double>& time, const std::vector<double>& value, double from,
                 bool means) {
  double sum = 0, length = 0;
  for (std::size_t k = 1; k < time.size(); ++k) {
    if (time[k - 1] < from - 1e-9) continue;
    const double dt = time[k] - time[k - 1];
    sum += dt * (means ? value[k] : 0.5 * (value[k] + value[k - 1]));
    length += dt;
  }
  return sum / length;
}

}  // namespace

TEST_CASE("a batch has the largest and mean readings of gauges and loads as columns") {
  const Scratch folder;
  folder.write("s.yaml", falling_column());
  const Outcome run = in_folder(
      folder, {"batch", "s.yaml", "--grid", "measure_every=2,4,8,12", "--out", "o", "--quiet"});
  CAPTURE(run.err);
  REQUIRE(run.code == 0);
  const std::string head = read_text(folder / "o/summary.csv");
  CHECK(has(head, ",seconds,gauge/H/max,gauge/H/mean,gauge/U/x/max,gauge/U/x/mean,gauge/U/z/max,"));
  CHECK(has(head, ",load/post/force_x/max_20ms,load/post/force_x/mean,load/post/impulse_x,load/"));
  CHECK_FALSE(has(head, "force_y"));
  CHECK(has(head, "gauge/Q/max=kg/s, "));
  CHECK(has(head, "load/post/force_z/mean=N, load/post/impulse_z=N s"));
  const pbf::Json rows = rows_of(folder, "o");
  for (const double from : {0.0, 0.18}) {
    if (from > 0) {  // another answer about the same runs
      folder.write("s.yaml", falling_column("summary_from: 0.18\n"));
      REQUIRE(in_folder(folder, {"batch", "s.yaml", "--grid", "measure_every=2,4,8,12", "--out",
                                 "o", "--collect"})
                  .code == 0);
    }
    const pbf::Json now = rows_of(folder, "o");
    REQUIRE(now.size() == 4);
    for (const pbf::Json& row : now) {
      CHECK(row.at("reason") == "finished");
      const pbf::RunReader file(
          (folder / ("o/" + row.at("name").get<std::string>() + "/run.vtkhdf")).string());
      const auto time = file.gauge("time"), level = file.gauge("H"), flow = file.gauge("Q");
      double most = 0;
      for (std::size_t k = 0; k < time.size(); ++k)
        if (time[k] >= from - 1e-9) most = std::max(most, level[k]);
      CHECK(row.at("gauge/H/max").get<double>() == most);
      CHECK(row.at("gauge/H/mean").get<double>() ==
            Approx(mean_from(time, level, from, false)).epsilon(1e-9));
      CHECK(row.at("gauge/Q/mean").get<double>() ==
            Approx(mean_from(time, flow, from, true)).epsilon(1e-9));
      const auto at = file.log_column("time"), impulse = file.log_column("load/post/impulse_x"),
                 force = file.log_column("load/post/force_x");
      std::size_t first = 0;
      while (at[first] < from - 1e-9) ++first;
      CHECK(impulse.back() > 0);
      CHECK(row.at("load/post/impulse_x").get<double>() ==
            Approx(impulse.back() - impulse[first]).epsilon(1e-9));
      CHECK(row.at("load/post/force_x/mean").get<double>() ==
            Approx(mean_from(at, force, from, true)).epsilon(1e-6));
      const pbf::Json& peak = row.at("load/post/force_x/max_20ms");
      if (row.at("measure_every") == 12)
        CHECK(peak.is_null());  // 30 ms
      else if (row.at("measure_every") == 8)
        CHECK(peak.get<double>() ==
              Approx(*std::max_element(force.begin() + long(first) + 1, force.end())));
      else
        CHECK(peak.get<double>() >= now[2].at("load/post/force_x/max_20ms").get<double>() - 1e-9);
    }
    // The same run, measured more or less often.
    CHECK(now[0].at("load/post/impulse_x").get<double>() ==
          Approx(now[2].at("load/post/impulse_x").get<double>()).epsilon(1e-6));
  }
  CHECK(rows_of(folder, "o")[0].at("gauge/H/max").get<double>() <
        rows[0].at("gauge/H/max").get<double>());
}

TEST_CASE("a batch with too many gauges says so, and has those that its scene names") {
  const Scratch folder;
  std::string gauges = "gauges:\n";
  for (int k = 0; k < 101; ++k)
    gauges += fmt::format("  - {{name: g{}, kind: level, at: [0.1]}}\n", k);
  std::string scene = falling_column("summary: [gauge/g7/max]\n");
  const auto at = scene.find("gauges:\n"), end = scene.find("time:");
  scene.replace(at, end - at, gauges);
  folder.write("named.yaml", scene);
  folder.write("all.yaml", scene.substr(0, scene.find("summary:")));
  const auto batch = [&](const std::string& scenes, const char* out) {
    return in_folder(folder, {"batch", scenes, "--out", out, "--set", "time.end=0.05"});
  };
  const Outcome all = batch("all.yaml", "a");
  REQUIRE(all.code == 0);
  CHECK(has(all.err,
            "warning: the gauges and loads of 1 of 1 runs would be more than 200 columns of "
            "summary.csv each, and are left out"));
  CHECK_FALSE(has(read_text(folder / "a/summary.csv"), "gauge/"));
  const Outcome named = batch("named.yaml", "b");
  REQUIRE(named.code == 0);
  CHECK_FALSE(has(named.err, "200 columns"));
  CHECK(has(read_text(folder / "b/summary.csv"), ",seconds,gauge/g7/max\n"));
  // Together with others that would be too many.
  folder.write("more.yaml", falling_column());
  folder.write("list.txt", "named.yaml\nall.yaml\nmore.yaml\n");
  const Outcome mixed = batch("list.txt", "c");
  REQUIRE(mixed.code == 0);
  CHECK(has(mixed.err, "the gauges and loads of 1 of 3 runs would be more than 200 columns"));
  CHECK(
      has(read_text(folder / "c/summary.csv"), ",seconds,gauge/g7/max,gauge/H/max,gauge/H/mean,"));
}

TEST_CASE("a column that a summary cannot have is refused before a batch begins") {
  const Scratch folder;
  folder.write("s.yaml", falling_column("summary: [gauge/H/men]\n"));
  const Outcome o = in_folder(folder, {"batch", "s.yaml", "--out", "o"});
  CHECK(o.code == 2);
  CHECK(has(o.err,
            "s.yaml:14:10: summary: there is no column gauge/H/men; did you mean "
            "gauge/H/mean?"));
  CHECK_FALSE(std::filesystem::exists(folder / "o"));
}

TEST_CASE("a time that no run reaches leaves the cells of readings empty") {
  const Scratch folder;
  folder.write("s.yaml", falling_column("summary_from: 3\n"));
  REQUIRE(in_folder(folder, {"batch", "s.yaml", "--grid", "time.end=0.05", "--out", "o", "--quiet"})
              .code == 0);
  const pbf::Json row = rows_of(folder, "o").at(0);
  for (const auto& [name, value] : row.items())
    if (name.starts_with("gauge/") || name.starts_with("load/")) {
      CAPTURE(name);
      CHECK(value.is_null());
    }
  CHECK(row.contains("gauge/H/max"));
  CHECK(row.contains("load/post/impulse_z"));
}
