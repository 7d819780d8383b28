// Readings of a run beside measurements: in a scene, of a finished run, in batches and studies.
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

/// A column of water that falls; its scene compares as `compare` says.
void write_measured_scene(const Scratch& folder, const std::string& compare,
                          const std::string& more = "output: {every: 0.1, gauges_every: 0.01}\n") {
  folder.write("s.yaml",
               "name: s\ndimensions: 2\n"
               "domain: {min: [0, 0], max: [1, 0.8], loads: true}\n"
               "fluid: {spacing: 0.04}\n"
               "bodies: [{shape: block, min: [0, 0], max: [0.4, 0.48]}]\n"
               "gauges:\n"
               "  - {name: H, kind: level, at: [0.1]}\n"
               "  - {name: U, kind: velocity, at: [0.2, 0.02, 0.1]}\n"
               "time: {step: 0.0025, end: 0.5}\nmeasure_every: 4\n" +
                   more + (compare.empty() ? "" : "compare: [" + compare + "]\n"));
}

/// The readings of a run as a table, times in ms from `shift` (s) on, levels in mm.
void write_table(const Scratch& folder, const std::string& run, double shift = 0) {
  const pbf::RunReader file((folder / (run + "/run.vtkhdf")).string());
  const auto time = file.gauge("time"), level = file.gauge("H");
  std::string text = "# source: a run\nt_ms,H_mm,t_over_T\n";
  for (std::size_t k = 0; k < time.size(); ++k)
    if (time[k] + shift >= 0)
      text += fmt::format("{:.17g},{:.17g},{:.17g}\n", 1e3 * (time[k] + shift), 1e3 * level[k],
                          (time[k] + shift) / 0.25);
  folder.write("data.csv", text);
}

Outcome pbf_in(const Scratch& folder, const Args& args) {
  return pbf::test::pbf(args, folder.path(), {"OMP_NUM_THREADS=1"});
}

double number(const pbf::StoredComparison& c, const std::string& name) {
  for (const auto& n : c.numbers)
    if (n.name == name) return n.value;
  return NAN;
}

std::vector<pbf::StoredComparison> compared(const Scratch& folder, const std::string& run) {
  return pbf::RunReader((folder / (run + "/run.vtkhdf")).string()).comparisons();
}

}  // namespace

TEST_CASE(
    "a run has no difference from its own readings, and finds by how much a copy is shifted") {
  const Scratch folder;
  write_measured_scene(folder, "");
  REQUIRE(run_scene(folder, "a").code == 0);
  CHECK(compared(folder, "a").empty());
  write_table(folder, "a", -0.07);
  write_measured_scene(folder,
                       "{gauge: H, data: data.csv, lag: fit, lag_range: [-0.2, 0.2]},"
                       "{name: again, gauge: H, data: data.csv, lag: H},"
                       "{name: periods, gauge: H, data: data.csv, column: H_mm, time_column: "
                       "t_over_T, time_scale: 0.25, lag: 0.07},"
                       "{log: energy, data: a}, {load: x_min, component: x, data: a},"
                       "{gauge: U, component: z, data: a}");
  const Outcome run = run_scene(folder, "b");
  CAPTURE(run.err);
  REQUIRE(run.code == 0);
  CHECK(run.out.find("compared with measurements") != std::string::npos);
  const auto results = compared(folder, "b");
  REQUIRE(results.size() == 6);
  for (const pbf::StoredComparison& c : results) {
    CAPTURE(c.name);
    const bool shifted = c.name == "H" || c.name == "again" || c.name == "periods";
    CHECK(number(c, "rms") == Approx(0).margin(1e-12));
    CHECK(number(c, "lag_s") == Approx(shifted ? 0.07 : 0).margin(1e-12));
    CHECK(number(c, "correlation") == Approx(1));
    CHECK(number(c, "points") >= 40);
    CHECK(number(c, "peak") == Approx(number(c, "peak_data")));
    CHECK(number(c, "impulse") == Approx(number(c, "impulse_data")));
    CHECK(number(c, "arrival_s") == Approx(number(c, "arrival_data_s") + number(c, "lag_s")));
  }
  // The same afterwards, by the scene and by options.
  const Outcome later = pbf_in(folder, {"compare-data", "b", "--json"});
  REQUIRE(later.code == 0);
  const pbf::Json all = pbf::Json::parse(later.out);
  CHECK(all.at("again").at("lag_s").get<double>() == Approx(0.07));
  CHECK(all.at("U_z").at("unit") == "m/s");
  const Outcome twice = pbf_in(folder, {"compare-data", "b", "--data", "data.csv", "--gauge",
                                        "H=H_mm", "--gauge", "H=H_mm"});
  CHECK(twice.code == 2);
  CHECK(has(twice.err, "H is compared twice"));
  // A clock that began much later: the lag makes the data those of the run.
  folder.write(
      "late.csv", "t,H_m\n" + [&] {
        const pbf::RunReader file((folder / "a/run.vtkhdf").string());
        std::string rows;
        const auto time = file.gauge("time"), level = file.gauge("H");
        for (std::size_t k = 0; k < time.size(); ++k)
          rows += fmt::format("{:.17g},{:.17g}\n", time[k] - 8, level[k]);
        return rows;
      }());
  for (const char* lag : {"8", "fit"}) {
    Args words{"compare-data", "b", "--data", "late.csv", "--gauge", "H", "--lag", lag, "--json"};
    if (lag == std::string("fit")) words.push_back("--lag-range=7.9,8.1");
    const Outcome late = pbf_in(folder, words);
    CAPTURE(late.err);
    REQUIRE(late.code == 0);
    CHECK(pbf::Json::parse(late.out).at("H").at("rms").get<double>() < 1e-9);
  }
  const Outcome options = pbf_in(
      folder, {"compare-data", "b", "--data", "data.csv", "--gauge", "H=H_mm", "--lag", "0.07"});
  CHECK(options.code == 0);
  CHECK(options.out.find("RMS") != std::string::npos);
}

TEST_CASE("each mistake in a compare block ends before the run, in one sentence with its place") {
  const Scratch folder;
  write_measured_scene(folder, "");
  REQUIRE(run_scene(folder, "a").code == 0);
  write_table(folder, "a");
  folder.write("short.csv", "t,H_m\n0,0.4\n0.1,0.3\n0.2,0.3\n");
  folder.write(
      "late.csv", "t,H_m\n" + [] {
        std::string rows;
        for (int k = 0; k < 30; ++k) rows += std::to_string(0.3 + 0.1 * k) + ",0.4\n";
        return rows;
      }());
  const std::vector<std::pair<std::string, std::string>> mistakes{
      {"{gauge: H}", "s.yaml:12:11: compare[0].data: missing"},
      {"{data: data.csv}", "compare[0].gauge: which reading?"},
      {"{gauge: H, log: energy, data: data.csv}", "compare[0].gauge: is given beside another"},
      {"{gauge: G, data: data.csv}", "compare[0].gauge: no gauge is named G; "},
      {"{gauge: U, data: data.csv}", "compare[0].component: is missing: U reads a velocity"},
      {"{gauge: H, component: x, data: data.csv}", "compare[0].component: goes with a velocity"},
      {"{load: post, component: x, data: data.csv}", "compare[0].load: no wall or obstacle"},
      {"{load: x_min, data: data.csv}", "compare[0].component: is missing; give x, y or z"},
      {"{log: enrgy, data: data.csv}", "the log has no column enrgy; did you mean energy?"},
      {"{gauge: H, data: nothing.csv}", "its path counts from the folder of the scene file"},
      {"{gauge: H, data: data.csv, column: h}", "no column h; there are t_ms; H_mm"},
      {"{gauge: H, data: data.csv, time_column: t_over_T}", "t_over_T has no unit of time"},
      {"{gauge: H, data: data.csv, column: t_ms}", "column t_ms is in ms, and H is in m"},
      {"{gauge: H, data: data.csv, between: [2, 1]}", "compare[0].between: is not two numbers"},
      {"{gauge: H, data: data.csv, lag: fit}", "compare[0].lag_range: is missing"},
      {"{gauge: H, data: data.csv, lag: H2}", "compare[0].lag: is \"H2\": give none, fit"},
      {"{gauge: H, data: data.csv, lag_range: [0, 1]}", "compare[0].lag_range: goes with lag: fit"},
      {"{gauge: H, data: data.csv}, {gauge: H, data: data.csv}",
       "is also the result of compare[0]"},
      {"{gauge: H, data: short.csv}", "3 of its 3 measured times lie within the run"},
      {"{gauge: H, data: late.csv}", "3 of its 30 measured times lie within the run"},
      {"{gauge: H, data: s.yaml}", "s.yaml"},
      {"{gauge: H, data: b}", "b"}};
  for (const auto& [block, message] : mistakes) {
    write_measured_scene(folder, block);
    const Outcome run = run_scene(folder, "never");
    CAPTURE(block, run.err);
    CHECK((run.code == 2 || run.code == 5));
    CHECK(has(run.err, message));
    CHECK(has(run.err, "s.yaml"));
    CHECK_FALSE(std::filesystem::exists(folder / "never"));
  }
  write_measured_scene(folder, "{gauge: H, data: data.csv}", "");
  const Outcome run = run_scene(folder, "never");
  CHECK(run.code == 2);
  CHECK(run.err.find("add output") != std::string::npos);
}

TEST_CASE("comparisons are columns of a batch and errors of a study, and resume with their run") {
  const Scratch folder;
  write_measured_scene(folder, "");
  REQUIRE(run_scene(folder, "a").code == 0);
  write_table(folder, "a");
  write_measured_scene(folder, "{gauge: H, data: data.csv}, {log: energy, data: a}");
  const Outcome batch = pbf_in(
      folder, {"batch", "s.yaml", "--grid", "solver.iterations=2,4", "--out", "sweep", "--quiet"});
  CAPTURE(batch.err);
  REQUIRE(batch.code == 0);
  const std::string summary = read_text(folder / "sweep/summary.csv");
  CHECK(summary.find(",compare/H/rms,compare/H/rms_relative,") != std::string::npos);
  CHECK(summary.find("compare/energy/rms=J") != std::string::npos);
  folder.write("study.yaml",
               "scene: s.yaml\ngrid: {solver.iterations: [2, 4]}\nrepeats: 1\nenergy_limit: 1\n"
               "error: [compare/H/rms_relative, compare/rms_relative]\n");
  const Outcome study = pbf_in(folder, {"study", "study.yaml", "--out", "st"});
  CAPTURE(study.err, study.out);
  REQUIRE(study.code == 0);
  const std::string table = read_text(folder / "st/study.csv");
  CHECK(table.find("compare/H/rms,compare/H/rms_relative") != std::string::npos);
  // With four iterations it is the run itself, measured every fourth update as the table's times.
  CHECK(table.find(",compare/H/rms_relative,true") != std::string::npos);
}
