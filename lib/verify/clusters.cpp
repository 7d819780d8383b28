#include "lib/verify/clusters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace pbf::verify_module {

Clusters::Clusters(const std::vector<double>& position, double edge) {
  if (!(edge > 0)) return;
  std::map<std::array<double, 3>, std::size_t> number;
  cell_.resize(position.size() / 3);
  for (std::size_t i = 0; i < cell_.size(); ++i) {
    std::array<double, 3> at{};
    for (std::size_t k = 0; k < 3; ++k) {
      at[k] = std::floor(position[3 * i + k] / edge);
      if (std::isnan(at[k])) at[k] = HUGE_VAL;  // NaN has no order
    }
    cell_[i] = number.try_emplace(at, number.size()).first->second;
  }
  cells_ = number.size();
}

double Clusters::design_effect(const std::vector<double>& values) const {
  if (cell_.empty()) return 1;
  double sum = 0;
  for (const double v : values) sum += v;
  const double mean = sum / double(values.size());
  std::vector<double> of_cell(cells_, 0.0);
  double alone = 0, together = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double r = values[i] - mean;
    alone += r * r;
    of_cell[cell_[i]] += r;
  }
  for (const double s : of_cell) together += s * s;
  const double effect = together / alone;
  return effect > 1 && std::isfinite(effect) ? effect : 1;
}

double Clusters::design_effect_of_shares(const std::vector<double>& values,
                                         const std::vector<double>& sorted) const {
  double largest = 1;
  std::vector<double> below(values.size());
  for (const double p : {0.1, 0.25, 0.5, 0.75, 0.9}) {
    const double q = sorted[std::size_t(p * double(sorted.size()))];
    for (std::size_t i = 0; i < values.size(); ++i) below[i] = values[i] <= q ? 1 : 0;
    largest = std::max(largest, design_effect(below));
  }
  return largest;
}

}  // namespace pbf::verify_module
