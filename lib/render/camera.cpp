#include "lib/render/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "lib/base/error.h"
#include "lib/render/overlay.h"
#include "lib/scene/vector3.h"

namespace pbf::render_module {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kElevation = 20 * kDegree, kBeside = 24 * kDegree;  // of the default view

/// Right, up and forward of an eye that looks along `forward` (not unit).
void set_axes(Projection& p, const Double3& forward, const Double3& up) {
  p.forward = unit(forward);
  Double3 right = cross(p.forward, up);
  if (length(right) < 1e-6) {  // looking straight up or down: any horizontal direction will do
    right = cross(p.forward, {0, 1, 0});
    if (length(right) < 1e-6) right = cross(p.forward, {1, 0, 0});
  }
  p.right = unit(right);
  p.up = cross(p.right, p.forward);
}

/// From the target to the default eye, as a unit vector.
Double3 default_direction(const View& view, const Double3& up) {
  if (view.flat) return {0, -1, 0};
  const Double3 box = view.domain_max - view.domain_min;
  // The longest of the horizontal axes lies across the picture.
  const std::size_t vertical = vertical_axis(up);
  const std::size_t a = vertical == 0 ? 1 : 0, b = vertical == 2 ? 1 : 2;
  Double3 across{};
  across[box[b] > box[a] ? b : a] = 1;
  const Double3 side = unit(across - dot(across, up) * up);
  const Double3 front = turned(cross(side, up), up, kBeside);
  return std::cos(kElevation) * front + std::sin(kElevation) * up;
}

/// What a box covers of the picture plane at unit depth, for a camera that looks at `target` from
/// `distance` with the given axes: the least and largest x, then y.
struct Extent {
  double x0 = 1e300, x1 = -1e300, y0 = 1e300, y1 = -1e300;
  void add(const Projection& axes, const Corners& box, const Double3& target, double distance) {
    for (const Double3& corner : box) {
      const Double3 q = corner - target;
      const double depth = distance + dot(q, axes.forward);
      if (depth <= 0) x1 = y1 = 1e300, x0 = y0 = -1e300;  // behind the eye: far too near
      x0 = std::min(x0, dot(q, axes.right) / depth);
      x1 = std::max(x1, dot(q, axes.right) / depth);
      y0 = std::min(y0, dot(q, axes.up) / depth);
      y1 = std::max(y1, dot(q, axes.up) / depth);
    }
  }
};

/// Least distance from the target at which the frame fits the free part of the picture for every
/// one of the axes; sets the shift that centres it there.
double fit(Projection& p, const std::vector<Projection>& axes, const View& view,
           const Double3& target) {
  const double half_x = p.tan_half * p.aspect(), half_y = p.tan_half;
  const Corners frame = frame_of(view);
  const Margins margins = margins_of(view);
  const auto extent = [&](double distance) {
    Extent e;
    for (const auto& a : axes) e.add(a, frame, target, distance);
    return e;
  };
  double low = 0, high = length(frame[7] - frame[0]);
  const auto fits = [&](double distance) {
    const Extent e = extent(distance);
    return e.x1 - e.x0 <= 2 * half_x * (1 - margins.left - margins.right) &&
           e.y1 - e.y0 <= 2 * half_y * (1 - margins.top - margins.bottom);
  };
  while (!fits(high)) low = high, high *= 2;  // ends: the extent falls with the distance
  for (int i = 0; i < 40; ++i) (fits(0.5 * (low + high)) ? high : low) = 0.5 * (low + high);
  const Extent e = extent(high);
  p.shift = {margins.right - margins.left + 0.5 * (e.x0 + e.x1) / half_x,
             margins.top - margins.bottom + 0.5 * (e.y0 + e.y1) / half_y};
  return high;
}

}  // namespace

std::size_t vertical_axis(const Double3& up) {
  std::size_t axis = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (std::abs(up[k]) > std::abs(up[axis])) axis = k;
  return axis;
}

Double3 corner_of(const View& view, unsigned bits) {
  Double3 p{};
  for (unsigned k = 0; k < 3; ++k) p[k] = (bits >> k & 1 ? view.domain_max : view.domain_min)[k];
  return p;
}

Corners frame_of(const View& view) {
  View framed;
  framed.domain_min = view.frame ? (*view.frame)[0] : view.domain_min;
  framed.domain_max = view.frame ? (*view.frame)[1] : view.domain_max;
  Corners out;
  for (unsigned bits = 0; bits < 8; ++bits) out[bits] = corner_of(framed, bits);
  return out;
}

Double3 Projection::direction(const Double3& d) const {
  return {dot(d, right), dot(d, up), dot(d, forward)};
}
Double3 Projection::to_view(const Double3& p) const { return direction(p - eye); }

std::array<double, 2> Projection::to_pixel(const Double3& p) const {
  const Double3 v = to_view(p);
  return {0.5 * size[0] * (1 - shift[0]) + v[0] / (v[2] * pixel()),
          0.5 * size[1] * (1 + shift[1]) - v[1] / (v[2] * pixel())};
}

Projection projection_of(const View& view, double time) {
  const auto bad = [](const std::string& what) { throw Error(ExitCode::bad_input, what); };
  const Double3 box = view.domain_max - view.domain_min;
  for (double edge : box)
    if (!(edge > 0) || !std::isfinite(edge)) bad("the domain of the picture is empty");
  if (!(view.camera.fov >= 1 && view.camera.fov <= 170))
    bad("render.camera.fov: " + std::to_string(view.camera.fov) +
        " is not a field of view; give 1 to 170 degrees");
  if (!(length(view.up) > 0)) bad("the up direction of the picture is zero");

  Projection p;
  p.size = view.size;
  p.tan_half = std::tan(view.camera.fov * kDegree / 2);
  const Double3 up = unit(view.up);
  const Double3 middle = 0.5 * (view.domain_min + view.domain_max);
  const Double3 seen =
      view.frame && !view.camera.position ? 0.5 * ((*view.frame)[0] + (*view.frame)[1]) : middle;
  const Double3 target = view.camera.target.value_or(seen);
  const double angle = view.camera.orbit * kDegree * time;
  Double3 arm{};  // from the target to the eye, before it orbits
  if (view.camera.position) {
    arm = *view.camera.position - target;
    if (!(length(arm) > 1e-9 * length(box)))
      bad("render.camera.position: lies on the target; move one of them");
  } else {
    const Double3 direction = default_direction(view, up);
    std::vector<Projection> axes(view.camera.orbit == 0 ? 1 : 72);
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const double turn = 2 * std::numbers::pi * static_cast<double>(i) / 72;
      set_axes(axes[i], turned(-1.0 * direction, up, turn), up);
    }
    const double distance = fit(p, axes, view, target);
    arm = distance * direction;
  }
  arm = turned(arm, up, angle);
  p.eye = target + arm;
  set_axes(p, -1.0 * arm, up);
  return p;
}

}  // namespace pbf::render_module
