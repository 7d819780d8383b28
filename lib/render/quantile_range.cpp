#include "lib/render/quantile_range.h"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include "lib/base/error.h"
#include "lib/render/particles.h"

namespace pbf::render_module {
namespace {

constexpr std::int64_t kMostValues = 1 << 24;

/// Rearranges the values, of which there is at least one.
double quantile_of(std::vector<double>& values, double share) {
  const double place = share * static_cast<double>(values.size() - 1);
  const auto below = values.begin() + static_cast<std::ptrdiff_t>(place);
  std::nth_element(values.begin(), below, values.end());
  if (below + 1 == values.end()) return *below;
  const double next = *std::min_element(below + 1, values.end());
  return *below + (place - std::floor(place)) * (next - *below);
}

}  // namespace

QuantileRange::QuantileRange(const View& view, std::int64_t total)
    : view_(view), stride_((std::max<std::int64_t>(total, 1) + kMostValues - 1) / kMostValues) {}

void QuantileRange::add(const Snapshot& snapshot) {
  check_fields(snapshot, view_.color);
  const FieldArray& field = *snapshot.find(about(view_.color).field);
  for (std::size_t i = 0; i < snapshot.count; ++i) {
    if (seen_++ % stride_ != 0) continue;
    if (const double value = shown_value(field, view_, i); std::isfinite(value))
      values_.push_back(value);
  }
}

std::array<double, 2> QuantileRange::between(double low, double high) {
  if (values_.empty())
    bad_input("--range quantile", fmt::format("no particle of the frames chosen has a {}; choose "
                                              "other --frames, or give --range LOW,HIGH",
                                              about(view_.color).word));
  return {quantile_of(values_, low), quantile_of(values_, high)};
}

BarRange bar_range(const View& view, std::array<double, 2> quantiles) {
  BarRange bar{quantiles, ""};
  int digits = 9;
  if (view.color == ColorBy::density) {
    const double rest = view.rest_density;
    double off = std::max(std::abs(quantiles[0] - rest), std::abs(quantiles[1] - rest));
    off = std::strtod(fmt::format("{:.6g}", off).c_str(), nullptr);
    bar.ends = {rest - off, rest + off};
    digits = 12;
  }
  bar.text = fmt::format("{0:.{2}g},{1:.{2}g}", bar.ends[0], bar.ends[1], digits);
  char* comma = nullptr;
  bar.ends[0] = std::strtod(bar.text.c_str(), &comma);
  bar.ends[1] = std::strtod(comma + 1, nullptr);
  return bar;
}

}  // namespace pbf::render_module
