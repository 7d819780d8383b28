#include "lib/program/motion_table.h"

#include <algorithm>
#include <cmath>

namespace pbf::program_module {
namespace {

double slope_at(const MotionTable& table, std::size_t c, std::size_t k) {
  const std::vector<double>& at = table.time;
  const std::size_t n = at.size();
  const auto y = [&](std::size_t row) { return table.values[row][c]; };
  const auto rise = [&](std::size_t row) {
    return (y(row + 1) - y(row)) / (at[row + 1] - at[row]);
  };
  if (k == 0) return rise(0);
  if (k == n - 1) return rise(n - 2);
  const double before = at[k] - at[k - 1], behind = at[k + 1] - at[k];
  const double rises = std::max(std::fabs(y(k) - y(k - 1)), std::fabs(y(k + 1) - y(k)));
  const double most = 1.5 * rises / std::max(before, behind);
  return std::clamp((rise(k - 1) * behind + rise(k) * before) / (before + behind), -most, most);
}

/// The slope of a piece times its width, as a polynomial of u = 0 .. 1: a u^2 + b u + c.
struct SlopeOf {
  double a, b, c;
  explicit SlopeOf(const CurvePiece& p)
      : a(6 * (p.y0 - p.y1) + 3 * p.width * (p.slope0 + p.slope1)),
        b(-6 * (p.y0 - p.y1) - p.width * (4 * p.slope0 + 2 * p.slope1)),
        c(p.width * p.slope0) {}
};

}  // namespace

std::vector<double> CurvePiece::turns() const {
  const SlopeOf s(*this);
  std::vector<double> at;
  const auto add = [&](double u) {
    if (u > 0 && u < 1) at.push_back(begin + u * width);
  };
  const double inside = s.b * s.b - 4 * s.a * s.c;
  if (inside < 0) return at;
  // The form of the roots without cancellation, also for a small.
  const double q = -0.5 * (s.b + std::copysign(std::sqrt(inside), s.b));
  if (s.a != 0) add(q / s.a);
  if (q != 0) add(s.c / q);
  std::sort(at.begin(), at.end());
  return at;
}

std::optional<double> CurvePiece::steepest() const {
  const SlopeOf s(*this);
  if (s.a == 0) return std::nullopt;
  const double u = -s.b / (2 * s.a);
  if (!(u > 0 && u < 1)) return std::nullopt;
  return begin + u * width;
}

std::size_t piece_at(const MotionTable& table, double t) {
  const std::vector<double>& at = table.time;
  const auto next = std::size_t(std::upper_bound(at.begin(), at.end(), t) - at.begin());
  return std::clamp<std::size_t>(next, 1, at.size() - 1) - 1;
}

CurvePiece curve_piece(const MotionTable& table, std::size_t c, std::size_t row) {
  return {table.time[row],         table.time[row + 1] - table.time[row],
          table.values[row][c],    table.values[row + 1][c],
          slope_at(table, c, row), slope_at(table, c, row + 1)};
}

double cubic(const MotionTable& table, std::size_t c, double t) {
  if (table.time.size() == 1) return table.values[0][c];
  const CurvePiece p = curve_piece(table, c, piece_at(table, t));
  if (t <= p.begin) return p.y0 + p.slope0 * (t - p.begin);
  if (t >= table.time.back()) return p.y1 + p.slope1 * (t - table.time.back());
  const double u = (t - p.begin) / p.width, w = 1 - u;
  return w * w * (1 + 2 * u) * p.y0 + u * u * (1 + 2 * w) * p.y1 +
         p.width * u * w * (w * p.slope0 - u * p.slope1);
}

double straight(const MotionTable& table, std::size_t c, double t) {
  const std::vector<double>& at = table.time;
  if (t <= at.front() || at.size() == 1) return table.values.front()[c];
  if (t >= at.back()) return table.values.back()[c];
  const std::size_t k = piece_at(table, t);
  const double u = (t - at[k]) / (at[k + 1] - at[k]);
  return (1 - u) * table.values[k][c] + u * table.values[k + 1][c];
}

}  // namespace pbf::program_module
