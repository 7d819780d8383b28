#include "lib/run/run_report.h"

#include <cmath>

#include "kernels/relative_motion.h"
#include "lib/base/machine.h"
#include "lib/base/stages.h"
#include "lib/base/text.h"
#include "lib/solver/diagnostics.h"

namespace pbf::inline run_module {
namespace {

double percent(double part, double whole) { return whole > 0 ? 100 * part / whole : 0; }

std::string row(const std::string& name, double seconds, double wall) {
  return format("  %-28s %10.3f s  %5.1f %%\n", name.c_str(), seconds, percent(seconds, wall));
}

double booked(const RunTotals& t) {
  double sum = 0;
  for (const auto& s : t.stages) sum += s.seconds;
  return sum;
}

/// Nothing when the scene does not define the measure.
std::string pool_line(const Measures& m) {
  if (std::isnan(m.height_kept)) return {};
  return format(
      "height kept         %.4f of the depth at rest, deviation from hydrostatic %.2g %% (both for "
      "a pool at rest)\n",
      m.height_kept, 100 * m.hydrostatic_deviation);
}

/// Changes of the step, and how long it was.
std::string step_lines(const RunTotals& t) {
  const StepHistory& s = *t.steps;
  double updates = 0, steps = 0, shortest = t.step;
  std::string shares;
  for (std::size_t k = 0; k < s.updates.size(); ++k) {
    if (s.updates[k] == 0) continue;
    shortest = std::ldexp(t.step, -int(k));
    updates += double(s.updates[k]);
    steps += std::ldexp(double(s.updates[k]), int(k));
    shares += format("%s%.4g s in %.3g %%", shares.empty() ? "" : ", ", shortest,
                     percent(double(s.updates[k]), double(t.updates)));
  }
  std::string out =
      format("time step           %lld changes, shortest %.4g s, mean %.4g s\n",
             static_cast<long long>(s.changes), shortest, steps > 0 ? t.step * updates / steps : 0);
  if (s.changes > 0) out += "                    " + shares + " of the updates\n";
  if (s.repeats > 0)
    out += format("                    %lld times back to the last good state\n",
                  static_cast<long long>(s.repeats));
  if (s.floor > 0)
    out += format("                    %lld measures asked for less than time.adaptive.step_min\n",
                  static_cast<long long>(s.floor));
  return out;
}

}  // namespace

std::string stage_table(const RunTotals& t) {
  std::string out = "time per stage\n";
  for (const auto& s : t.stages)
    out += row(s.name + (s.name == "lambda" && t.fused ? " (with the density)" : ""), s.seconds,
               t.wall);
  out += row("other", t.wall - booked(t), t.wall);
  out += row("total", t.wall, t.wall);
  if (t.render_thread > 0)
    out += format("  drawing took %.3f s on a thread of its own, beside the stages above\n",
                  t.render_thread);
  return out;
}

std::string group_table(const RunTotals& t) {
  std::string out = "time per group of stages\n";
  double rest = t.wall;
  for (std::size_t g = 0; g < std::size(kStageGroupNames); ++g) {
    double sum = 0;
    for (const Stage& stage : kStages)
      for (const auto& s : t.stages)
        if (static_cast<std::size_t>(stage.group) == g && s.name == stage.name) sum += s.seconds;
    rest -= sum;
    std::string name = kStageGroupNames[g];
    if (t.fused && name == "densities") name += " (in lambdas)";
    out += row(name, sum, t.wall);
  }
  return out + row("other", rest, t.wall);
}

std::string run_summary(const RunTotals& t) {
  std::string out = format(
      "particles           %lld\n"
      "updates             %lld  (%.6g s simulated)\n"
      "wall time           %s  (%s in updates and output)\n"
      "speed               %s particle-updates/s\n"
      "compression         mean %.3g %%, RMS %.3g %%, 99th percentile %.3g %%, max %.3g %% at the "
      "end; max %.3g %% over the run\n"
      "                    above 1 %%: %.3g %% of the particles, above 10 %%: %.3g %%\n"
      "energy              %.6g J at the end (kinetic %.3g J), %.6g J at the start: drift %+.3g "
      "%%, "
      "largest rise %.3g %%\n"
      "peak memory         %s\n",
      static_cast<long long>(t.particles), static_cast<long long>(t.updates), t.simulated,
      duration_text(t.wall).c_str(), duration_text(t.loop).c_str(),
      t.loop > 0
          ? si_number(double(t.particles) * double(t.updates - t.first_update) / t.loop).c_str()
          : "0",
      100 * t.last.compression_mean, 100 * t.last.compression_rms, 100 * t.last.compression_p99,
      100 * t.last.compression_max, 100 * t.compression_max, 100 * t.last.share_above_1,
      100 * t.last.share_above_10, t.last.energy, t.last.kinetic_energy, t.first.energy,
      100 * t.last.energy_drift, 100 * t.last.energy_rise,
      bytes_text(double(peak_memory())).c_str());
  out += pool_line(t.last);
  if (t.last.non_finite > 0)
    out += format("not finite          %lld particles at the end, left out of the figures above\n",
                  static_cast<long long>(t.last.non_finite));
  if (t.tolerance > 0)
    out += format(
        "sweeps              %.3g per substep on average, at most %d, for a tolerance of %.4g %%\n",
        double(t.last.sweeps) / (double(t.updates) * t.substeps), t.max_sweeps, 100 * t.tolerance);
  if (t.last.unresolved > 0)
    out += format("fast past neighbours %lld times more than %g h in a step, at most %.3g h\n",
                  static_cast<long long>(t.last.unresolved), kResolvedWay, t.last.relative_way_max);
  if (t.steps) out += step_lines(t);
  if (t.speed_limit > 0)
    out += format("speed limit         %lld times a particle was slowed down to %.4g m/s\n",
                  static_cast<long long>(t.last.fast), t.speed_limit);
  out += stage_table(t) + group_table(t);
  out += "files in            " + t.folder;
  if (t.frames > 0)
    out += format("\n  run.vtkhdf        %lld frames, %s", static_cast<long long>(t.frames),
                  bytes_text(double(t.bytes)).c_str());
  if (t.pictures > 0)
    out += format("\n  frames/           %lld pictures", static_cast<long long>(t.pictures));
  return out;
}

std::string measure_json(const Measures& m, double wall, std::int64_t frames,
                         const std::vector<StageTime>& stages) {
  const auto item = [](const char* name, double value) {
    return json_string(name) + ": " + json_number(value);
  };
  std::string out = "{";  // appended to: GCC 12 warns of overlap when a literal comes first
  out += item("update", double(m.update)) + ", " + item("time", m.time) + ", " +
         item("wall", wall) + ", " + item("frames", double(frames));
  const std::vector<Diagnostic>& all = diagnostics();
  for (std::size_t k = 0; k < all.size(); ++k) {
    const std::string name = all[k].name;
    if (!name.ends_with("_x")) {
      (out += ", ") += item(name.c_str(), all[k].value(m));
      continue;
    }
    out += ", " + json_string(name.substr(0, name.size() - 2)) + ": [";  // the vector's three rows
    for (std::size_t a = 0; a < 3; ++a) (out += a ? ", " : "") += json_number(all[k + a].value(m));
    out += "]";
    k += 2;
  }
  out += ", \"stages\": {";
  for (std::size_t i = 0; i < stages.size(); ++i) {
    if (i > 0) out += ", ";
    out += item(stages[i].name.c_str(), stages[i].seconds);
  }
  return out + "}}";
}

}  // namespace pbf::inline run_module
