#include "lib/scene/sponge_waves.h"

#include <algorithm>
#include <complex>

#include "lib/scene/sponge.h"

namespace pbf::scene_module {

double sponge_reflection(double lengths, double rate, int profile) {
  if (!(lengths > 0)) return 1;
  // With lengths in wavelengths, times in periods and a speed of 1 the linear equations of long
  // waves are i w e = -u', (i w + rate s^n) u = -e', w = 2 pi. From the wall, where u = 0, back to
  // the begin of the zone by the classical Runge-Kutta method.
  using Complex = std::complex<double>;
  const Complex iw(0, 2 * 3.14159265358979323846);
  struct State {
    Complex e, u;
  };
  const auto slope = [&](double s, const State& y) {
    return State{(iw + rate * std::pow(std::max(s, 0.0), profile)) * y.u, iw * y.e};
  };
  // Beyond these a zone is a wall where it begins, or takes all.
  rate = std::min(rate, 1e6), lengths = std::min(lengths, 100.0);
  const double fastest = std::sqrt(std::abs(iw) * (std::abs(iw) + rate));  // 1/wavelength
  const int steps = int(std::max(2000.0, std::ceil(2 * lengths * fastest)));
  const double dx = lengths / steps;
  State y{1, 0};
  for (int k = 0; k < steps; ++k) {
    const auto at = [&](double part) { return 1 - (k + part) / steps; };
    const auto plus = [&](const State& d, double x) { return State{y.e + x * d.e, y.u + x * d.u}; };
    const State a = slope(at(0), y), b = slope(at(0.5), plus(a, dx / 2)),
                c = slope(at(0.5), plus(b, dx / 2)), d = slope(at(1), plus(c, dx));
    y.e += dx / 6 * (a.e + 2.0 * b.e + 2.0 * c.e + d.e);
    y.u += dx / 6 * (a.u + 2.0 * b.u + 2.0 * c.u + d.u);
    const double size = std::abs(y.e) + std::abs(y.u);  // only the ratio counts
    y.e /= size, y.u /= size;
  }
  // The incident wave has u = e, the reflected one u = -e.
  return std::abs(y.e - y.u) / std::abs(y.e + y.u);
}

std::vector<WaveSponge> wave_sponges(const Scene& s, const WaveMaker& w) {
  std::vector<WaveSponge> all;
  if (!w.solitary.empty()) return all;
  for (const Sponge& zone : s.damping) {
    const int face = face_named(zone.toward);
    if (face / 2 != int(w.axis) || (face % 2 == 1) != (w.sign > 0) || !damps(zone, int(w.axis)))
      continue;
    const double low = std::max(zone.min[w.axis], s.domain.min[w.axis]),
                 high = std::min(zone.max[w.axis], s.domain.max[w.axis]),
                 begin = std::min(w.sign * low, w.sign * high) - w.front,
                 lengths = (high - low) / w.length();
    all.push_back({zone.name, begin, lengths,
                   sponge_reflection(lengths, sponge_rate(s, zone) * w.period, zone.profile)});
  }
  return all;
}

}  // namespace pbf::scene_module
