// Rules for emitters and sinks.
#include <algorithm>
#include <cmath>

#include "lib/scene/body_box.h"
#include "lib/scene/nozzle.h"
#include "lib/scene/periodic.h"
#include "lib/scene/scene_rules.h"
#include "lib/scene/surface.h"

namespace pbf::scene_module {
namespace {

/// An emitter with places of its casing.
struct Pipe {
  const Emitter& emitter;
  NozzlePlace nozzle;
  std::vector<Double3> places;
};

class EmitterChecker : public SceneRules {
 public:
  using SceneRules::SceneRules;

  void run() {
    const bool any = !s_.emitters.empty() || !s_.sinks.empty();
    if (!any) {
      if (good(s_.capacity) && s_.capacity > 0)
        add(s_.capacity,
            "is given in a scene without emitters and sinks, whose number of particles does not "
            "change; remove it");
      return;
    }
    constexpr std::array<const char*, 0> none{};
    check_names(s_.emitters, "emitters", "columns of the log", none, "");
    check_names(s_.sinks, "sinks", "columns of the log", none, "");
    check_others();
    std::vector<Pipe> pipes;
    for (const Emitter& e : s_.emitters)
      if (check_keys(e) && has_frame()) check_pipe(e, pipes);
    for (std::size_t k = 0; k < s_.sinks.size(); ++k) check_sink(s_.sinks[k], pipes);
  }

 private:
  /// Whether domain and spacing were read without a problem.
  bool has_frame() const {
    if (!good(s_.domain.min, s_.domain.max, s_.dimensions, s_.fluid.spacing,
              s_.fluid.smoothing_ratio, s_.time.step))
      return false;
    for (std::size_t a = 0; a < 3; ++a)
      if (!(s_.domain.max[a] > s_.domain.min[a])) return false;
    return true;
  }

  /// What does not go with particles that come and go.
  void check_others() {
    if (good(s_.domain.periodic) && !s_.domain.periodic.empty())
      add(s_.domain.periodic,
          "images beyond periodic faces are of a fixed number of particles, and the scene has "
          "emitters or sinks; remove one of them");
    if (!s_.emitters.empty() && good(s_.solver.levels) && s_.solver.levels == LevelsMode::on)
      add(s_.solver.levels,
          "the grids of levels cannot move what waits in emitters, and push the fluid around them "
          "too far; give off or auto");
    for (const Gauge& g : s_.gauges)
      if (good(g.kind, s_.capacity) && std::get_if<gauge_keys::Flow>(&g.kind) && s_.capacity > 0)
        add(s_.capacity,
            "limits the particles at a time, and a flow gauge follows all that there ever are; "
            "remove one of them");
  }

  bool check_keys(const Emitter& e) {
    if (!good(e.shape, e.center, e.normal, e.speed, e.path)) return false;
    const std::size_t before = wrong_;
    if (bool(e.speed) != e.path.empty())
      wrong(), add(e.speed, "{}",
                   e.speed ? "is given beside path; remove one of them"
                           : "missing: give a speed in m/s, or the path of a table");
    if (!(std::isfinite(length(e.normal)) && length(e.normal) > 0))
      wrong(), add(e.normal, "has no direction; give one, [0, 0, -1] say");
    else if (flat() && e.normal[1] != 0)
      wrong(),
          add(e.normal, "its y component is {}, with dimensions: 2 nothing moves along y; give 0",
              e.normal[1]);
    if (e.end && good(e.start, e.end) && !(*e.end > e.start))
      wrong(), add(e.end, "is {}, not after start ({} s); raise it", *e.end, e.start);
    if (e.shape == NozzleShape::rectangle) {
      if (!good(e.size)) return false;
      if (e.size.size() != (flat() ? 1 : 2))
        wrong(), add(e.size, "has {} numbers, expected {}", e.size.size(),
                     flat() ? "the length of a line, [size]" : "two edges, [level, other]");
    } else if (!good(e.radius)) {
      return false;
    }
    const SolverSettings& v = s_.solver;
    if (e.speed && v.speed_limit > 0 &&
        good(v.speed_limit, s_.time.step, s_.fluid.spacing, s_.fluid.smoothing_ratio)) {
      const double most = v.speed_limit * s_.h() / s_.time.step;
      if (*e.speed > most)
        wrong(), add(e.speed,
                     "is {} m/s, above solver.speed_limit ({} m/s at this time.step); "
                     "lower it",
                     *e.speed, rounded(most));
    }
    return wrong_ == before;
  }
  void wrong() { ++wrong_; }

  void check_pipe(const Emitter& e, std::vector<Pipe>& pipes) {
    const double d = s_.fluid.spacing, fastest = fastest_of(e);
    NozzlePlace p = nozzle_place(s_, e);
    if (p.column.empty()) {
      const auto small = [&](const auto& member, double size) {
        add(member,
            "leaves no room for a column of particles {} m wide: give at least {}, or "
            "lower fluid.spacing",
            d, size);
      };
      if (p.disc)
        small(e.radius, 0.5 * d);
      else
        small(e.size, d);
      return;
    }
    if (const double way = fastest * s_.time.step; way > kMostLayersPerUpdate * d)
      return add(e.speed,
                 "makes {} layers of particles in an update, at most {} are possible; give "
                 "time.step {} or less",
                 rounded(way / d), kMostLayersPerUpdate,
                 rounded(kMostLayersPerUpdate * d / fastest));
    std::vector<Double3> places = p.places(d);
    if (!check_domain(e, p)) return;
    for (const Obstacle& o : s_.obstacles)
      if (good_obstacle(o) && good(o.name))
        for (const Double3& x : places)
          if (nearest_place(o, s_, x).distance < -0.1 * d)
            return add_at(entry_of(e),
                          "its casing, {} m long behind its opening and {} m thick, overlaps "
                          "obstacle {} at {}; move one of them",
                          rounded(p.length()), rounded(p.wall), o.name, text(x));
    for (const Pipe& other : pipes) {
      const auto meets = [&](const std::vector<Double3>& all, const NozzlePlace& of) {
        return std::ranges::any_of(all, [&](const Double3& x) { return of.holds(x, -0.1 * d); });
      };
      if (meets(places, other.nozzle) || meets(other.places, p))
        return add_at(entry_of(e),
                      "its casing, {} m long behind its opening and {} m thick, overlaps that of "
                      "emitter {}; move one of them",
                      rounded(p.length()), rounded(p.wall), other.emitter.name);
    }
    pipes.push_back({e, std::move(p), std::move(places)});
  }

  /// Whether the pipe is in the domain, or beyond open faces.
  bool check_domain(const Emitter& e, const NozzlePlace& p) {
    for (int a = 0; a < 3; ++a) {
      if (flat() && a == 1) continue;
      const auto k = std::size_t(a);
      const double min = s_.domain.min[k], max = s_.domain.max[k], slack = 1e-9 * (max - min);
      if (p.center[k] < min - slack || p.center[k] > max + slack) {
        add(e.center, "{0} is {1}, outside the domain ({0} from {2} to {3} m); move it", kAxes[a],
            p.center[k], min, max);
        return false;
      }
      for (const Double3& x : p.corners()) {
        const bool low = x[k]<min - slack, high = x[k]> max + slack;
        // An opening may be wider than the domain, where columns are not.
        if (!(low && !s_.domain.is_open(a, false)) && !(high && !s_.domain.is_open(a, true)))
          continue;
        add_at(entry_of(e),
               "reaches outside the domain with its held layers ({} m behind its opening) at {}; "
               "move it in, or open the domain's face {}",
               rounded(p.depth), text(x), kFaceNames[std::size_t(2 * a + high)]);
        return false;
      }
    }
    return true;
  }

  void check_sink(const Sink& k, const std::vector<Pipe>& pipes) {
    if (!good(k.min, k.max) || !above(k.min, k.max)) return;
    BodyBox box{k.min, k.max};
    if (flat()) box.low[1] = kNoBox.high[1], box.high[1] = kNoBox.low[1];  // without an end
    for (const Pipe& p : pipes)
      for (const Double3& x : p.places) {
        if (!box.holds(x, 0)) continue;
        add(k.min, "the box holds a place in the casing of emitter {}, {}; move one of them",
            p.emitter.name, text(x));
        return;
      }
  }

  std::string entry_of(const Emitter& e) const { return block_of(name(e.center)); }
  std::size_t wrong_ = 0;  ///< problems with keys

  static std::string text(const Double3& p) {
    return fmt::format("({:.4g}, {:.4g}, {:.4g})", p[0], p[1], p[2]);
  }
};

}  // namespace

void check_emitters(const PlacedScene& placed, Problems& problems) {
  EmitterChecker(placed, problems).run();
}

}  // namespace pbf::scene_module
