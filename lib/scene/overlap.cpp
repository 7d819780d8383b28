#include "lib/scene/overlap.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pbf::scene_module {
namespace {

/// Minimizes the larger of the distances of two solids in a box by the ellipsoid method (Shor
/// 1977): each cut through the center discards the half that cannot contain the minimum. In two
/// dimensions nothing changes along y.
class Deepest {
 public:
  Deepest(const Solid<double>& a, const Solid<double>& b, const BodyBox& box, bool flat)
      : a_(a), b_(b), box_(box), flat_(flat), middle_(0.5 * (box.low + box.high)) {
    for (std::size_t k = 0; k < 3; ++k)
      spread_[k][k] = 3 * std::pow(std::max(0.5 * (box.high[k] - box.low[k]), 1e-9), 2);
  }
  /// The minimum; negative if the solids overlap. Stops early if it is known to exceed `enough`.
  double run(double enough) {
    double best = std::numeric_limits<double>::infinity();
    for (int step = 0; step < 200; ++step) {
      Double3 slope{};
      double value = outside(slope);
      const bool in_box = value <= 0;
      if (in_box) best = std::min(best, value = deepest_here(slope));
      const double reach = cut(slope);
      if (in_box && (value - reach > enough || reach < 1e-3 * std::fabs(best) + 1e-9)) break;
      if (reach == 0) break;
    }
    return best;
  }

 private:
  /// How far the center is outside the box; 0 inside.
  double outside(Double3& slope) const {
    double worst = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double below = box_.low[k] - middle_[k], above = middle_[k] - box_.high[k];
      if (std::max(below, above) <= worst) continue;
      worst = std::max(below, above);
      slope = {};
      slope[k] = above > below ? 1 : -1;
    }
    return worst;
  }
  double deepest_here(Double3& slope) const {
    const Vec3<double> x{middle_[0], middle_[1], middle_[2]};
    const double of_a = flat_ ? distance<2>(a_, x) : distance<3>(a_, x),
                 of_b = flat_ ? distance<2>(b_, x) : distance<3>(b_, x);
    const Solid<double>& o = of_a >= of_b ? a_ : b_;
    const Vec3<double> n = flat_ ? normal<2>(o, x) : normal<3>(o, x);
    slope = {n.x, n.y, n.z};
    return std::max(of_a, of_b);
  }
  /// Keeps the half in the direction of descent. Returns a bound on the decrease in it.
  double cut(const Double3& slope) {
    const Double3 along{dot(spread_[0], slope), dot(spread_[1], slope), dot(spread_[2], slope)};
    const double square = dot(slope, along);
    if (!(square > 0)) return 0;
    middle_ = middle_ - (1 / (4 * std::sqrt(square))) * along;
    for (std::size_t k = 0; k < 3; ++k)
      spread_[k] = 9.0 / 8 * (spread_[k] - (along[k] / (2 * square)) * along);
    return std::sqrt(square);
  }

  const Solid<double>&a_, &b_;
  BodyBox box_;
  bool flat_;
  Double3 middle_, spread_[3] = {};
};

}  // namespace

BodyBox extents_of(const Scene& s, const Solid<double>& o) {
  const double center[3] = {o.center.x, o.center.y, o.center.z};
  BodyBox out{};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3<double> up{double(k == 0), double(k == 1), double(k == 2)};
    out.low[k] = center[k] - reach_along(o, -1.0 * up, false);
    out.high[k] = center[k] + reach_along(o, up, false);
  }
  if (s.plane()) out.low[1] = -kEndless, out.high[1] = kEndless;
  return out;
}

BodyBox extents_of(const Scene& s) {
  BodyBox out{{}, (1 / s.h()) * (s.domain.max - s.domain.min)};
  if (s.plane()) out.high[1] = 0;
  return out;
}

double shared_thickness(const Scene& s, const Solid<double>& a, const Solid<double>& b,
                        double least) {
  const BodyBox of_a = extents_of(s, a), of_b = extents_of(s, b);
  BodyBox box = extents_of(s);
  for (std::size_t k = 0; k < 3; ++k) {
    box.low[k] = std::max({box.low[k], of_a.low[k], of_b.low[k]});
    box.high[k] = std::min({box.high[k], of_a.high[k], of_b.high[k]});
    if (box.low[k] > box.high[k]) return 0;
  }
  const double depth = Deepest(a, b, box, bool(s.plane())).run(-0.5 * least);
  return -2 * depth >= least ? -2 * depth : 0;
}

}  // namespace pbf::scene_module
