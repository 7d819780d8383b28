// A wave maker from the keys of its scene.
#include <algorithm>
#include <cmath>

#include "lib/scene/lattice.h"
#include "lib/scene/random.h"
#include "lib/scene/vector3.h"
#include "lib/scene/waves.h"

namespace pbf::scene_module {
namespace {

constexpr double kTurn = 2 * 3.14159265358979323846;

/// Where it stands; the keys of its box and its direction.
WaveMaker placed_maker(const Scene& s, const Obstacle& o) {
  const Motion& m = *o.motion;
  WaveMaker w;
  w.flap = !m.direction;
  const Double3 along = w.flap ? cross(*m.axis, {0, 0, 1}) : *m.direction;
  w.axis = along[0] != 0 ? 0 : 1;
  w.sign = along[w.axis] > 0 ? 1 : -1;
  const obstacle_keys::Box& box = o.as<obstacle_keys::Box>();
  const Double3 half = 0.5 * (box.max - box.min);
  double reach = 0;
  for (std::size_t k = 0; k < 3; ++k) reach += std::fabs(box.axes()[k][w.axis]) * half[k];
  w.front = w.sign * box.middle()[w.axis] + reach;
  w.back = w.front - 2 * reach;
  w.ahead = w.sign * (w.sign > 0 ? s.domain.max : s.domain.min)[w.axis] - w.front;
  w.gravity = -s.gravity[2];
  w.hinge = w.flap ? (*m.pivot)[2] - s.domain.min[2] : 0;
  return w;
}

double gamma_of(const Motion& m) { return m.spectrum == WaveSpectrum::jonswap ? m.gamma : 1; }
std::array<double, 2> band_of(const Motion& m) { return m.band.value_or(std::array{0.4, 3.0}); }

double ratio(const WaveMaker& w, double kd) {
  return w.flap ? flap_ratio(kd, w.hinge / w.depth) : piston_ratio(kd);
}
WaveLine line(const WaveMaker& w, double omega, double amplitude, double phase) {
  const double k = wave_number(omega, w.depth, w.gravity);
  return {omega,     k,
          phase,     amplitude / ratio(w, k * w.depth),
          amplitude, group_speed(omega, k, w.depth)};
}

void add_regular(WaveMaker& w, const Motion& m) {
  w.second = m.order == 2 || (m.order == 0 && !w.flap);
  w.lines = {line(w, kTurn / m.period, m.height / 2, 0)};
  w.shortest = m.period / (w.second ? 2 : 1);
  if (!w.second) return;
  const double kd = w.lines[0].k * w.depth, coth = 1 / std::tanh(kd),
               over = coth * coth - 1;  // 1/sinh^2
  const double bound = w.lines[0].k * m.height * m.height / 16 * coth * (2 + 3 * over);
  w.lines.push_back({2 * w.lines[0].omega, 2 * w.lines[0].k, 0,
                     second_stroke(m.height, w.depth, kd), bound, w.lines[0].group});
}

void add_irregular(WaveMaker& w, const Scene& s, const Motion& m) {
  const double repeat = repeat_of(s, m), unit = repeat / m.period;
  const auto first = std::int64_t(std::ceil(band_of(m)[0] * unit)),
             last = std::int64_t(std::floor(band_of(m)[1] * unit));
  double all = 0;
  for (auto n = first; n <= last; ++n) all += wave_spectrum(double(n) / unit, gamma_of(m));
  for (auto n = first; n <= last; ++n) {
    const LineNumbers random = line_numbers(m.seed, n);
    double m0 = m.height * m.height / 16 * wave_spectrum(double(n) / unit, gamma_of(m)) / all;
    if (m.amplitudes == WaveAmplitudes::random) m0 *= -std::log(random.uniform);
    w.lines.push_back(line(w, kTurn * double(n) / repeat, std::sqrt(2 * m0), random.phase));
  }
}

void add_focused(WaveMaker& w, const Motion& m) {
  const auto [low, high] = band_of(m);
  const double way = w.sign * m.place - w.front, df = (high - low) / m.components;
  double all = 0;
  for (int n = 0; n < m.components; ++n) all += wave_spectrum(low + (n + 0.5) * df, gamma_of(m));
  for (int n = 0; n < m.components; ++n) {
    const double f = low + (n + 0.5) * df;
    WaveLine l = line(w, kTurn * f / m.period, m.crest * wave_spectrum(f, gamma_of(m)) / all, 0);
    l.phase = std::remainder(l.k * way - l.omega * m.time + m.phase * kTurn / 360, kTurn);
    w.lines.push_back(l);
  }
}

void add_solitary(WaveMaker& w, const Motion& m) {
  double from = 0;
  for (std::size_t k = 0; k < m.heights.size(); ++k) {
    const double height = m.heights[k], d = w.depth;
    SolitaryWave one{height, m.times[k]};
    one.kappa = std::sqrt(0.75 * height /
                          (d * d * (m.theory == SolitaryTheory::rayleigh ? d + height : d)));
    one.speed = std::sqrt(w.gravity * (d + height));
    one.half_stroke = height / (one.kappa * d);
    one.middle = 3.8 / (one.kappa * one.speed);
    one.from = from;
    from += 2 * one.half_stroke;
    const double period = kTurn / (one.kappa * one.speed);
    if (height > w.height)
      w.height = height, w.k = one.kappa, w.speed = w.group = one.speed, w.period = period;
    w.shortest = k == 0 ? period : std::min(w.shortest, period);
    w.solitary.push_back(one);
  }
}

}  // namespace

double wave_spectrum(double f, double gamma) {
  const double off = (f - 1) / (f <= 1 ? 0.07 : 0.09);
  return std::pow(f, -5) * std::exp(-1.25 * std::pow(f, -4)) *
         std::pow(gamma, std::exp(-0.5 * off * off));
}

LineNumbers line_numbers(std::uint64_t seed, std::int64_t line) {
  SplitMix64 of_seed(seed);
  SplitMix64 numbers(of_seed.next() + std::uint64_t(line) * 0xD1342543DE82EF95u);
  const double phase = kTurn * numbers.uniform();
  return {phase, 1 - numbers.uniform()};
}

std::optional<FilledDepth> filled_depth(const Scene& s, const Obstacle& o) {
  const WaveMaker w = placed_maker(s, o);
  const double d = s.fluid.spacing, floor = s.domain.min[2];
  std::optional<FilledDepth> found;
  for (const Body& b : s.bodies) {
    if (b.shape != Shape::block || b.min[2] > floor + 0.5 * d ||
        std::max(w.sign * b.min[w.axis], w.sign * b.max[w.axis]) <= w.front)
      continue;
    const double level = b.min[2] - floor + block_cells(b, d, s.plane())[2] * d;
    if (found && std::fabs(found->level - level) > 0.5 * d) return std::nullopt;
    if (!found) found = {level, b.max[2] - floor};
  }
  return found;
}

double repeat_of(const Scene& s, const Motion& m) {
  const double run = s.time.motion_begin + s.time.end - m.start;
  return m.repeat.value_or(std::max(std::ceil(run - 1e-9), std::ceil(4 * m.period)));
}

WaveMaker wave_maker(const Scene& s, const Obstacle& o) {
  const Motion& m = *o.motion;
  WaveMaker w = placed_maker(s, o);
  w.dimensions = s.dimensions, w.smoothing_ratio = s.fluid.smoothing_ratio;
  w.depth = m.depth ? *m.depth : filled_depth(s, o).value_or(FilledDepth{}).level;
  w.start = m.start, w.gain = m.gain;
  if (m.kind == MotionKind::solitary_waves) {
    add_solitary(w, m);
    return w;
  }
  const bool irregular = m.kind == MotionKind::irregular_waves;
  w.height = m.kind == MotionKind::focused_waves ? 2 * m.crest : m.height;
  w.period = m.period;
  w.ramp = m.ramp.value_or((irregular ? 2 : 1) * m.period);
  w.shortest = m.period / band_of(m)[1];
  if (m.kind == MotionKind::regular_waves) add_regular(w, m);
  if (irregular) add_irregular(w, s, m);
  if (m.kind == MotionKind::focused_waves) add_focused(w, m);
  const WaveLine peak = line(w, kTurn / m.period, 0, 0);
  w.k = peak.k, w.speed = peak.omega / peak.k, w.group = peak.group;
  return w;
}

}  // namespace pbf::scene_module
