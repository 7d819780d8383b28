#include "lib/program/mesh_share.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pbf::program_module {
namespace {

using std::numbers::pi;

/// Differences of the inner integrals between r and |s|, over r^2 - s^2, with k = r + |s|:
/// int W r dr = 15/pi (r^2/2 - r^3 + 3 r^4/4 - r^5/5), and of H/r^2 what remains beside -1/(4 pi
/// r), 15/pi (-r^2/6 + r^3/4 - 3 r^4/20 + r^5/30).
struct Inner {
  double weight, density;
};
Inner inner(double r, double s) {
  const double r2 = r * r, s2 = s * s, k = r + s;
  const double d3 = (r2 + r * s + s2) / k, d4 = r2 + s2;
  const double d5 = (r2 * r2 + r2 * r * s + r2 * s2 + r * s2 * s + s2 * s2) / k;
  return {0.5 - d3 + 0.75 * d4 - 0.2 * d5, -1.0 / 6 + 0.25 * d3 - 0.15 * d4 + d5 / 30};
}
constexpr double kNodes[3] = {0.23861918608319690863, 0.66120938646626451366,
                              0.93246951420315202781};
constexpr double kWeights[3] = {0.46791393457269104739, 0.36076157304813860757,
                                0.17132449237917034504};

/// The integrals of `inner` (r^2 - s^2 = a^2 + t^2 and dphi = a dt/(a^2 + t^2)) from t = u to v, by
/// Gauss' rule of 6 nodes.
Inner along(double a, double s, double u, double v) {
  Inner sum{0, 0};
  const double half = 0.5 * (v - u), middle = 0.5 * (v + u), c2 = a * a + s * s;
  for (int k = 0; k < 6; ++k) {
    const double t = middle + half * (k < 3 ? -kNodes[k] : kNodes[k - 3]);
    const Inner f = inner(std::sqrt(c2 + t * t), s);
    sum.weight += kWeights[k % 3] * f.weight;
    sum.density += kWeights[k % 3] * f.density;
  }
  return {a * half * sum.weight, a * half * sum.density};
}

}  // namespace

SharePart share_of_triangle(const Double3& x, const Double3 (&corner)[3]) {
  const Double3 p[3] = {corner[0] - x, corner[1] - x, corner[2] - x};
  const Double3 across = cross(p[1] - p[0], p[2] - p[0]);
  const double area = length(across);
  if (!(area > 0)) return {};
  const Double3 n = (1 / area) * across;
  const double behind = dot(n, p[0]), s = std::fabs(behind);
  if (!(s < 1)) return {};
  const double sign = behind < 0 ? -1 : 1;
  // At r = 1, less than at |s|: of the weight, and of the density beside -1/(4 pi r).
  const Inner ends = inner(1, s);
  const double whole_weight = (1 - s * s) * ends.weight, whole_density = (1 - s * s) * ends.density;
  double weight = 0, density = 0, angle = 0;  // density: what is to be multiplied by `behind`
  for (int k = 0; k < 3; ++k) {
    const Double3 from = p[k] - behind * n, to = p[(k + 1) % 3] - behind * n, way = to - from;
    const double size = length(way);
    if (!(size > 0)) continue;
    const Double3 along_edge = (1 / size) * way;
    const double a = dot(n, cross(from, along_edge));
    if (a == 0) continue;  // no angle
    const double u = dot(from, along_edge), v = u + size;
    const auto angle_of = [&](double t) { return std::atan2(t, std::fabs(a)); };
    const double direction = a < 0 ? -1 : 1, c2 = a * a + s * s;
    const double reach = c2 < 1 ? std::sqrt(1 - c2) : 0;
    const double low = std::clamp(u, -reach, reach), high = std::clamp(v, -reach, reach);
    if (high > low) {
      for (const auto& [b, e] : {std::pair{low, std::min(high, 0.0)}, {std::max(low, 0.0), high}})
        if (e > b) {
          const Inner part = along(a, s, b, e);
          weight += part.weight;
          density += part.density;
        }
      // int (1/|s| - 1/r) dphi |s| = dphi - atan(|s| t/(a r))
      const auto far = [&](double t) {
        return std::atan2(s * t, std::fabs(a) * std::sqrt(c2 + t * t));
      };
      angle += direction * (angle_of(high) - angle_of(low) - (far(high) - far(low)));
    }
    const double outside =
        direction * (angle_of(v) - angle_of(u) - (angle_of(high) - angle_of(low)));
    weight += outside * whole_weight;
    density += outside * whole_density;
    angle += outside * (1 - s);
  }
  SharePart part;
  part.share = -(sign * angle / (4 * pi) + behind * (15 / pi) * density);
  part.gradient = (-(15 / pi) * weight) * n;
  return part;
}

}  // namespace pbf::program_module
