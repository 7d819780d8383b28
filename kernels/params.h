// Parameters of a step, passed by value to every pass. Everything is in the internal frame:
// length in units of h from the domain's lower corner, time in seconds, density in units of rho0.
// So no power of h appears in any formula: nothing overflows for h from 1e-6 m to 1e6 m, and
// positions keep their digits however far the domain lies from the origin.
#pragma once

#include <cstdint>

#include "kernels/boundary/box.h"
#include "kernels/vec3.h"

namespace pbf::PBF_VARIANT {

template <class Real>
struct Params {
  int dimensions = 3;               ///< 2: y and v_y are 0
  Real dt = 0, inv_dt = 0;          ///< s, 1/s
  Real back = 0;                    ///< s, how long before x* the corrections take their direction
  Real carry = 0;                   ///< share of the last step's push in the prediction
  Vec3<Real> gravity;               ///< h/s^2
  Real damping = 1;                 ///< factor on the velocity, once per update
  Real speed_squared = Real(1e30);  ///< (h/s)^2, faster particles are counted ...
  bool limit_speed = false;         ///< ... and slowed down to it
  /// (h/s)^2; faster particles are checked against their neighbors in the first iteration.
  Real passing_squared = Real(1e30);
  Box<Real> boundary;
  Vec3<Real> period;  ///< h, length of the domain along periodic axes, 0 along others
  Vec3<Real> below;   ///< h, where the grid begins below 0: a cell for images, 0 along other axes
  int cells_x = 1, cells_y = 1, cells_z = 1;  ///< cells_x counts half cells; in 2-D cells_y = 1
  Real inv_cell = 1;                          ///< 1/h, one over the edge of a cell (>= h)
  Real vol = 1;                               ///< m/(rho0 h^3), weight of one particle
  bool two_sided = false;                     ///< C = rho - 1 instead of max(rho - 1, 0)
  Real cfm = 0;                               ///< eps^ = eps h^2
  Real sor = 1;                               ///< omega
  bool under_relax = false;                   ///< smaller steps where the density is above 1
  Real tensile_k = 0;                         ///< h^2
  Real tensile_scale = 0;                     ///< 1/shape(delta_q)
  int tensile_n = 4;
  Real tensile_from = 0;    ///< of shape/shape(delta_q); below, the artificial pressure is 0
  Real xsph = 0;            ///< c, times 1 - carry
  Real vorticity = 0;       ///< 1/s, epsilon
  Real hyperviscosity = 0;  ///< c of HyperviscosityPass, times 1 - carry
  Real calm = 0;            ///< 1/v0^2 of VelocityLaplacianPass, (s/h)^2
  Real update_dt = 0;       ///< s, sum of all substeps; confinement acts once per update
};

}  // namespace pbf::PBF_VARIANT
