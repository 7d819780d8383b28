#include "lib/scene/waves.h"

#include <algorithm>
#include <cmath>

namespace pbf::scene_module {
namespace {

constexpr double kPi = 3.14159265358979323846;

double square(double x) { return x * x; }
/// Of fractions in deep water, where the functions themselves overflow.
double inverse_sinh2(double x) { return square(2 * std::exp(-x) / (1 - std::exp(-2 * x))); }
double cosh_over_sinh(double a, double b) {
  return std::exp(a - b) * (1 + std::exp(-2 * a)) / (1 - std::exp(-2 * b));
}
double grown(double t, double ramp) {
  if (t <= 0) return 0;
  return t >= ramp ? 1 : 0.5 * (1 - std::cos(kPi * t / ramp));
}

/// m, of Goring's paddle t seconds after it began.
double solitary_way(const SolitaryWave& w, double t) {
  const auto way = [&](double time) {
    double x = 0;
    for (int k = 0; k < 100; ++k) {
      const double th = std::tanh(w.kappa * (w.speed * (time - w.middle) - x));
      const double off = x - w.half_stroke * (1 + th);
      const double next = x - off / (1 + w.half_stroke * w.kappa * (1 - th * th));
      if (std::fabs(next - x) < 1e-15 * w.half_stroke) break;
      x = next;
    }
    return x;
  };
  return t <= 0 ? 0 : way(t) - way(0);
}

}  // namespace

double wave_number(double omega, double depth, double gravity) {
  const double y = omega * omega * depth / gravity;
  double x = y / std::sqrt(std::tanh(y));
  for (int k = 0; k < 50; ++k) {
    const double th = std::tanh(x), step = (x * th - y) / (th + x * (1 - th * th));
    x -= step;
    if (std::fabs(step) < 1e-14 * x) break;
  }
  return x / depth;
}

double group_speed(double omega, double k, double depth) {
  const double kd = k * depth;
  return 0.5 * omega / k * (1 + 4 * kd * std::exp(-2 * kd) / (1 - std::exp(-4 * kd)));
}

double piston_ratio(double kd) { return 2 / (1 / std::tanh(kd) + kd * inverse_sinh2(kd)); }

double flap_ratio(double kd, double hinge) {
  const double end = cosh_over_sinh(kd * std::max(hinge, 0.0), kd) - 1 / std::tanh(kd);
  return piston_ratio(kd) * (1 + end / (kd * (1 - hinge)));
}

double second_stroke(double height, double depth, double kd) {
  const double coth = 1 / std::tanh(kd);
  return height * height / (32 * depth) * (3 * coth * inverse_sinh2(kd) - 2 / piston_ratio(kd));
}

double SolitaryWave::duration() const { return 2 * middle + 2 * half_stroke / speed; }

double WaveMaker::length() const { return 2 * kPi / k; }

bool WaveMaker::by_mccowan() const {
  return !solitary.empty() || 0.78 * depth < 0.142 * length() * std::tanh(kd());
}

double WaveMaker::breaks_at() const {
  return by_mccowan() ? 0.78 * depth : 0.142 * length() * std::tanh(kd());
}

double WaveMaker::loss(double d) const {
  if (!solitary.empty()) return 0;
  const double rate = has_short_kernel() ? (dimensions == 2 ? 133 : 81) * std::pow(d / height, 1.5)
                      : dimensions == 2  ? 10.6 * (1 + 5.6 * d / height)
                                         : 7.8;
  return 1 - std::exp(-rate * d / length());
}

double WaveMaker::free_share() const {
  if (lines.empty() || lines.size() > 2 || flap || solitary.size() > 0) return 0;
  const double free = wave_number(2 * lines[0].omega, depth, gravity) * depth;
  return std::fabs(piston_ratio(free) * second_stroke(height, depth, kd())) / (height / 2);
}

double WaveMaker::paddle(double time) const {
  const double t = time - start;
  double x = 0;
  for (const WaveLine& l : lines) x += l.stroke * std::sin(l.omega * t + l.phase);
  x *= grown(t, ramp);
  for (const SolitaryWave& w : solitary) x += solitary_way(w, t - w.begin);
  return gain * x;
}

double WaveMaker::angle(double time) const {
  return std::atan(paddle(time) / (depth - hinge)) * 180 / kPi;
}

double WaveMaker::elevation(double s, double time) const {
  const double t = time - start;
  double eta = 0;
  for (const WaveLine& l : lines)
    if (const double share = grown(t - s / l.group, ramp); share > 0)
      eta += share * l.amplitude * std::cos(l.omega * t - l.k * s + l.phase);
  for (const SolitaryWave& w : solitary)
    if (t > w.begin)
      eta += w.height /
             square(std::cosh(w.kappa * (w.speed * (t - w.begin - w.middle) - (s - w.from))));
  return eta;
}

MotionTable wave_table(const Scene& scene, const Obstacle& o, double most) {
  const WaveMaker w = wave_maker(scene, o);
  const auto rounded = [](double x) { return std::round(1e9 * x) / 1e9; };
  const double step = w.shortest / kRowsPerPeriod, from = scene.time.motion_begin - w.start;
  const double first = std::floor(from / step) - 1,
               last = std::ceil((from + scene.time.end) / step) + 2;
  MotionTable table;
  if (last - first > most || step < 1e-6) return table;
  table.columns = w.flap ? 6 : 3;
  for (double k = first; k <= last; ++k) {
    const double time = rounded(w.start + k * step);
    std::array<double, 6> row{};
    // Forward is the rotation about y for waves along x, and that against x for those along y.
    if (w.flap)
      row[4 - w.axis] = (w.axis == 0 ? 1 : -1) * w.sign * rounded(w.angle(time));
    else
      row[w.axis] = w.sign * rounded(w.paddle(time));
    for (double& x : row) x += 0.0;  // no -0
    table.time.push_back(time);
    table.values.push_back(row);
  }
  return table;
}

}  // namespace pbf::scene_module
