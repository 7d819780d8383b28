// Warnings about waves and how they are made.
#include <fmt/core.h>
#include <algorithm>
#include <cmath>

#include "lib/base/text.h"
#include "lib/run/motion_warnings.h"
#include "lib/run/wave_files.h"
#include "lib/scene/sponge_waves.h"

namespace pbf::run_module {
namespace {

constexpr double kMostUrsell = 26.3;  // 8 pi^2/3, of Madsen's second order
constexpr double kFirstUrsell = 5;    // above it first order sends a free wave along
constexpr double kHeightOfSea = 1.8;  // of the highest wave over the significant one
constexpr double kMostLoss = 0.1;     // per wavelength
constexpr double kFewSteps = 100;     // in a period

std::string breaks_text(const WaveMaker& w, const Motion& m) {
  const bool sea = m.kind == MotionKind::irregular_waves;
  if (!sea && m.kind != MotionKind::focused_waves) return "";
  const double height = (sea ? kHeightOfSea : 1) * w.height;
  if (height <= w.breaks_at()) return "";
  return fmt::format(
      "its highest waves, about {:.3g} m, are above {:.3g} m, at which waves break "
      "({}); lower {}",
      height, w.breaks_at(), w.by_mccowan() ? "McCowan" : "Miche", sea ? "height" : "crest");
}

std::string theory_text(const WaveMaker& w, const Motion& m) {
  if (m.kind == MotionKind::focused_waves) {
    const double now = w.elevation(w.sign * m.place - w.front, m.start + m.time),
                 full = m.crest * std::cos(m.phase * 3.14159265358979323846 / 180);
    if (std::fabs(now - full) <= 0.02 * m.crest) return "";
    return fmt::format(
        "its slowest waves are not at place {:g} at time {:g}: {:.3g} m of {:.3g} m "
        "are; give a later time, or a narrower band",
        m.place, m.time, now, full);
  }
  if (m.kind != MotionKind::regular_waves) return "";
  const double u = w.ursell();
  if (w.second)
    return u <= kMostUrsell
               ? ""
               : fmt::format(
                     "theory of second order holds up to H L^2/D^3 = {}, and it is {:.3g}: "
                     "the crests get crests of their own; give lower or shorter waves, or "
                     "solitary_waves",
                     kMostUrsell, u);
  if (u <= kFirstUrsell) return "";
  return fmt::format(
      "with order 1 and H L^2/D^3 = {:.3g}, above {}, a free wave of half the period runs along{}; "
      "{}",
      u, kFirstUrsell,
      w.flap ? "" : fmt::format(", of {:.2g} of the first harmonic", w.free_share()),
      w.flap ? "lower the waves, or use a piston" : "give order 2");
}

std::string resolution_text(const WaveMaker& w, double d) {
  std::vector<std::string> texts;
  if (w.height < 5 * d)
    texts.push_back(fmt::format("waves are {:.2g} spacings high, below 5", w.height / d));
  if (w.depth < 20 * d)
    texts.push_back(fmt::format("the water is {:.3g} spacings deep, below 20", w.depth / d));
  if (const double loss = w.loss(d); loss > kMostLoss)
    texts.push_back(
        fmt::format("they will lose about {:.2g} % of their height per wavelength "
                    "(estimate), above 10",
                    100 * loss));
  if (texts.empty()) return "";
  double finer = std::min({d, w.height / 5, w.depth / 20});
  while (w.loss(finer) > kMostLoss) finer *= 0.99;
  return joined(texts, ", ") + fmt::format("; give fluid.spacing {:.2g} or less", finer);
}

std::string step_text_of(const WaveMaker& w, double step) {
  if (w.period >= kFewSteps * step) return "";
  return fmt::format("{:.3g} steps in a period, below {:g}; give time.step {:.2g} or less",
                     w.period / step, kFewSteps, w.period / kFewSteps);
}

std::string settings_text(const Scene& s, const WaveMaker& w) {
  if (s.solver.levels != LevelsMode::off) {
    WaveMaker best = w;
    best.smoothing_ratio = 2;
    const double loss = w.loss(s.fluid.spacing), least = best.loss(s.fluid.spacing);
    if (!(loss > 0.02 && loss > 1.5 * least)) return "";
    return fmt::format(
        "waves lose about {:.2g} % of their height per wavelength with h = {:g} d, {:.2g} % with "
        "fluid.smoothing_ratio 2 (configs/SETTINGS.md)",
        100 * loss, s.fluid.smoothing_ratio, 100 * least);
  }
  return "without solver.levels waves lose height and run too fast; for waves give "
         "solver: {iterations: 1, substeps: 7, levels: on} (configs/SETTINGS.md)";
}

/// Zones before the paddle take its own waves, and short ones reflect.
std::string sponge_text(const Scene& s, const WaveMaker& w) {
  std::vector<std::string> texts;
  for (const WaveSponge& zone : wave_sponges(s, w)) {
    if (zone.from < 0.5 * w.length())
      texts.push_back(
          fmt::format("the zone {} of damping {}, closer than half a wavelength ({:.3g} m), and "
                      "takes the waves "
                      "as they are made; move it to the far end",
                      zone.name,
                      zone.from < 0 ? std::string("reaches behind it")
                                    : fmt::format("begins {:.3g} m before it", zone.from),
                      0.5 * w.length()));
    else if (zone.lengths < 0.5)
      texts.push_back(fmt::format(
          "the zone {} of damping has {:.2g} of a wavelength and reflects about {:.1g} of the "
          "height; half a wavelength ({:.3g} m) is the least, a whole one is better",
          zone.name, zone.lengths, zone.reflection, 0.5 * w.length()));
  }
  return joined(texts, "\n");
}

/// Whether something other than a wall may end the waves.
bool has_end(const Scene& s) {
  return !s.damping.empty() || std::ranges::any_of(s.obstacles, [](const Obstacle& o) {
    return !o.motion && (std::holds_alternative<obstacle_keys::Plane>(o.shape) || o.surface_file());
  });
}

std::string returns_text(const Scene& s, const WaveMaker& w) {
  const double back = w.arrival(2 * w.ahead) - s.time.motion_begin;
  if (back >= s.time.end || !s.domain.has_wall(int(w.axis), w.sign > 0) || has_end(s)) return "";
  return fmt::format(
      "the first wave is back at the paddle at {:.3g} s, and time.end is {:g} s; give "
      "a slope or a sponge (damping) at the far end, a longer tank, or an earlier end",
      back, s.time.end);
}

}  // namespace

std::vector<Warning> wave_warnings(const Scene& s) {
  std::vector<Warning> list{{"wave_breaks", ""}, {"wave_theory", ""},   {"wave_resolution", ""},
                            {"wave_step", ""},   {"wave_settings", ""}, {"wave_returns", ""},
                            {"wave_sponge", ""}};
  for (std::size_t k = 0; k < s.obstacles.size(); ++k) {
    const Obstacle& o = s.obstacles[k];
    if (!o.motion || !makes_waves(*o.motion)) continue;
    const WaveMaker w = wave_maker(s, o);
    const auto add = [&](std::size_t at, const std::string& text) {
      std::string& all = list[at].text;
      if (!text.empty()) all += (all.empty() ? "" : "\n") + named(s, k) + ": " + text;
    };
    add(0, breaks_text(w, *o.motion));
    add(1, theory_text(w, *o.motion));
    add(2, resolution_text(w, s.fluid.spacing));
    add(3, step_text_of(w, s.time.step));
    if (list[4].text.empty()) add(4, settings_text(s, w));
    add(5, returns_text(s, w));
    add(6, sponge_text(s, w));
  }
  return list;
}

}  // namespace pbf::run_module
