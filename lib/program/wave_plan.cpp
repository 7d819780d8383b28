#include "lib/program/wave_plan.h"

#include <fmt/core.h>
#include <algorithm>
#include <nlohmann/json.hpp>

#include "lib/scene/sponge_waves.h"

namespace pbf::program_module {
namespace {

const char* word_of(MotionKind kind) {
  switch (kind) {
    case MotionKind::regular_waves:
      return "regular";
    case MotionKind::irregular_waves:
      return "irregular";
    case MotionKind::solitary_waves:
      return "solitary";
    default:
      return "focused";
  }
}

/// m, from end to end of the motion at still water throughout the run.
double stroke_of(const Scene& s, const WaveMaker& w) {
  if (w.lines.size() == 1 || w.second) return 2 * w.gain * w.lines[0].stroke;
  double low = 0, high = 0;
  for (double t = 0; t <= s.time.end; t += w.shortest / 16) {
    const double x = w.paddle(s.time.motion_begin + t);
    low = std::min(low, x), high = std::max(high, x);
  }
  return high - low;
}

std::string waves_of(const Scene& s, const Obstacle& o) {
  const auto& m = *o.motion;
  const WaveMaker w = wave_maker(s, o);
  const double d = s.fluid.spacing;
  const char* size = m.kind == MotionKind::irregular_waves ? "Hs" : "H";
  const char* time =
      m.kind == MotionKind::irregular_waves || m.kind == MotionKind::focused_waves ? "Tp" : "T";
  std::string out =
      fmt::format("waves {}: {}, {}", o.name, word_of(m.kind), w.flap ? "flap" : "piston");
  if (m.kind == MotionKind::regular_waves) out += w.second ? ", second order" : ", first order";
  out += fmt::format(": {} {:.4g} m, {} {:.4g} s, depth {:.4g} m\n", size, w.height, time, w.period,
                     w.depth);
  out += fmt::format(
      "  length {:.4g} m, kD {:.3g}, speed {:.3g} m/s, group {:.3g} m/s; breaks at {:.3g} m ({})",
      w.length(), w.kd(), w.speed, w.group, w.breaks_at(), w.by_mccowan() ? "McCowan" : "Miche");
  if (w.second) out += fmt::format("; Ursell {:.3g}, second order holds below 26.3", w.ursell());
  out += fmt::format("\n  stroke {:.3g} m", stroke_of(s, w));
  if (w.second)
    out += fmt::format(
        ", second harmonic {:.2g} m; with order 1 a free wave of {:.2g} of the first "
        "harmonic would run along",
        2 * w.gain * w.lines[1].stroke, w.free_share());
  if (!w.solitary.empty())
    out += fmt::format(" in {:.3g} s for the first wave", w.solitary[0].duration());
  if (!w.lines.empty() && m.kind != MotionKind::regular_waves)
    out += fmt::format("; {} lines from {:.3g} to {:.3g} Hz", w.lines.size(),
                       w.lines.front().omega / (2 * 3.14159265358979323846),
                       w.lines.back().omega / (2 * 3.14159265358979323846));
  if (m.kind == MotionKind::irregular_waves)
    out += fmt::format(", which repeat after {:.6g} s", repeat_of(s, m));
  out += fmt::format(
      "\n  {:.3g} particles per height, {:.3g} per wavelength, {:.3g} per depth; {:.4g} "
      "steps per period\n",
      w.height / d, w.length() / d, w.depth / d, w.period / s.time.step);
  if (const double loss = w.loss(d); loss > 0)
    out += fmt::format(
        "  expected loss of height: about {:.2g} % per wavelength (estimate, fitted to flumes in "
        "{} dimensions with levels: on and h = {} d)\n",
        100 * loss, w.dimensions == 2 ? "two" : "three",
        w.has_short_kernel() ? "2"
        : w.dimensions == 2  ? "3.5"
                             : "3");
  for (const WaveSponge& zone : wave_sponges(s, w))
    out += fmt::format(
        "  sponge {}: {:.2g} wavelengths, expected to reflect {:.1g} of the height (linear theory "
        "of long waves)\n",
        zone.name, zone.lengths, zone.reflection);
  return out + fmt::format("  the first wave is at the far end at {:.3g} s, and back at {:.3g} s\n",
                           w.arrival(w.ahead) - s.time.motion_begin,
                           w.arrival(2 * w.ahead) - s.time.motion_begin);
}

}  // namespace

std::string wave_part(const Scene& s) {
  std::string out;
  for (const Obstacle& o : s.obstacles)
    if (o.motion && makes_waves(*o.motion)) out += waves_of(s, o);
  return out;
}

Json wave_json(const Scene& s) {
  Json out = Json::array();
  for (const Obstacle& o : s.obstacles) {
    if (!o.motion || !makes_waves(*o.motion)) continue;
    const WaveMaker w = wave_maker(s, o);
    Json sponges = Json::array();
    for (const WaveSponge& zone : wave_sponges(s, w))
      sponges.push_back(
          {{"name", zone.name}, {"lengths", zone.lengths}, {"reflection", zone.reflection}});
    out.push_back({{"name", o.name},
                   {"kind", word_of(o.motion->kind)},
                   {"paddle", w.flap ? "flap" : "piston"},
                   {"height_m", w.height},
                   {"period_s", w.period},
                   {"depth_m", w.depth},
                   {"length_m", w.length()},
                   {"kd", w.kd()},
                   {"speed_m_per_s", w.speed},
                   {"group_m_per_s", w.group},
                   {"breaks_at_m", w.breaks_at()},
                   {"ursell", w.ursell()},
                   {"stroke_m", stroke_of(s, w)},
                   {"free_share", w.free_share()},
                   {"lines", w.lines.size()},
                   {"steps_per_period", w.period / s.time.step},
                   {"loss_per_length", w.loss(s.fluid.spacing)},
                   {"sponges", sponges},
                   {"at_end_s", w.arrival(w.ahead) - s.time.motion_begin},
                   {"back_s", w.arrival(2 * w.ahead) - s.time.motion_begin}});
  }
  return out;
}

}  // namespace pbf::program_module
