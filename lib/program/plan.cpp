#include "lib/program/plan.h"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>
#include <utility>

#include "kernels/smoothing.h"
#include "lib/base/error.h"
#include "lib/program/axes.h"
#include "lib/program/calibrate.h"
#include "lib/program/free_bodies.h"
#include "lib/program/packed_rows.h"
#include "lib/program/relaxation.h"
#include "lib/program/schedule.h"
#include "lib/program/substep_lists.h"
#include "lib/program/time_levels.h"
#include "lib/program/time_order.h"
#include "lib/program/turns.h"
#include "lib/scene/load.h"
#include "lib/scene/waves.h"

namespace pbf::program_module {
namespace {

/// The edge of cells is h if their number is in proportion to the particles, and larger otherwise:
/// a nearly empty box must not need more memory than its fluid. This also bounds the number of
/// cells.
void plan_grid(Plan& plan, const Scene& scene) {
  plan.axes = internal_axes(scene);
  const Scene s = in_internal_axes(scene, plan.axes);
  double box[3];
  for (std::size_t k = 0; k < 3; ++k) box[k] = (s.domain.max[k] - s.domain.min[k]) / s.h();
  if (s.dimensions == 2) box[1] = 0;  // one layer, even if the slab is thicker than h
  // Images are in one more cell on each side.
  const auto along = [&](int k, double edge) {
    return box[k] + (s.domain.is_periodic(k) ? 2 * edge : 0);
  };
  const auto number = [&](double edge) {
    return (std::floor(2 * along(0, edge) / edge) + 1) / 2 *
           (std::floor(along(1, edge) / edge) + 1) * (std::floor(along(2, edge) / edge) + 1);
  };
  const auto most = double(has_emitters(s) ? plan.most_particles() : plan.particles);
  const double limit = std::min(most + 65536, 2e8);
  plan.cell_edge = 1;
  while (number(plan.cell_edge) > limit) {
    const double over = number(plan.cell_edge) / limit;
    plan.cell_edge *= std::max(1.01, s.dimensions == 2 ? std::sqrt(over) : std::cbrt(over));
  }
  const double edge = plan.cell_edge;
  plan.cells[0] = int(2 * along(0, edge) / edge) + 1;
  for (int k = 1; k < 3; ++k) plan.cells[k] = int(along(k, edge) / edge) + 1;
}

/// Rows for images beyond periodic faces (kernels/pass_images.h): for fluid of twice the density at
/// rest, and at most one for each set of faces that a particle may be near.
std::int64_t image_rows(const Scene& s, std::int64_t particles) {
  double inner = 1, outer = 1;
  std::int64_t sets = 1;
  for (int a = 0; a < 3; ++a) {
    if (s.dimensions == 2 && a == 1) continue;
    const double length = (s.domain.max[a] - s.domain.min[a]) / s.h();
    inner *= length;
    outer *= length + (s.domain.is_periodic(a) ? 2.1 : 0);
    if (s.domain.is_periodic(a)) sets *= 2;
  }
  if (sets > 1 && changes_rows(s))
    throw Error(ExitCode::bad_input, "the number of particles of scene " + s.name +
                                         " changes, and it has periodic axes (domain.periodic), "
                                         "whose images are of a fixed number of particles");
  const double at_rest = (outer - inner) * std::pow(s.fluid.smoothing_ratio, s.dimensions);
  return std::int64_t(std::min(2 * at_rest + 256, double(particles) * double(sets - 1)));
}

/// Rows of particles: of all that may be at a time. Throws Error(bad_input) for a capacity that the
/// start exceeds, and for more ids than there are.
std::int64_t most_rows(const Scene& s, const Plan& plan) {
  if (!has_emitters(s)) return std::max(plan.particles, s.capacity);
  const std::int64_t all = most_particles_of(s, plan.emission);
  if (all >= kImage)
    throw Error(ExitCode::bad_input,
                fmt::format("the emitters of scene {} bring {} particles, at most {} are possible; "
                            "raise fluid.spacing, or lower speed or time.end",
                            s.name, all, kImage - 1));
  if (s.capacity > 0 && s.capacity < plan.particles)
    throw Error(ExitCode::bad_input,
                fmt::format("capacity: is {}, below the {} particles at the start; raise it",
                            s.capacity, plan.particles));
  return s.capacity > 0 ? std::min(s.capacity, all) : all;
}

/// The steps of a Richardson iteration with the Chebyshev polynomial on [a, b] as error polynomial:
/// 2/((b + a) + (b - a) cos((2 m - 1) pi/2K)), m = 1..K (Young 1954, On Richardson's method). Large
/// and small steps alternate, because a large step alone may amplify errors; the smallest comes
/// late, because it smooths. Choice of a and b: kernels/README.md, "Step length".
std::vector<double> chebyshev_factors(int iterations) {
  constexpr double a = 0.5, b = 1.5;
  std::vector<double> rising, out;
  for (int m = 1; m <= iterations; ++m)
    rising.push_back(2 / ((b + a) + (b - a) * std::cos((2 * m - 1) * kPi / (2 * iterations))));
  int low = iterations / 2 - 1, high = iterations - 1;
  while (int(out.size()) < iterations) {
    if (high >= iterations / 2) out.push_back(rising[std::size_t(high--)]);
    if (low >= 0) out.push_back(rising[std::size_t(low--)]);
  }
  return out;
}

void plan_left_out(Plan& plan, const Scene& s) {
  auto out = [&](bool absent, const char* what, const std::string& why) {
    if (absent) plan.left_out.push_back({what, why});
  };
  const std::vector<LeftOut>& features = plan.program.left_out;
  out(s.dimensions == 2,
      "the third dimension: 18 of 27 cells around a particle, y in the pair loops",
      "dimensions is 2");
  plan.left_out.insert(plan.left_out.end(), features.begin(), features.end());
  out(s.solver.kernels == KernelMode::consistent, "the second smoothing function (Poly6)",
      "solver.kernels is consistent");
  out(s.solver.boundary == BoundaryMode::clamp, "wall density", "solver.boundary is clamp");
  out(s.obstacles.empty(), "obstacles", "no key obstacles");
  out(s.domain.open.size() == 6, "walls: their density and the clamp", "domain.open names all six");
  out(s.domain.periodic.empty(), "images beyond periodic faces", "no key domain.periodic");
  out(plan.repeats == 0, "iterations until a tolerance is met", "solver.tolerance is 0");
  out(!plan.program.has_pairs(),
      "sort and neighbor lists, but for a measure and for densities of a frame",
      "solver.iterations is 0; no keys viscosity, vorticity");
  out(!s.time.adaptive, "halving of the step", "no key time.adaptive");
  out(!s.guard, "the guard and its copy of the state", "guard is off");
  out(s.solver.speed_limit == 0, "limit on the speed", "solver.speed_limit is 0");
  out(!s.output, "run.vtkhdf, its writer thread and its downloads", "no key output");
  out(!s.checkpoint, "checkpoints, but where the run is stopped", "no key checkpoint");
  out(!s.render, "pictures, the GL library and its thread", "no key render");
  out(!s.output && !s.render, "copies of the particles in SI units", "no keys output, render");
  out(s.backend != Backend::cuda, "CUDA context and driver",
      std::string("backend is ") + word(s.backend));
  out(about(s.backend).on_device && !s.output && !s.render, "staging of downloads on the device",
      "no keys output, render");
  out(!s.solver.reproducible && !about(s.backend).exact, "the host's arithmetic on the device",
      "solver.reproducible is false");
}

constexpr double kOtherDatasets = 48;  // of run.vtkhdf, without the columns of log and gauges

/// Stages of a run with times in the log.
double stages_of(const Plan& plan, const Scene& s) {
  std::set<std::string_view> names{"init", "measure"};
  for (const PassCount& c : count_passes(plan.program, plan.program.update))
    names.insert(c.pass->stage);
  if (s.guard) names.insert("guard");
  if (s.output || s.render) names.insert("download");
  if (s.output) names.insert("write");
  if (s.render) names.insert("render");
  return double(names.size());
}

/// Columns of the log: time, dt, update and iterations; diagnostics; stages; loads on walls and
/// obstacles; poses of moving ones.
double log_columns(const Plan& plan, const Scene& s) {
  double columns = 4 + kDiagnosticColumns + stages_of(plan, s);
  for (const ReadingColumn& c : plan.columns)
    if (c.series != Series::gauges) columns += c.components;
  return columns;
}

double gauge_columns(const Plan& plan) {
  double columns = 0;
  for (const ReadingColumn& c : plan.columns)
    if (c.series == Series::gauges) columns += c.components;
  return columns > 0 ? 2 + columns : 0;
}

/// Bytes of a table of run.vtkhdf with columns of 8 bytes per row, in whole chunks of 1024 rows.
/// The first chunk of a column and its index take 23 kB (measured in 10 scenes).
double table_bytes(double columns, double rows) {
  return columns * (2.3e4 + std::floor(rows / 1024) * 1024 * 8);
}

/// Bytes of the dataset of free bodies: chunks of 64 frames, and its index (measured).
double body_bytes(const Scene& s, double frames) {
  if (!has_free_bodies(s)) return 0;
  const double row = 8.0 * BodyMotion::kNumbers * double(free_bodies(s));
  return 1.9e4 + std::ceil(frames / 64) * 64 * row;
}

/// Of a frame, if no sink takes any.
double mean_particles(const Plan& plan, const Scene& s) {
  if (!has_emitters(s)) return double(plan.most_particles());
  constexpr int kTimes = 256;
  double sum = 0;
  for (int k = 0; k <= kTimes; ++k)
    sum += std::min(double(plan.emission.particles(s.time.end * k / kTimes)),
                    double(plan.most_particles()));
  return sum / (kTimes + 1);
}

void plan_files(Plan& plan, const Scene& s) {
  const auto n = double(plan.most_particles()), mean = mean_particles(plan, s);
  const auto add = [&](const std::string& name, double number, double bytes,
                       const std::string& note = {}) {
    plan.files.push_back({name, std::int64_t(number), std::int64_t(bytes), note});
  };
  add("scene.resolved.yaml", 1, double(resolved_yaml(s).size()));
  add("log.txt", 1, 2500);
  add("DONE", 1, 30);
  for (const Obstacle& o : s.obstacles)
    if (o.motion && makes_waves(*o.motion))
      add(wave_file_name(o.name), 1,
          double(o.motion->table.time.size()) * (26 + 13 * double(s.gauges.size())));
  const Schedule schedule = make_schedule(s);
  const std::int64_t all = schedule.updates;
  if (s.output) {
    const double scalar = about(s.output->precision).bytes;
    double row = 3 * scalar;  // position
    for (const auto& f : s.output->fields) row += (f == "velocity" ? 3 : 1) * scalar;
    const double frames = double(schedule.frames_until(all));
    if (changes_rows(s)) row += 4;  // ids of each frame
    // Ids and vertex numbers are stored once. Large chunks of a frame fill whole pages. gzip makes
    // the data 1.45 times smaller (measured).
    const double bytes =
        (frames * row * mean + 12 * n) / (s.output->compression == Compression::gzip ? 1.45 : 1) +
        frames * std::min(5 * n, 9e3) + table_bytes(kOtherDatasets, 0) +
        table_bytes(log_columns(plan, s), double(schedule.measures_until(all))) +
        table_bytes(gauge_columns(plan), double(schedule.gauges_until(all))) +
        body_bytes(s, frames);
    add("run.vtkhdf", 1, bytes, std::to_string(std::int64_t(frames)) + " frames");
  }
  if (s.render) {
    const auto pictures = double(schedule.pictures_until(all));
    const double pixels = double(s.render->size[0]) * s.render->size[1];
    add("frames/frame_*.png", pictures, pictures * 0.43 * pixels, "0.43 bytes a pixel, 0.3 to 0.5");
  }
  if (s.checkpoint)
    add("checkpoint.h5, checkpoint_prev.h5", 2,
        2 * ((is_second_order(s) ? 9 : 6) * about(s.precision).bytes + 4) * n + 2e4);
}

}  // namespace

double run_file_datasets(const Plan& plan, const Scene& scene) {
  return kOtherDatasets + log_columns(plan, scene) + gauge_columns(plan) + has_free_bodies(scene);
}

UpdateShape Plan::shape() const { return {substeps, lists_per_update, repeats, packed}; }

Plan make_plan(const Scene& s, std::int64_t particles, StartNeighbors start) {
  Plan plan;
  plan.particles = particles;
  plan.images = image_rows(s, particles);
  plan.emission = plan_emission(s, particles - particles_in_pipes(s));
  plan.capacity = most_rows(s, plan) + plan.images;
  plan.start = std::move(start);
  plan.mass = s.particle_mass();
  plan.dissipation_unit = 1 / (s.time.step * s.time.step);
  if (s.fluid.mass) {
    const double h = s.h(), third = s.dimensions == 2 ? s.domain.max[1] - s.domain.min[1] : h;
    plan.vol = plan.mass / (s.fluid.rest_density * h * h * third);
    plan.wall_scale = 1;
  } else {
    const Calibration c = calibrate(s.solver.kernels, s.fluid.smoothing_ratio, s.dimensions);
    plan.vol = c.vol;
    plan.wall_scale = c.wall_scale;
  }
  plan.wall_range = wall_range(s);
  plan.sor = s.solver.sor.value_or(default_sor(s));
  if (s.solver.method == SolverMethod::chebyshev)
    plan.sor_factors = chebyshev_factors(s.solver.iterations);
  plan.hyperviscosity = hyperviscosity_of(s);
  plan.viscosity = viscous_sweeps(s);
  plan.substeps = s.solver.substeps;
  plan.lists_per_update = lists_per_update(s);
  plan.finest_level = finest_level(s);
  if (s.solver.tolerance > 0 && s.solver.iterations > 0) {
    plan.tolerance = s.solver.tolerance;
    plan.repeats = s.solver.max_iterations / s.solver.iterations - 1;
  }
  plan.packed = packs_rows(s, plan);
  plan.program = make_program(s, plan.shape());
  plan_grid(plan, s);
  plan.solids = solids_of(s, plan.axes);
  plan.casings = casings_and_bores(s, plan.axes);
  plan.gauges = plan_gauges(s, plan);
  plan.columns = reading_columns(s, plan);
  if (has_levels(s))
    plan.levels = plan_levels(in_internal_axes(s, plan.axes), plan.cell_edge, plan.vol,
                              fluid_layers(s, plan.start.of_files));
  plan.turns = takes_turns(s, plan);
  plan.memory = plan_memory(s, plan);
  plan_left_out(plan, s);
  plan_files(plan, s);
  return plan;
}

}  // namespace pbf::program_module
