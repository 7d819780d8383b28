// pbf probe: gauges on the frames of a finished run.
#include <fmt/core.h>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "lib/base/json.h"
#include "lib/io/run_file.h"
#include "tests/support/catch.h"
#include "tests/support/process.h"

using namespace pbf::test;

namespace {

const std::string kProbed =
    "  - {name: H, kind: level, at: [0.1]}\n"
    "  - {name: U, kind: velocity, at: [0.2, 0.02, 0.1]}\n"
    "  - {name: Q, kind: flow, center: [0.4, 0, 0.4], normal: [1, 0], size: [0.8]}\n";
const std::string kProbedInSpace =
    "  - {name: H, kind: level, at: [0.1, 0.1]}\n"
    "  - {name: U, kind: velocity, at: [0.2, 0.1, 0.1]}\n"
    "  - {name: Q, kind: flow, center: [0.4, 0.1, 0.4], normal: [1, 0, 0], size: [0.2, 0.8]}\n";

/// A column of water that falls, read whenever a frame is written.
std::string probed_scene(bool flat, const std::string& gauges, const std::string& output = "",
                         const std::string& more = "") {
  return std::string("name: s\n") +
         (flat ? "dimensions: 2\ndomain: {min: [0, 0], max: [1, 0.8]}\n"
                 "bodies: [{shape: block, min: [0, 0], max: [0.4, 0.48]}]\n"
               : "domain: {min: [0, 0, 0], max: [1, 0.2, 0.8]}\n"
                 "bodies: [{shape: block, min: [0, 0, 0], max: [0.4, 0.2, 0.4]}]\n") +
         "fluid: {spacing: 0.04}\ntime: {step: 0.0025, end: 0.3}\nthreads: 1\n"
         "output: {every: 0.02, gauges_every: 0.02" +
         output + "}\n" + more + (gauges.empty() ? "" : "gauges:\n" + gauges);
}

Outcome probe_in(const Scratch& folder, const Args& args) {
  Args words{"probe"};
  words.insert(words.end(), args.begin(), args.end());
  return pbf::test::pbf(words, folder.path(), {"OMP_NUM_THREADS=1"});
}

/// Columns of a table without quotes, empty cells as NaN.
std::map<std::string, std::vector<double>> columns_of(const std::string& text) {
  std::map<std::string, std::vector<double>> columns;
  std::vector<std::string> names;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("#")) continue;
    std::vector<std::string> cells;
    std::istringstream in(line + ",");
    for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
    if (names.empty()) {
      names = cells;
      continue;
    }
    REQUIRE(cells.size() == names.size());
    for (std::size_t k = 0; k < cells.size(); ++k)
      columns[names[k]].push_back(cells[k].empty() ? NAN : std::stod(cells[k]));
  }
  return columns;
}

void check_same(const std::vector<double>& a, const std::vector<double>& b, double tolerance,
                std::size_t first = 0) {
  REQUIRE(a.size() == b.size());
  for (std::size_t k = first; k < a.size(); ++k) {
    CAPTURE(k, a[k], b[k]);
    CHECK((std::isnan(a[k]) ? std::isnan(b[k]) : std::fabs(a[k] - b[k]) <= tolerance));
  }
}

std::vector<double> component(const std::vector<double>& vectors, std::size_t c) {
  std::vector<double> out;
  for (std::size_t k = c; k < vectors.size(); k += 3) out.push_back(vectors[k]);
  return out;
}

}  // namespace

TEST_CASE("a probe reads what the run read at these updates, to the precision of its frames") {
  const Scratch folder;
  const bool flat = GENERATE(true, false), exact = GENERATE(true, false);
  const std::string& gauges = flat ? kProbed : kProbedInSpace;
  folder.write("s.yaml", probed_scene(flat, gauges, exact ? ", precision: double" : "",
                                      exact ? "precision: double\n" : ""));
  folder.write("more.yaml", "gauges:\n" + gauges);
  REQUIRE(run_scene(folder, "a").code == 0);
  const Outcome o = probe_in(folder, {"a", "--gauges", "more.yaml", "-o", "probe.csv"});
  CAPTURE(o.err);
  REQUIRE(o.code == 0);
  CHECK(has(o.out, "probe.csv: 3 gauges at 16 frames"));
  const std::string text = read_text(folder / "probe.csv");
  CHECK(has(text, "# source: run a, gauges more.yaml\n# units: time_s=s, H_m=m, U_x_m_s=m/s, "));
  CHECK(has(text, "\ntime_s,H_m,U_x_m_s,U_y_m_s,U_z_m_s,Q_kg_s,Q_total_kg\n"));
  const auto found = columns_of(text);
  const pbf::RunReader file((folder / "a/run.vtkhdf").string());
  CHECK(found.at("time_s") == file.times());
  check_same(found.at("time_s"), file.gauge("time"), 1e-12);
  // m and m/s: of positions up to 1 m in the precision of the frames.
  const double tolerance = exact ? 1e-9 : 2e-5;
  const auto level = file.gauge("H"), velocity = file.gauge("U"), total = file.gauge("total/Q");
  check_same(found.at("H_m"), level, tolerance);
  CHECK(level.front() > level.back() + 0.1);
  check_same(found.at("U_x_m_s"), component(velocity, 0), tolerance);
  check_same(found.at("U_y_m_s"), component(velocity, 1), tolerance);
  check_same(found.at("U_z_m_s"), component(velocity, 2), tolerance);
  // The gate closes the whole section, so nothing is lost between frames.
  check_same(found.at("Q_total_kg"), total, exact ? 1e-9 : 0.13);  // two particles at the plane
  CHECK(total.back() > 2);
  CHECK(std::isnan(found.at("Q_kg_s")[0]));
  if (exact) check_same(found.at("Q_kg_s"), file.gauge("Q"), 1e-6, 1);
  // Data for a comparison: levels without scales, of a run and its own probe.
  const Outcome compared = pbf::test::pbf(
      {"compare-data", "a", "--data", "probe.csv", "--gauge", "H", "--gauge", "U/x", "--json"},
      folder.path());
  CAPTURE(compared.err);
  REQUIRE(compared.code == 0);
  CHECK(pbf::Json::parse(compared.out).at("H").at("rms").get<double>() <= tolerance);
  CHECK(pbf::Json::parse(compared.out).at("U_x").at("points") == 16);
}

TEST_CASE("a probe follows particles by their ids where they come and go") {
  const Scratch folder;
  folder.write("s.yaml",
               "name: s\ndomain: {min: [0, 0, 0], max: [0.8, 0.4, 0.4]}\nfluid: {spacing: 0.04}\n"
               "bodies: [{shape: block, min: [0, 0, 0], max: [0.8, 0.4, 0.12]}]\n"
               "emitters: [{name: jet, shape: rectangle, center: [0.2, 0.2, 0.25], normal: [1, 0, "
               "0], size: [0.1, 0.1], speed: 2}]\n"
               "sinks: [{name: drain, min: [0.7, 0, 0], max: [0.8, 0.4, 0.4]}]\n"
               "time: {step: 0.0025, end: 0.4}\noutput: {every: 0.04}\nthreads: 1\n");
  folder.write("more.yaml",
               "gauges: [{name: Q, kind: flow, center: [0.5, 0.2, 0.2], normal: [1, 0, 0], size: "
               "[0.4, 0.4]}]\n");
  const Outcome run = run_scene(folder, "a");
  CAPTURE(run.err);
  REQUIRE(run.code == 0);
  const Outcome o = probe_in(folder, {"a", "--gauges", "more.yaml"});
  CAPTURE(o.err);
  REQUIRE(o.code == 0);
  const pbf::RunReader file((folder / "a/run.vtkhdf").string());
  CHECK(file.counts().back() != file.counts().front());
  std::map<std::int64_t, bool> before;
  std::vector<double> total{0};
  for (std::int64_t k = 0; k < file.frames(); ++k) {
    const pbf::Snapshot frame = file.frame(k);
    std::map<std::int64_t, bool> now;
    for (std::size_t i = 0; i < frame.count; ++i)
      now[frame.find("id")->whole(i)] = frame.fields[0].number(3 * i) >= 0.5;
    double net = 0;
    for (const auto& [id, beyond] : now)
      if (before.contains(id)) net += double(beyond) - double(before[id]);
    if (k > 0) total.push_back(total.back() + net * 0.04 * 0.04 * 0.04 * 1000);
    before = now;
  }
  check_same(columns_of(o.out).at("Q_total_kg"), total, 1e-9);
  CHECK(total.back() > 1);
}

TEST_CASE("what a probe cannot read is one error with its place and the remedy") {
  const Scratch folder;
  folder.write("s.yaml", probed_scene(true, kProbed, ", fields: [density]",
                                      "compare: []\nsummary: [gauge/H/max]\n"));
  REQUIRE(run_scene(folder, "a", {"--set", "time.end=0.06"}).code == 0);
  REQUIRE(run_scene(folder, "one", {"--max-walltime", "0.0001", "--set", "time.end=9"}).code == 75);
  const std::string h = "{name: H, kind: level, at: [0.1]}";
  const std::vector<std::pair<std::string, std::string>> mistakes{
      {"gauges:\n  - " + h +
           "\n  - {name: P, kind: pressure, on: z_min, at: [0.2, 0, 0], radius: "
           "0.1}\n",
       "more.yaml:3:5: gauges[1]: a pressure comes from what the iterations of an update did "
       "(their "
       "multipliers), as loads do, and no frame holds that; put the gauge into the scene"},
      {"gauges: [{name: F, kind: load, at: [0.1]}]\n",
       "more.yaml:1:26: gauges[0].kind: \"load\" is not one of level, line, velocity, flow, "
       "pressure"},
      {"gauges: [{name: H, kind: level, at: [3]}]\n",
       "more.yaml:1:37: gauges[0].at: x is 3, outside the domain (x from 0 to 1 m); move the "
       "gauge"},
      {"gauges: [{name: H, kind: level, at: [0.1], hight: 3}]\n", "more.yaml:1:44"},
      {"gauges: [" + h + ", " + h + "]\n", "is also the name of gauges[0]"},
      {"gauges: [{name: U, kind: velocity, at: [0.2, 0, 0.1]}]\n",
       "gauge U reads a velocity, and the frames of the run have none; run the scene with "
       "output.fields"},
      {"name: s\ngauges: [" + h + "]\n", "more.yaml:1:1: name: does not belong here; give gauges"},
      {"gauges: []\n", "gauges: has no gauge; give gauges alone"},
      {"gauges: on\n", "gauges: is \"on\", expected a list; give gauges alone"},
      {"gauges: [" + h + "]\ngauges: [" + h + "]\n",
       "more.yaml:2:1: gauges: given twice, first at more.yaml:1:1"},
      {"- " + h + "\n", "is a list of 1, no file of gauges; give gauges alone"}};
  for (const auto& [text, message] : mistakes) {
    folder.write("more.yaml", text);
    const Outcome o = probe_in(folder, {"a", "--gauges", "more.yaml", "-o", "never.csv"});
    CAPTURE(text, o.err);
    CHECK(o.code == 2);
    CHECK(has(o.err, message));
    CHECK(std::count(o.err.begin(), o.err.end(), '\n') <= 1);
    CHECK_FALSE(std::filesystem::exists(folder / "never.csv"));
  }
  folder.write(
      "more.yaml",
      "gauges: [{name: Q, kind: flow, center: [0.4, 0, 0.4], normal: [1, 0], size: [0.8]}]\n");
  const Outcome few = probe_in(folder, {"one", "--gauges", "more.yaml"});
  CHECK(few.code == 2);
  CHECK(has(few.err,
            "gauge Q reads a flow between two frames, and the run has 1; run the scene with a "
            "shorter output.every"));
  CHECK(probe_in(folder, {"a", "--gauges", "nothing.yaml"}).code == 2);
  CHECK(probe_in(folder, {"s.yaml", "--gauges", "more.yaml"}).code == 5);
  CHECK(probe_in(folder, {"a"}).code == 2);
  const Outcome over = probe_in(folder, {"a", "--gauges", "more.yaml", "-o", "more.yaml"});
  CHECK(over.code == 2);
  CHECK(has(read_text(folder / "more.yaml"), "gauges:"));
}
