// Rules between the keys of a scene. Keys are named by their members; their paths come from the
// table.
#include <fmt/core.h>
#include <algorithm>
#include <cmath>

#include "lib/base/plain_text.h"
#include "lib/base/text.h"
#include "lib/scene/body_box.h"
#include "lib/scene/lattice.h"
#include "lib/scene/rounding.h"
#include "lib/scene/scene_rules.h"
#include "lib/scene/surface.h"
#include "lib/scene/vector3.h"

namespace pbf::scene_module {
namespace {

class Checker : public SceneRules {
 public:
  using SceneRules::SceneRules;

  void run() {
    const bool domain = good(s_.domain.min, s_.domain.max) && above(s_.domain.min, s_.domain.max);
    if (domain) check_domain();
    if (flat()) check_plane(domain);
    check_name();
    check_smoothing_ratio();
    if (good(s_.bodies)) check_bodies(domain);
    check_obstacles(p_, problems_);
    check_motions(p_, problems_);
    check_waves(p_, problems_);
    check_free(p_, problems_);
    check_gauges(p_, problems_);
    check_emitters(p_, problems_);
    check_periodic(p_, problems_);
    check_viscosity(p_, problems_);
    check_sponges(p_, problems_);
    check_compare(p_, problems_);
    check_summary(p_, problems_);
    check_time();
    check_solver();
    if (domain) check_rounding();
    check_render();
  }

 private:
  /// The name becomes a folder of out/, also for a scene from somebody else's run file.
  void check_name() {
    if (good(s_.name) && !is_file_name(s_.name))
      add(s_.name,
          "is \"{}\", and runs are kept in out/<name>; give a word without slashes, not . or ..",
          one_line(s_.name, 60));
  }

  /// Refuses a scene in two dimensions that has anything along y.
  void check_plane(bool domain) {
    const double thick = s_.domain.max[1] - s_.domain.min[1];
    if (domain && good(s_.fluid.spacing, s_.fluid.smoothing_ratio) && thick > s_.h() * (1 + 1e-9))
      add(s_.domain.max,
          "y makes a slab {} m thick, with dimensions: 2 it may be at most the smoothing length {} "
          "m (one cell); give y = {} for one spacing, or dimensions: 3",
          thick, s_.h(), s_.domain.min[1] + s_.fluid.spacing);
    if (good(s_.domain.open))
      for (const std::string& face : s_.domain.open)
        if (face[0] == 'y')
          add(s_.domain.open, "{}: with dimensions: 2 there is no wall along y; remove it", face);
    constexpr const char* kInSpace = ", or dimensions: 3";
    must_lie_flat(s_.gravity, s_.gravity, kInSpace);
    if (s_.settle && s_.settle->gravity)
      must_lie_flat(s_.settle->gravity, *s_.settle->gravity, kInSpace);
    for (const Body& body : s_.bodies) must_lie_flat(body.velocity, body.velocity, kInSpace);
  }

  void check_smoothing_ratio() {
    if (!good(s_.dimensions, s_.fluid.smoothing_ratio, s_.fluid.mass) || s_.fluid.mass) return;
    const double least = least_smoothing_ratio(s_.dimensions);
    if (s_.fluid.smoothing_ratio < least)
      add(s_.fluid.smoothing_ratio,
          "is {}: with so few neighbors the density cannot tell the rest lattice from a closer "
          "packing, and a pool loses volume; give at least {}{}, 2 is the default, or set "
          "fluid.mass",
          s_.fluid.smoothing_ratio, least, flat() ? "" : " (1.5 with dimensions: 2)");
  }

  void check_solver() {
    const SolverSettings& v = s_.solver;
    if (good(s_.time.order, v.kernels) && s_.time.order == TimeOrder::second &&
        v.kernels == KernelMode::paper)
      add(s_.time.order,
          "the paper's method (solver.kernels: paper) is of first order; give 1, or "
          "solver.kernels: consistent");
    if (good(v.levels) && v.levels == LevelsMode::on && has_pressure_on_wall(s_))
      add(v.levels,
          "pressure gauges on walls do not see what the levels push; give off or auto, or put them "
          "on obstacles");
    if (!good(v.tolerance, v.iterations, v.max_iterations) || v.tolerance == 0) return;
    if (v.iterations == 0)
      add(v.tolerance, "nothing can meet it with solver.iterations 0; give at least 1");
    if (v.max_iterations < v.iterations)
      add_below(v.max_iterations, v.iterations, ", which make one round; raise it");
  }

  void check_domain() {
    double thinnest = s_.domain.max[0] - s_.domain.min[0];
    for (int a = flat() ? 2 : 1; a < 3; ++a)
      thinnest = std::min(thinnest, s_.domain.max[a] - s_.domain.min[a]);
    if (good(s_.solver.wall_margin) && !(2 * s_.solver.wall_margin < thinnest))
      add(s_.solver.wall_margin,
          "is {}, but must be below half the thinnest side of the domain ({} m); lower it",
          s_.solver.wall_margin, thinnest / 2);
  }

  /// Checks that the precision resolves the positions of particles and their moves in a step.
  /// Nothing else limits the size of a domain: the cells of the grid grow with it (lib/program).
  void check_rounding() {
    if (!good(s_.fluid.spacing, s_.fluid.smoothing_ratio, s_.precision, s_.dimensions, s_.gravity,
              s_.bodies, s_.time.step, s_.time.end, s_.solver.substeps))
      return;
    const Rounding r = rounding_of(s_);
    const bool single = s_.precision == Precision::single;
    const std::string precision = word(s_.precision);
    const std::string remedy = single ? "give precision: double, or " : "";
    if (r.spacing > kLargestSpacing)
      return add(s_.domain.max,
                 "the box is so long that positions in {} are {} h apart at its far end (at most "
                 "{}): densities would be off; {}make the domain smaller or raise fluid.spacing",
                 precision, r.spacing, kLargestSpacing, remedy);
    const bool lost = r.lost > kLeastLoss;
    if (!lost && r.slow <= kLargestLoss) return;
    const std::string what =
        lost ? fmt::format(
                   "in {} up to {:.3g} h of a motion over {:.3g} h would be rounded away: "
                   "positions are {} h apart, steps shorter than half of that are none",
                   precision, r.lost, r.distance, to_text(r.spacing))
             : fmt::format(
                   "makes so many steps in a fall that rounding in {} would take {:.3g} % of its "
                   "velocity",
                   precision, 100 * r.slow);
    add(s_.time.step, "{}; {}raise time.step{}", what, remedy,
        s_.solver.substeps > 1 ? " or lower solver.substeps" : "");
  }

  void check_bodies(bool domain) {
    double sum = 0;
    bool known = good(s_.fluid.spacing);
    for (std::size_t b = 0; b < s_.bodies.size(); ++b) {
      const Body& body = s_.bodies[b];
      const std::string key = name(s_.bodies) + "[" + std::to_string(b) + "]";
      if (body.shape == Shape::mesh && good(body.turn_axis) &&
          dot(body.turn_axis, body.turn_axis) == 0)
        add(body.turn_axis, "has no direction; give one, [0, 0, 1] say");
      if (body.from_file() || !check_place(body, key, domain)) {
        known = known && body.from_file();  // files are opened when particles are made
        continue;
      }
      if (!good(s_.fluid.spacing, body.count)) continue;
      const double n = lattice_count(body, s_.fluid.spacing, plane());
      if (n < 1)
        add_at(key,
               "makes no particle: it is thinner than fluid.spacing ({} m); enlarge it or lower "
               "fluid.spacing",
               s_.fluid.spacing);
      sum += n;
    }
    if (known && sum > kMaxParticles) add(s_.bodies, "{}", too_many_text(sum));
  }

  std::optional<double> plane() const {
    return good(s_.domain.min, s_.domain.max, s_.dimensions) ? s_.plane() : std::nullopt;
  }

  bool check_axis(const Body& body) {
    if (!good(body.from, body.to, body.radius)) return false;
    if (body.from == body.to)
      add(body.to, "is where the axis begins ({}); give the other end", name(body.from));
    else if (flat() && (body.from[0] != body.to[0] || body.from[2] != body.to[2]))
      add(body.to,
          "with dimensions: 2 a cylinder stands on the x-z plane, which makes a disc of it; give "
          "both ends the same x and z, or a block");
    else
      return true;
    return false;
  }

  /// Checks that a body is well formed and inside the domain and, in 2-D, that the plane cuts it.
  bool check_place(const Body& body, const std::string& key, bool domain) {
    if (!good(body.shape)) return false;
    const bool round = body.shape == Shape::sphere || body.shape == Shape::cylinder;
    if (body.shape == Shape::sphere && !good(body.center, body.radius)) return false;
    if (body.shape == Shape::cylinder && !check_axis(body)) return false;
    if (!round && (!good(body.min, body.max) || !above(body.min, body.max))) return false;
    const auto [low, high] = body_box(body);
    bool inside = true;
    const std::optional<double> y = domain ? plane() : std::nullopt;
    if (y && !(low[1] <= *y && *y <= high[1])) {
      inside = false;
      add_at(key,
             "its y goes from {} to {}, which leaves out the plane of the particles, y = {} "
             "(dimensions: 2, the middle of the domain); move the body there",
             low[1], high[1], *y);
    }
    for (int a = 0; a < 3 && domain; a += y ? 2 : 1) {
      const double min = s_.domain.min[a], max = s_.domain.max[a], slack = 1e-9 * (max - min);
      const bool below = low[a] < min - slack;
      if (!below && high[a] <= max + slack) continue;
      inside = false;
      add_at(round ? key : name(below ? body.min : body.max),
             "reaches {0} = {1}, outside the domain ({0} from {2} to {3} m); move the body or "
             "enlarge the domain",
             kAxes[a], below ? low[a] : high[a], min, max);
    }
    return inside;
  }

  void check_time() {
    const Time& time = s_.time;
    if (!good(time.step)) return;
    if (good(time.end)) {
      if (time.end < time.step)
        add_below(time.end, time.step, ": no update would be done; raise it");
      else if (time.end / time.step > 2147483647.0)
        add(time.end,
            "makes {} updates, at most 2147483647 are possible; raise time.step or lower time.end",
            count_text(time.end / time.step));
    }
    if (time.adaptive && time.adaptive->step_min && good(time.adaptive->step_min)) {
      const double floor = *time.adaptive->step_min;
      if (floor > time.step)
        add(time.adaptive->step_min, "is {}, above time.step ({} s); lower it", floor, time.step);
      else if (std::ldexp(floor, 20) < time.step)
        add(time.adaptive->step_min, "is {}, less than time.step/1048576 ({} s); raise it", floor,
            std::ldexp(time.step, -20));
    }
    if (s_.settle && good(s_.settle->duration)) {
      if (s_.settle->duration < time.step)
        add_below(s_.settle->duration, time.step, "; raise it, 1 to 2 s are useful");
      if (good(s_.gravity, s_.settle->gravity) &&
          length(s_.settle->gravity.value_or(s_.gravity)) == 0)
        add(s_.settle->duration,
            "without gravity nothing settles; give settle.gravity, or remove settle");
    }
    const auto must_last_a_step = [&](const auto& member, double every) {
      if (good(member) && every < time.step * (1 - 1e-9))
        add_below(member, every, time.step, "; raise it to at least that");
    };
    if (s_.output) must_last_a_step(s_.output->every, s_.output->every);
    if (s_.output && s_.output->gauges_every)
      must_last_a_step(s_.output->gauges_every, *s_.output->gauges_every);
    if (s_.render) must_last_a_step(s_.render->every, s_.render->every);
  }

  void check_render() {
    if (!s_.render) return;
    const Render& r = *s_.render;
    if (r.range && good(r.range) && !((*r.range)[0] < (*r.range)[1]))
      add(r.range, "the lower end {} is not below the upper end {}; give [low, high] or auto",
          (*r.range)[0], (*r.range)[1]);
    if (s_.output && good(r.every, s_.output->every) && r.every < s_.output->every * (1 - 1e-9))
      add_below(r.every, s_.output->every,
                ": pictures are made of output frames; raise it or lower output.every");
    const Camera& c = r.camera;
    if (c.position && c.target && good(c.position, c.target) && *c.position == *c.target)
      add(c.target, "is where the camera is; move one of them");
  }
};

}  // namespace

void check_scene(const PlacedScene& placed, Problems& problems) { Checker(placed, problems).run(); }

}  // namespace pbf::scene_module
