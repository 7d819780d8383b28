// Where the camera of a picture stands and how it maps space to pixels.
#pragma once

#include <array>

#include "lib/render/renderer.h"

namespace pbf::render_module {

/// A perspective camera. View space: x to the right, y up, z = depth away from the eye, in m.
/// Pixels: x to the right, y down, (0, 0) at the outer corner of the first pixel.
struct Projection {
  Double3 eye{};                     ///< m
  Double3 right{}, up{}, forward{};  ///< unit vectors, right-handed: right x up = -forward
  double tan_half = 1;               ///< tangent of half the vertical field of view
  std::array<int, 2> size{1, 1};     ///< pixels
  std::array<double, 2> shift{};     ///< of the picture to the left and down, in half widths and
                                     ///< half heights: the default view centres what it shows
                                     ///< between labels and colour bar

  Double3 direction(const Double3& d) const;               ///< of the scene, in view space
  Double3 to_view(const Double3& p) const;                 ///< computed in double, eye first
  std::array<double, 2> to_pixel(const Double3& p) const;  ///< of a point in front of the eye
  /// Size of a pixel on the plane at unit depth (m per m).
  double pixel() const { return 2 * tan_half / size[1]; }
  double aspect() const { return static_cast<double>(size[0]) / size[1]; }
};

/// For the graphics card.
inline std::array<float, 3> floats(const Double3& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

/// The axis of the domain that is nearest to `up`.
std::size_t vertical_axis(const Double3& up);

/// A corner of the domain; bit k of `bits`: whether it lies at the upper end of axis k.
Double3 corner_of(const View& view, unsigned bits);

/// Those of the part that the default camera shows, in the order of their bits.
using Corners = std::array<Double3, 8>;
Corners frame_of(const View& view);

/// Camera of `view` at `time` (s): the orbit turns it about `up` through the target. The default
/// stands outside the longest horizontal side, a little above and beside, as near as it sees the
/// whole frame beside the labels (at every time, when it orbits), and looks at its middle; that of
/// a scene in two dimensions stands in front of its plane, x to the right. One whose position or
/// target alone is given looks at the middle of the domain, or from where it sees the frame. Throws
/// Error(bad_input) for an empty box or a camera that cannot look: fov outside 1..170 degrees,
/// position on the target.
Projection projection_of(const View& view, double time);

}  // namespace pbf::render_module
