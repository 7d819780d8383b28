#include "lib/scene/rigid.h"

#include <algorithm>
#include <limits>

namespace pbf::scene_module {

BodyMoments moments_of(const TriangleMesh& mesh, const Double3& from) {
  // Sums over tetrahedra with a corner at `from`; those seen from behind count as negative.
  double six_volumes = 0;
  Double3 first{};
  Matrix3 second{};
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    const Double3 corner[3] = {mesh.corner(t, 0) - from, mesh.corner(t, 1) - from,
                               mesh.corner(t, 2) - from};
    const double det = dot(corner[0], cross(corner[1], corner[2]));
    const Double3 sum = corner[0] + corner[1] + corner[2];
    six_volumes += det;
    first = first + det * sum;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) {
        double products = sum[i] * sum[j];
        for (const Double3& c : corner) products += c[i] * c[j];
        second[i][j] += det * products;
      }
  }
  BodyMoments m;
  m.volume = six_volumes / 6;
  m.center = (1 / (24 * m.volume)) * first;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      m.second[i][j] = second[i][j] / 120 - m.volume * m.center[i] * m.center[j];
  return m;
}

std::vector<ContactPoint> contacts_of(const TriangleMesh& mesh, const Double3& from, double by,
                                      std::size_t most) {
  const std::vector<Double3>& all = mesh.vertex;
  std::vector<ContactPoint> out;
  std::vector<double> away(all.size(), std::numeric_limits<double>::infinity());
  const auto take = [&](std::size_t k) {
    if (away[k] == 0) return;  // there already
    out.push_back({by * (all[k] - from), 0});
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Double3 d = all[i] - all[k];
      away[i] = std::min(away[i], dot(d, d));
    }
  };
  for (int code = 0; code < 27; ++code) {
    const Double3 along{double(code % 3 - 1), double(code / 3 % 3 - 1), double(code / 9 - 1)};
    if (code == 13) continue;  // no direction
    std::size_t outermost = 0;
    for (std::size_t k = 1; k < all.size(); ++k)
      if (dot(along, all[k]) > dot(along, all[outermost])) outermost = k;
    take(outermost);
  }
  while (out.size() < most) {
    const std::size_t farthest = std::size_t(std::ranges::max_element(away) - away.begin());
    if (away[farthest] == 0) break;
    take(farthest);
  }
  return out;
}

}  // namespace pbf::scene_module
