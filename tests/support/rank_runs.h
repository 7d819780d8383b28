// Runs of a scene on ranks that are threads of one process, and on one.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "lib/exec/make_solver.h"
#include "lib/exec/ranks/rank_states.h"
#include "lib/exec/ranks/ranked_solver.h"
#include "lib/exec/ranks/thread_ranks.h"
#include "lib/program/dissipation.h"
#include "lib/run/emit.h"
#include "lib/run/linked_files.h"
#include "lib/run/start_neighbors.h"
#include "lib/scene/load.h"
#include "tests/support/catch.h"

namespace pbf::test {

struct RankScene {
  Scene scene;
  Particles particles;
  Plan plan;
  RankScene(const std::string& name, std::vector<std::string> set) {
    set.insert(set.end(), {"output=off", "render=off", "threads=1"});
    const std::string file = std::string(PBF_SOURCE_DIR) + "/" + name + ".yaml";
    const std::string folder = file.substr(0, file.rfind('/'));
    scene = load_scene(file, set).scene;
    read_linked_files(scene, folder);
    StartPoints points(scene, folder);
    const std::int64_t n = count_particles(points);
    plan = make_plan(scene, n, start_neighbors(points, n));
    particles = emit_particles(std::move(points));
  }
  Particles part(const Communicator& c) const {
    FirstRanks first(scene, plan, c.size());
    first.count(particles);
    first.cut();
    return part_of(particles, first.rows_of_ranks(particles)[std::size_t(c.rank())]);
  }
};

/// All that a run asks of a solver.
struct Seen {
  SolverState state, positions;
  Snapshot snapshot;
  std::vector<double> loads, gauges;
  Diagnostics measured;
};
inline Seen look(Solver& s) {
  Seen seen;
  seen.measured = s.diagnose();
  seen.loads = s.readings(Series::measures, Interval::ends);
  seen.gauges = s.readings(Series::gauges, Interval::ends);
  seen.snapshot = s.download({"velocity", "density"}, ScalarType::f32).get();
  seen.state = s.state();
  seen.positions = s.state(StateOf::positions);
  return seen;
}
/// Updates, looks, goes back and forth.
inline std::vector<Seen> course(Solver& s, int updates) {
  std::vector<Seen> all;
  s.step(2, {.without_time = 0.5});
  s.step(updates / 2);
  all.push_back(look(s));
  s.keep();
  const SolverState kept = s.state(StateOf::kept);
  s.step(updates / 2);
  all.push_back(look(s));
  s.set_state(kept);
  s.step(3);
  all.push_back(look(s));
  return all;
}
inline std::vector<Seen> on_one(const RankScene& m, int updates) {
  return course(*make_solver(m.scene, m.plan, m.particles), updates);
}
inline std::vector<Seen> on_ranks(const RankScene& m, int ranks, int updates) {
  std::vector<Seen> all;
  run_thread_ranks(ranks, [&](Communicator& c) {
    RankedSolver s(c, m.scene, m.plan, m.part(c));
    c.rank() == 0 ? void(all = course(s, updates)) : s.serve();
  });
  return all;
}
inline bool same_bits(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }
/// The sums over a cause's numbers; its first sum holds all on ranks.
inline std::vector<double> totals(const StoredField& f, std::size_t causes) {
  std::vector<double> all(causes);
  for (std::size_t k = 0; k < f.values.size(); k += 2)
    all[k / (f.values.size() / causes)] += f.values[k] * 0x1p27 + f.values[k + 1];
  return all;
}
inline void check_same(const Seen& a, const Seen& b, const Scene& scene) {
  const std::size_t causes = dissipations(scene).size();
  CHECK(a.state.position == b.state.position);
  CHECK(a.state.velocity == b.state.velocity);
  CHECK(a.state.id == b.state.id);
  REQUIRE(a.state.fields.size() == b.state.fields.size());
  for (std::size_t k = 0; k < a.state.fields.size(); ++k) {
    CAPTURE(a.state.fields[k].name);
    if (a.state.fields[k].name == std::string("dissipation"))
      CHECK(totals(a.state.fields[k], causes) == totals(b.state.fields[k], causes));
    else
      CHECK(a.state.fields[k] == b.state.fields[k]);
  }
  CHECK(a.positions.position == b.positions.position);
  CHECK(a.positions.id == b.positions.id);
  CHECK(a.loads == b.loads);
  CHECK(a.gauges == b.gauges);
  for (std::size_t k = 0; k < a.snapshot.fields.size(); ++k)
    CHECK(a.snapshot.fields[k].bytes == b.snapshot.fields[k].bytes);
  for (const Diagnostic& c : diagnostics()) {
    CAPTURE(c.name);
    CHECK(same_bits(c.value(a.measured), c.value(b.measured)));
  }
}

}  // namespace pbf::test
