#include "lib/run/run_report.h"

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "kernels/relative_motion.h"
#include "lib/base/json.h"
#include "lib/base/machine.h"
#include "lib/base/stages.h"
#include "lib/base/text.h"
#include "lib/run/run.h"
#include "lib/solver/diagnostics.h"

namespace pbf::inline run_module {
namespace {

std::string row(const std::string& name, double seconds, double wall) {
  return format("  %-28s %10.3f s  %5.1f %%\n", name.c_str(), seconds, percent(seconds, wall));
}

/// Nothing when the scene does not define the measure.
std::string pool_line(const Diagnostics& m) {
  if (std::isnan(m.height_kept)) return {};
  return format(
      "height kept         %.4f of the depth at rest, deviation from hydrostatic %.2g %% (both for "
      "a pool at rest)\n",
      m.height_kept, 100 * m.hydrostatic_deviation);
}

/// Changes of the step, and how long it was.
std::string step_lines(const StepHistory& s, double step, std::int64_t all) {
  double updates = 0, steps = 0, shortest = step;
  std::string shares;
  for (std::size_t k = 0; k < s.updates.size(); ++k) {
    if (s.updates[k] == 0) continue;
    shortest = std::ldexp(step, -int(k));
    updates += double(s.updates[k]);
    steps += std::ldexp(double(s.updates[k]), int(k));
    shares += format("%s%.4g s in %.3g %%", shares.empty() ? "" : ", ", shortest,
                     percent(double(s.updates[k]), double(all)));
  }
  std::string out = format("time step           %ld changes, shortest %.4g s, mean %.4g s\n",
                           s.changes, shortest, steps > 0 ? step * updates / steps : 0);
  if (s.changes > 0) out += "                    " + shares + " of the updates\n";
  if (s.repeats > 0)
    out += format("                    %ld times back to the last good state\n", s.repeats);
  if (s.floor > 0)
    out += format("                    %ld measures asked for less than time.adaptive.step_min\n",
                  s.floor);
  return out;
}

std::string stage_table(const std::vector<StageTime>& stages, double wall, bool fused) {
  std::string out = "time per stage\n";
  double rest = wall;
  for (const auto& s : stages) {
    out +=
        row(s.name + (s.name == "lambda" && fused ? " (with the density)" : ""), s.seconds, wall);
    rest -= s.seconds;
  }
  return out + row("other", rest, wall) + row("total", wall, wall);
}

/// The same folded into seven groups, initialization ... post-processing.
std::string group_table(const std::vector<StageTime>& stages, double wall, bool fused) {
  std::string out = "time per group of stages\n";
  double rest = wall;
  for (std::size_t g = 0; g < std::size(kStageGroupNames); ++g) {
    double sum = 0;
    for (const Stage& stage : kStages)
      for (const auto& s : stages)
        if (static_cast<std::size_t>(stage.group) == g && s.name == stage.name) sum += s.seconds;
    rest -= sum;
    std::string name = kStageGroupNames[g];
    if (fused && name == "densities") name += " (in lambdas)";
    out += row(name, sum, wall);
  }
  return out + row("other", rest, wall);
}

}  // namespace

std::string run_summary(const RunParts& run, const Watch& watch,
                        const std::vector<StageTime>& stages) {
  const Scene& scene = run.scene;
  const Plan& plan = run.plan;
  const Diagnostics &first = watch.first(), &last = watch.last();
  const std::int64_t updates = run.solver.updates();
  const double wall = run.wall.seconds(), loop = run.loop_seconds;
  std::string out = format(
      "particles           %ld\n"
      "updates             %ld  (%.6g s simulated)\n"
      "wall time           %s  (%s in updates and output)\n"
      "speed               %s particle-updates/s\n"
      "compression         mean %.3g %%, RMS %.3g %%, 99th percentile %.3g %%, max %.3g %% at the "
      "end; max %.3g %% over the run\n"
      "                    above 1 %%: %.3g %% of the particles, above 10 %%: %.3g %%\n"
      "energy              %.6g J at the end (kinetic %.3g J), %.6g J at the start: drift %+.3g "
      "%%, "
      "largest rise %.3g %%\n"
      "peak memory         %s\n",
      plan.particles, updates, double(updates) * scene.time.step, duration_text(wall).c_str(),
      duration_text(loop).c_str(),
      loop > 0
          ? si_number(double(plan.particles) * double(updates - run.from.update()) / loop).c_str()
          : "0",
      100 * last.compression_mean, 100 * last.compression_rms, 100 * last.compression_p99,
      100 * last.compression_max, 100 * run.compression_max, 100 * last.share_above_1,
      100 * last.share_above_10, last.energy, last.kinetic_energy, first.energy,
      100 * last.energy_drift, 100 * last.energy_rise, bytes_text(double(peak_memory())).c_str());
  if (last.moved)
    out += format(
        "work                %.6g J of what moves by itself; drift and rise are without it\n",
        last.work);
  out += pool_line(last);
  if (last.non_finite > 0)
    out += format("not finite          %ld particles at the end, left out of the figures above\n",
                  last.non_finite);
  if (plan.tolerance > 0)
    out += format(
        "iterations              %.3g per substep on average, at most %d, for a tolerance of %.4g "
        "%%\n",
        double(last.iterations_done) / (double(updates) * plan.substeps),
        scene.solver.iterations * (1 + plan.repeats), 100 * plan.tolerance);
  if (last.unresolved > 0)
    out += format("fast past neighbours %ld times more than %g h in a step, at most %.3g h\n",
                  last.unresolved, kResolvedWay, last.relative_way_max);
  if (const auto steps = watch.steps(updates)) out += step_lines(*steps, scene.time.step, updates);
  if (scene.solver.speed_limit > 0)
    out += format("speed limit         %ld times a particle was slowed down to %.4g m/s\n",
                  last.fast, scene.solver.speed_limit * scene.h() / scene.time.step);
  out += stage_table(stages, wall, scene.solver.fused);
  if (run.drawing_seconds > 0)
    out += format("  drawing took %.3f s on a thread of its own, beside the stages above\n",
                  run.drawing_seconds);
  out += group_table(stages, wall, scene.solver.fused);
  out += "files in            " + run.folder.path();
  if (run.frames_written > 0)
    out += format("\n  run.vtkhdf        %ld frames, %s", run.frames_written,
                  bytes_text(double(run.bytes)).c_str());
  if (run.pictures_drawn > 0)
    out += format("\n  frames/           %ld pictures", run.pictures_drawn);
  return out;
}

namespace {

/// With nine digits, which tell any two floats apart.
double short_number(double value) { return std::strtod(format("%.9g", value).c_str(), nullptr); }

}  // namespace

std::string measure_json(const Diagnostics& m, double wall, std::int64_t frames,
                         const std::vector<StageTime>& stages) {
  Json out{{"update", m.update},
           {"time", short_number(m.time)},
           {"wall", short_number(wall)},
           {"frames", frames}};
  for (const Diagnostic& d : diagnostics()) {
    const std::string name = d.name;
    const Json value = d.number ? Json(short_number(d.number(m))) : Json(d.integer(m));
    if (name.ends_with("_x") || name.ends_with("_y") || name.ends_with("_z"))
      out[name.substr(0, name.size() - 2)].push_back(value);  // the vector's next component
    else
      out[name] = value;
  }
  for (const WallLoad& l : m.loads)
    for (const LoadNumber& n : load_numbers())
      out["loads"][l.wall][n.name] = short_number(n.value(l));
  Json& times = out["stages"] = Json::object();
  for (const StageTime& s : stages) times[s.name] = short_number(s.seconds);
  return json_text(out);
}

}  // namespace pbf::inline run_module
