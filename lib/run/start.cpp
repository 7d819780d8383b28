#include "lib/run/start.h"

#include <fmt/core.h>
#include <memory>
#include <utility>

#include "lib/base/error.h"
#include "lib/base/machine.h"
#include "lib/exec/make_solver.h"
#include "lib/exec/ranks/world.h"
#include "lib/program/motion.h"
#include "lib/program/obstacles.h"
#include "lib/run/emit.h"
#include "lib/run/free_starts.h"
#include "lib/run/prestabilize.h"
#include "lib/run/settle.h"
#include "lib/run/start_neighbors.h"

namespace pbf::run_module {
namespace {

constexpr std::int64_t kStartRows = 1 << 16;  // particles of a piece

std::vector<std::string> notes_of(const Particles& p, const Scene& scene) {
  std::vector<std::string> notes;
  if (p.put_on_margin > 0)
    notes.push_back(
        fmt::format("{} particles were nearer to a wall than solver.wall_margin ({:.6g} m), by up "
                    "to {:.3g} m; they start at that distance",
                    p.put_on_margin, scene.solver.wall_margin, p.farthest_put));
  for (std::size_t b = 0; b < p.in_obstacles.size(); ++b)
    if (p.in_obstacles[b] > 0)
      notes.push_back(fmt::format(
          "{} particles of bodies[{}] are in {}, or nearer to one than 0.4 spacings, and "
          "are left out",
          p.in_obstacles[b], b,
          scene.emitters.empty()    ? "obstacles"
          : scene.obstacles.empty() ? "casings of emitters"
                                    : "obstacles and casings of emitters"));
  return notes;
}

}  // namespace

Start prepare(LoadedScene loaded, const PrepareOptions& options) {
  Start start{std::move(loaded)};
  const Scene& scene = start.scene();
  const std::size_t available = available_memory();  // without the particles, which the plan counts
  make_maps(scene, [&](std::size_t k, double done) {
    if (options.progress)
      options.progress(fmt::format("map of obstacles[{}] ({}): {:.0f} %", k,
                                   scene.obstacles[k].surface_file()->path, 100 * done));
  });
  require_free_starts(scene);
  const auto own = std::make_shared<const Scene>(scene);  // points outlive `start`
  const auto all = std::make_shared<StartPoints>(*own, start.loaded.folder);
  StartPoints& points = *all;
  const std::int64_t particles = count_particles(points);
  if (options.when_read) options.when_read();
  const auto plan = [&](StartNeighbors neighbors) {
    start.plan = make_plan(scene, particles, std::move(neighbors));
    if (options.fits) refuse_if_too_large(scene, start.plan, available);
  };
  if (options.fits) plan({});  // before particles are examined
  plan(start_neighbors(points, particles));
  if (options.measured && !scene.compare.empty() && !scene.output)
    bad_input("compare",
              "its readings are those of run.vtkhdf, which the scene does not write; add output: "
              "{every: 0.1}");
  if (options.measured)
    start.comparisons =
        read_comparisons(scene.compare, readings_of(start.plan.columns, has_work(scene)),
                         scene.time.end, start.loaded.folder);
  if (options.warnings) start.warnings = scene_warnings(points, particles);
  if (options.strict && !start.warnings.empty())
    throw Error(ExitCode::difference, "--strict: " + warning_lines(start.warnings));
  if (options.particles && !world()) start.particles = emit_particles(std::move(points));
  if (options.particles && world()) {
    start.particles = emit_in_pieces(points, kStartRows, nullptr);
    start.pieces = [own, all](const TakeParticles& take) {
      emit_in_pieces(*all, kStartRows, take);
    };
  }
  start.notes = notes_of(start.particles, scene);
  return start;
}

Start prepare(const Scene& scene, const std::string& folder, const PrepareOptions& options) {
  LoadedScene loaded;
  loaded.scene = scene;
  loaded.folder = folder;
  return prepare(std::move(loaded), options);
}

std::unique_ptr<Solver> new_solver(Start& start, const Scene& scene, const Plan& plan) {
  return world() ? make_ranked_solver(scene, plan, start.pieces)
                 : make_solver(scene, plan, std::move(start.particles));
}

std::unique_ptr<Solver> solver_of(Start& start) {
  settle(start);
  auto solver = new_solver(start, start.scene(), start.plan);
  prestabilize(*solver, start.scene(), start.plan);
  return solver;
}

}  // namespace pbf::run_module
