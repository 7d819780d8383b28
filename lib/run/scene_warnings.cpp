// Warnings that a scene gives before it is run.
#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/relative_motion.h"
#include "lib/base/text.h"
#include "lib/program/motion.h"
#include "lib/program/relaxation.h"
#include "lib/program/time_levels.h"
#include "lib/run/motion_warnings.h"
#include "lib/run/start_neighbors.h"
#include "lib/run/surface_warnings.h"
#include "lib/run/warnings.h"
#include "lib/run/wave_files.h"
#include "lib/scene/auto_step.h"
#include "lib/scene/body_box.h"
#include "lib/scene/periodic.h"
#include "lib/scene/surface.h"

namespace pbf::run_module {
namespace {

/// Ratio of a step to that of time.step: auto above which a warning is given.
constexpr double kFarAbove = 10;

/// The longest step that time.adaptive allows for gravity, s; infinite without a limit.
double adaptive_step(const Scene& s) {
  return s.time.adaptive ? longest_step(s, 0, length(s.gravity))
                         : std::numeric_limits<double>::infinity();
}

/// The longest substep of the scene, s.
double longest_step(const Scene& s) {
  return std::min(s.time.step, adaptive_step(s)) / s.solver.substeps;
}

int most_iterations(const Scene& s) {
  return s.solver.tolerance > 0 ? std::max(s.solver.iterations, s.solver.max_iterations)
                                : s.solver.iterations;
}

bool closed_box(const Scene& s) { return s.domain.open.empty(); }

/// Volume of the fluid, m^3.
double volume(const Scene& s, double particles) {
  return particles * s.particle_mass() / s.fluid.rest_density;
}

/// For fluid that is too shallow for its compression at rest to reveal a long step.
std::string coarse_step_text(const Scene& s) {
  // Compression is proportional to dt^2 / iterations; the rule assumes the default number.
  const double far = kFarAbove * std::sqrt(std::max(1.0, most_iterations(s) / 4.0));
  const double safe = step_rule(s).gravity, times = longest_step(s) / safe;
  if (s.time.adaptive || !(times > far)) return "";
  return fmt::format(
      "time.step {:g} makes steps of {:.2g} times 0.03 sqrt(h/g) ({:.2g} s), which is safe: what "
      "falls moves far before it is stopped; give {:.2g} or less, or auto",
      s.time.step, times, safe, s.time.step * far / times);
}

std::string step_text(const Scene& s, std::int64_t particles) {
  const double c = compression_at_rest(s, particles);
  if (c <= kNoLiquid) return c > 0 ? coarse_step_text(s) : "";
  const double times = std::sqrt(c / kNoLiquid);
  const bool by_force = adaptive_step(s) < s.time.step;
  const double value = by_force ? s.time.adaptive->force : s.time.step;
  const std::string key = by_force ? "time.adaptive.force" : "time.step";
  // The formula holds up to this compression; beyond, the real one is larger.
  std::string text = fmt::format(
      "{} {:g} makes steps {:.2g} times the longest that is safe here: at rest the fluid would "
      "have a mean compression of {}; give {:.2g} or less",
      key, value, times, c > 0.2 ? "more than 20 %" : fmt::format("about {:.2g} %", 100 * c),
      value / times);
  if (s.solver.tolerance == 0)
    text += fmt::format(", or solver.iterations {:.0f}",
                        std::ceil(s.solver.iterations * times * times));
  return text;
}

std::string passing_text(const Scene& s) {
  if (s.time.adaptive) return "";  // it adapts to speeds
  // Two velocities differ by at most the sum of their deviations from the mean. Sorted by
  // deviation, only a few pairs need to be examined.
  Double3 mean{};
  for (const Body& b : s.bodies) mean = mean + (1.0 / double(s.bodies.size())) * b.velocity;
  std::vector<std::pair<double, std::size_t>> off;  // deviation from the mean, and body
  for (std::size_t i = 0; i < s.bodies.size(); ++i)
    off.push_back({length(s.bodies[i].velocity - mean), i});
  std::ranges::stable_sort(off, [](const auto& a, const auto& b) { return a.first > b.first; });
  double fastest = 0;
  std::size_t first = 0, second = 0;
  for (std::size_t i = 1; i < off.size() && off[i].first + off[0].first > fastest; ++i)
    for (std::size_t j = 0; j < i && off[i].first + off[j].first > fastest; ++j)
      if (const double v =
              length(s.bodies[off[i].second].velocity - s.bodies[off[j].second].velocity);
          v > fastest) {
        fastest = v;
        first = std::min(off[i].second, off[j].second);
        second = std::max(off[i].second, off[j].second);
      }
  const double way = fastest * longest_step(s) / s.h();
  if (way <= kResolvedWay) return "";
  return fmt::format(
      "bodies[{}] and bodies[{}] move past each other by {:.3g} h in a step, more than {:g} h: "
      "fluid may pass through fluid; give time.step {:.2g} or less, or time.adaptive",
      first, second, way, kResolvedWay, s.time.step * kResolvedWay / way);
}

std::string motion_text(const Scene& s) {
  if (s.time.adaptive) return "";  // it adapts to motions
  const double way = fastest_obstacle(s, 0, s.time.end) * longest_step(s) / s.h();
  if (way <= kResolvedWay) return "";
  return fmt::format(
      "an obstacle moves by {:.3g} h in a step, more than {:g} h: what it pushes may pass through "
      "fluid; give time.step {:.2g} or less, or time.adaptive",
      way, kResolvedWay, s.time.step * kResolvedWay / way);
}

/// Whether it lies outside the domain, farther than walls and obstacles act.
bool out_of_reach(const Scene& s, const Solid<double>& o) {
  if (!is_bounded(o)) {
    const Double3 size = extents_of(s).high;
    for (int corner = 0; corner < 8; ++corner)
      if (distance<3>(o, {corner & 1 ? size[0] : 0, corner & 2 ? size[1] : 0,
                          corner & 4 ? size[2] : 0}) < 1)
        return false;
    return true;
  }
  return !extents_of(s).meets(extents_of(s, o), 1);
}

std::string obstacles_text(const Scene& s, const std::vector<Track>& tracks) {
  if (!closed_box(s)) return "";  // fluid can leave the domain
  for (std::size_t k = 0; k < s.obstacles.size(); ++k) {
    if (std::ranges::all_of(tracks[k].solid, [&](const auto& o) { return out_of_reach(s, o); }))
      return fmt::format("{} {}: no fluid will meet it; move it or remove it", named(s, k),
                         s.obstacles[k].motion ? "stays outside the domain all the time"
                                               : "lies outside the domain");
  }
  return "";
}

std::string overlap_text(const StartPoints& points) {
  const Overlap o = find_overlap(points);
  const char* least = o.more ? "at least " : "";
  std::string text;
  if (o.inside + o.pairs > 0)
    text = fmt::format(
        "bodies[{}] and bodies[{}] overlap: {} particles start inside another body, {}{} pairs of "
        "two bodies are closer than half of fluid.spacing; ",
        o.first, o.second, o.inside, least, o.pairs);
  else if (o.within > 0 && 100 * o.within > o.of_files)  // any flow has some close pairs
    text = fmt::format(
        "bodies[{}]: {}{} pairs of the file's particles are closer than half of fluid.spacing; ",
        o.file, least, o.within);
  if (text.empty()) return "";
  return text + (points.scene().solver.prestabilize
                     ? "steps without time part them, so the fluid takes more room than the bodies "
                       "do; move the bodies apart"
                     : "they burst; move the bodies apart, or leave solver.prestabilize on");
}

std::string over_dense_text(const Scene& s, std::int64_t particles) {
  constexpr double kTooMuch = 1.02;
  for (std::size_t b = 0; b < s.bodies.size(); ++b) {
    const Body& body = s.bodies[b];
    if (body.shape != Shape::random_box) continue;
    Double3 room = body.max - body.min;
    if (s.plane()) room[1] = s.domain.max[1] - s.domain.min[1];
    const double fill = volume(s, double(body.count)) / (room[0] * room[1] * room[2]);
    if (fill > kTooMuch)
      return fmt::format(
          "bodies[{}] holds {:.3g} times the fluid that its box has room for; give count {:.0f} or "
          "less, or a larger box",
          b, fill, std::floor(body.count / fill * (1 + 1e-9)));
  }
  const Double3 box = s.domain.max - s.domain.min;
  const double fill = volume(s, double(particles)) / (box[0] * box[1] * box[2]);
  if (!closed_box(s) || fill <= kTooMuch) return "";
  return fmt::format(
      "the bodies hold {:.3g} times the fluid that the closed domain has room for; give fewer or "
      "smaller bodies",
      fill);
}

/// For lattices that reach from one periodic face to the other and do not fit between them.
std::string seam_text(const Scene& s) {
  const double d = s.fluid.spacing;
  for (const int axis : periodic_axes(s)) {
    const auto a = std::size_t(axis);
    const double low = s.domain.min[a], high = s.domain.max[a], cells = (high - low) / d;
    const double whole = std::floor(cells + 1e-6), nearest = std::round(cells);
    if (std::fabs(cells - nearest) < 1e-6) continue;
    for (std::size_t b = 0; b < s.bodies.size(); ++b) {
      if (s.bodies[b].shape != Shape::block) continue;
      const BodyBox box = body_box(s.bodies[b]);
      if (box.low[a] > low + 0.5 * d || box.high[a] < high - d) continue;
      return fmt::format(
          "bodies[{}]: the domain is {:g} fluid.spacing long along the periodic axis {}, so the "
          "lattice leaves a seam of {:.2g} spacings at its faces; give a length of {:g} m ({:g} "
          "spacings), or fluid.spacing {:.10g}",
          b, cells, "xyz"[a], cells - whole, nearest * d, nearest, (high - low) / nearest);
    }
  }
  return "";
}

std::string output_text(const Scene& s) {
  const double run = s.time.end * (1 + 1e-9);
  std::vector<std::string> texts;
  const auto add = [&](const char* key, double every, const std::string& what) {
    if (every > run)
      texts.push_back(fmt::format("{} {:g} s is longer than the run (time.end {:g} s): {}", key,
                                  every, s.time.end, what));
  };
  if (s.output)
    add("output.every", s.output->every, "run.vtkhdf gets the first and the last frame");
  if (s.render) add("render.every", s.render->every, "the start alone is drawn");
  if (double(s.measure_every) * s.time.step > run)
    add("measure_every", s.measure_every * s.time.step,
        "the guard looks at the start and the end alone");
  if (s.summary_from > 0 && s.summary_from >= s.time.end)
    texts.push_back(fmt::format(
        "summary_from {:g} s is not before the end of the run (time.end {:g} s): the summary of a "
        "batch has nothing of gauges and loads",
        s.summary_from, s.time.end));
  if (!s.output && !s.gauges.empty())
    texts.push_back(
        "gauges are written to run.vtkhdf, and there is no key output: nothing is kept of them; "
        "give output");
  return joined(texts, "; ");
}

}  // namespace

double compression_at_rest(const Scene& s, std::int64_t particles) {
  const double g = length(s.gravity), h = s.h();
  const int iterations = most_iterations(s);
  if (g == 0 || iterations == 0) return 0;
  const int down = level_axis(s);  // along which the fluid rests on a wall
  if (s.domain.is_periodic(down)) return 0;
  // Without walls below and at the sides the fluid does not stay.
  const std::string ceiling =
      std::string(1, char('x' + down)) + (s.gravity[down] < 0 ? "_max" : "_min");
  for (const std::string& face : s.domain.open)
    if (face != ceiling) return 0;
  const Double3 box = s.domain.max - s.domain.min;
  const double area = box[(down + 1) % 3] * box[(down + 2) % 3];
  const double depth = std::min(volume(s, double(particles)) / area, box[down]);
  const double dt = longest_step(s);
  return 2.0 / 3 * g * dt * dt / h * (depth / h) / iterations;
}

std::vector<Warning> scene_warnings(const StartPoints& points, std::int64_t particles) {
  const Scene& scene = points.scene();
  const std::vector<Track> tracks = tracks_of(scene);
  std::vector<Warning> list{{"units", units_text(scene)},
                            {"step", step_text(scene, particles)},
                            {"speed", passing_text(scene)},
                            {"motion", motion_text(scene)},
                            {"table", tables_text(scene)},
                            {"obstacles", obstacles_text(scene, tracks)},
                            {"thin", thin_text(scene)},
                            {"wall", walls_text(scene, tracks)},
                            {"collision", collisions_text(scene, tracks)},
                            {"overlap", overlap_text(points)},
                            {"over-dense", over_dense_text(scene, particles)},
                            {"seam", seam_text(scene)},
                            {"relaxation", sor_text(scene)},
                            {"output", output_text(scene)}};
  for (Warning& w : wave_warnings(scene)) list.push_back(std::move(w));
  std::erase_if(list, [](const Warning& w) { return w.text.empty(); });
  return list;
}

std::string warning_lines(const std::vector<Warning>& warnings) {
  std::string text;
  for (const Warning& w : warnings) text += (text.empty() ? "" : "\npbf: error: ") + w.text;
  return text;
}

}  // namespace pbf::run_module
