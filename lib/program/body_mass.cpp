#include "lib/program/body_mass.h"

#include "lib/base/error.h"
#include "lib/scene/free_start.h"

namespace pbf::program_module {
namespace {

/// A symmetric tensor along a body's axes, along those of the scene. rows: the axes of the body.
Matrix3 along_scene(const Matrix3& rows, const Matrix3& in_body) {
  Matrix3 out{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t b = 0; b < 3; ++b) out[a][b] += rows[i][a] * in_body[i][j] * rows[j][b];
  return out;
}

}  // namespace

BodyMass body_mass(const Scene& s, const Obstacle& o) {
  const BodyMoments m = moments_of(s, o);
  if (!o.free || !(m.volume > 0))
    throw Error(ExitCode::internal, "obstacle " + o.name + " has no mass");
  const double density = o.free->density_in(m.volume);
  const Matrix3 rows = o.axes(), second = along_scene(rows, m.second);
  const double trace = second[0][0] + second[1][1] + second[2][2];
  BodyMass out;
  out.volume = m.volume;
  out.mass = o.free->mass.value_or(density * m.volume);
  out.center = o.middle();
  for (std::size_t k = 0; k < 3; ++k) out.center = out.center + m.center[k] * rows[k];
  if (s.dimensions == 2) {
    out.inertia[1][1] = density * trace;
    return out;
  }
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      out.inertia[i][j] = density * ((i == j ? trace : 0) - second[i][j]);
  return out;
}

std::vector<ContactPoint> contact_points(const Scene& s, const Obstacle& o) {
  return std::visit(
      [&](const auto& keys) {
        if constexpr (requires { keys.contacts(false); }) return keys.contacts(s.dimensions == 2);
        return std::vector<ContactPoint>{};
      },
      o.shape);
}

}  // namespace pbf::program_module
