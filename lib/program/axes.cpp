#include "lib/program/axes.h"

#include <algorithm>
#include <cmath>

namespace pbf::program_module {
namespace {

constexpr const char* kAxisNames[] = {"x", "y", "z"};
constexpr double kAlike = 1 - 1e-9;

double edge(const Scene& s, int axis) {
  const auto k = std::size_t(axis);
  return s.domain.max[k] - s.domain.min[k];
}

}  // namespace

Axes internal_axes(const Scene& s) {
  const bool flat = s.dimensions == 2;
  double longest = 0;
  for (const int a : {0, 1, 2})
    if (!(flat && a == 1)) longest = std::max(longest, edge(s, a));
  int z = -1;
  for (const int a : {2, 1, 0}) {
    if ((flat && a == 1) || edge(s, a) < kAlike * longest) continue;
    if (z < 0 || std::fabs(s.gravity[std::size_t(a)]) < std::fabs(s.gravity[std::size_t(z)])) z = a;
  }
  if (flat) return {{2 - z, 1, z}};
  const int first = z == 0 ? 1 : 0, last = 3 - first - z;
  return edge(s, first) < kAlike * edge(s, last) ? Axes{{last, first, z}} : Axes{{first, last, z}};
}

Scene in_internal_axes(const Scene& scene, const Axes& axes) {
  Scene s = scene;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto from = std::size_t(axes.of[k]);
    s.domain.min[k] = scene.domain.min[from];
    s.domain.max[k] = scene.domain.max[from];
    s.gravity[k] = scene.gravity[from];
  }
  for (auto* names : {&s.domain.open, &s.domain.periodic, &s.domain.friction_on})
    for (std::string& name : *names) name[0] = char('x' + axes.inside(name[0] - 'x'));
  return s;
}

Vec3<double> internal_place(const Scene& s, const Axes& axes, const Double3& at) {
  const Double3 from = s.origin();
  Double3 x{};
  for (std::size_t a = 0; a < 3; ++a)
    x[a] = s.dimensions == 2 && a == 1 ? 0 : (at[a] - from[a]) / s.h();
  return along_internal(axes, x);
}

std::string axes_text(const Axes& axes) {
  std::string out;
  for (const int a : axes.of) out.append(out.empty() ? "" : ", ").append(kAxisNames[a]);
  return out;
}

}  // namespace pbf::program_module
