// Where the points of a diagram go, shared by SVG and PNG: x linear, y logarithmic.
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "lib/verify/compare.h"

namespace pbf::inline verify_module {

/// Pixels, y downwards.
struct DiagramScale {
  double width = 0, height = 0, left = 0, right = 0, top = 0, bottom = 0;
  double x0 = 0, x1 = 1, log0 = -1, log1 = 0;  ///< ranges of x and log10(y)
  std::vector<std::pair<double, std::string>> x_ticks, y_ticks;

  double x(double v) const { return left + (v - x0) / (x1 - x0) * (right - left); }
  double y(double v) const {
    return bottom - (std::log10(v) - log0) / (log1 - log0) * (bottom - top);
  }
};

/// Ranges that hold every positive finite point, whole powers of ten.
DiagramScale diagram_scale(const Diagram& d, double width, double height);

}  // namespace pbf::inline verify_module
