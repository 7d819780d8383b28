#include "lib/verify/diagram_scale.h"

#include <algorithm>

#include "lib/base/text.h"

namespace pbf::inline verify_module {

DiagramScale diagram_scale(const Diagram& d, double width, double height) {
  DiagramScale s;
  s.width = width, s.height = height;
  s.left = 60, s.right = width - 20, s.top = 44, s.bottom = height - 40;
  double low = HUGE_VAL, high = 0;
  for (const Curve& c : d.curves)
    for (std::size_t k = 0; k < c.x.size(); ++k) {
      s.x1 = std::max(s.x1, c.x[k]);
      if (!(c.y[k] > 0) || !std::isfinite(c.y[k])) continue;
      low = std::min(low, c.y[k]);
      high = std::max(high, c.y[k]);
    }
  if (high > 0) {
    s.log0 = std::floor(std::log10(low));
    s.log1 = std::max(s.log0 + 1, std::ceil(std::log10(high)));
  }
  const int every = std::max(1, int((s.log1 - s.log0) / 8));
  for (int p = int(s.log0); p <= int(s.log1); p += every)
    s.y_ticks.emplace_back(std::pow(10.0, p), format("1e%d", p));
  const double raw = (s.x1 - s.x0) / 6, power = std::pow(10, std::floor(std::log10(raw)));
  const double step = power * (raw / power < 1.5 ? 1 : raw / power < 3.5 ? 2 : 5);
  for (double v = s.x0; v <= s.x1 * (1 + 1e-9); v += step)
    s.x_ticks.emplace_back(v, format("%g", v));
  return s;
}

}  // namespace pbf::inline verify_module
