// The share of the walls' kernel that lies in a body with a surface of triangles.
#pragma once

#include "lib/scene/vector3.h"

namespace pbf::program_module {

/// A part of the share, without the amplitude of walls, and its gradient by the place.
struct SharePart {
  double share = 0;
  Double3 gradient{};  ///< per range
  void add(const SharePart& o) {
    share += o.share;
    gradient = gradient + o.gradient;
  }
};

/// What one triangle contributes at x, lengths in units of the kernel's range. The share at x is
/// the sum over all triangles, and 1 if x is inside. By Gauss' theorem, for the unit kernel W
/// (Spiky): the share is [x inside] - sum s int H/r^3 dA, H(r) = int_r^1 W t^2 dt, with s the
/// distance of x behind the plane of the triangle, and its gradient -sum n int W dA. Both integrals
/// go along the edges, in polar coordinates about the foot of x in the plane. corner:
/// counterclockwise seen from outside. Error below 1e-6 of the share.
SharePart share_of_triangle(const Double3& x, const Double3 (&corner)[3]);

}  // namespace pbf::program_module
