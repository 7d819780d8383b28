// The program's list of stages is that of the page, and nothing is booked beside it.
#include "lib/base/stages.h"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <thread>

#include "lib/exec/make_solver.h"
#include "lib/program/plan.h"
#include "lib/run/emit.h"
#include "lib/scene/load.h"
#include "lib/solver/solver.h"
#include "tests/support/catch.h"

using namespace pbf;

namespace {

std::string text_of(const std::string& path) {
  std::ifstream in(std::string(PBF_SOURCE_DIR) + "/" + path);
  REQUIRE(in);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Stage: group, of the program.
std::map<std::string, std::string> listed() {
  std::map<std::string, std::string> out;
  for (const Stage& s : kStages)
    CHECK(out.emplace(s.name, kStageGroups[static_cast<int>(s.group)].name).second);
  return out;
}

/// All matches of the first group.
std::vector<std::string> all(const std::string& text, const std::string& pattern) {
  const std::regex r(pattern);
  std::vector<std::string> out;
  for (auto m = std::sregex_iterator(text.begin(), text.end(), r); m != std::sregex_iterator(); ++m)
    out.push_back((*m)[1]);
  return out;
}

/// The text from `begin` to the next `end`.
std::string between(const std::string& text, const std::string& begin, const std::string& end) {
  const std::size_t from = text.find(begin);
  REQUIRE(from != std::string::npos);
  const std::size_t start = from + begin.size();
  return text.substr(start, text.find(end, start) - start);
}

}  // namespace

TEST_CASE("app/README.md's table of stages has every stage of the program in its group, no other") {
  const std::string table = between(
      text_of("app/README.md"), "| stage | does | group in the summary |\n|---|---|---|\n", "\n\n");
  std::map<std::string, std::string> there;
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t cell = line.find('|', 1), last = line.rfind('|', line.size() - 2);
    const std::string group = line.substr(last + 2, line.size() - last - 4);
    for (const std::string& name : all(line.substr(0, cell), "`([a-z]+)`"))
      CHECK(there.emplace(name, group).second);
  }
  CHECK(there == listed());
}

TEST_CASE("a solver books and a plan names listed stages only, and the list has no dead ones") {
  std::set<std::string> names, seen{"init", "guard", "write", "render"};  // those of the program
  seen.insert("exchange");                                                // of several ranks
  for (const Stage& s : kStages) names.insert(s.name);
  for (const std::vector<std::string>& keys :
       {std::vector<std::string>{"solver.tolerance=1e-6", "viscosity.xsph=0.1",
                                 "vorticity.epsilon=0.1"},
        std::vector<std::string>{"solver.fused=false", "solver.substeps=2", "solver.levels=on",
                                 "solver.hyperviscosity=0.4", "time.step=0.05"}}) {
    std::vector<std::string> overrides = keys;
    overrides.emplace_back("fluid.spacing=0.05");
    const Scene scene =
        load_scene(std::string(PBF_SOURCE_DIR) + "/configs/minimal.yaml", overrides).scene;
    Particles particles = emit_particles(scene, ".");
    const Plan plan = make_plan(scene, std::int64_t(particles.size()));
    for (const PassCount& c : count_passes(plan.program)) CHECK(names.count(c.pass->stage) == 1);
    const auto solver = make_solver(scene, plan, std::move(particles));
    solver->step(3);
    solver->diagnose();
    solver->download({"velocity"}, ScalarType::f32).get();
    for (const StageTime& t : solver->info().stages) {
      CAPTURE(t.name);
      CHECK(names.count(t.name) == 1);
      seen.insert(t.name);
    }
  }
  CHECK(seen == names);
}

TEST_CASE("what passes between the calls of a solver is booked to no stage") {
  const Scene scene =
      load_scene(std::string(PBF_SOURCE_DIR) + "/configs/minimal.yaml", {"fluid.spacing=0.05"})
          .scene;
  Particles particles = emit_particles(scene, ".");
  const Plan plan = make_plan(scene, std::int64_t(particles.size()));
  const auto solver = make_solver(scene, plan, std::move(particles));
  const auto booked = [&] {
    double sum = 0;
    for (const StageTime& t : solver->info().stages) sum += t.seconds;
    return sum;
  };
  const double before = booked();
  double within = 0;  // s, in the calls
  const auto call = [&](auto what) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    const Stopwatch watch;
    what();
    within += watch.seconds();
  };
  for (int k = 0; k < 3; ++k) {
    call([&] { solver->step(2); });
    call([&] { solver->diagnose(); });
    call([&] { solver->download({"density"}, ScalarType::f32).get(); });
  }
  CHECK(booked() - before <= within);
}
