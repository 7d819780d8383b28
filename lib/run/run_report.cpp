// The reports of a run: its summary, and one line of JSON per measurement.
#include <fmt/core.h>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "kernels/relative_motion.h"
#include "lib/base/json.h"
#include "lib/base/machine.h"
#include "lib/base/stages.h"
#include "lib/base/text.h"
#include "lib/run/report_lines.h"
#include "lib/run/run.h"
#include "lib/scene/vector3.h"
#include "lib/solver/diagnostics.h"

namespace pbf::run_module {
namespace {

constexpr double kAtRest = 1e-3;  // kinetic energy, as a share of a resting pool's energy

/// Whether the fluid has come to rest: it hardly moves, and had time to settle.
bool has_come_to_rest(const Diagnostics& m, const Scene& s, double mass) {
  const double at_rest = (m.energy - m.kinetic_energy) / m.height_kept;  // M g H0/2, J
  const double g = length(s.gravity), depth = 2 * at_rest / (mass * g);
  return m.kinetic_energy < kAtRest * at_rest && m.time > 2 * std::sqrt(depth / g);
}

/// Empty if the scene does not define this measurement or the fluid still moves.
std::string pool_line(const Diagnostics& m, const Scene& s, double mass) {
  if (std::isnan(m.height_kept) || !has_come_to_rest(m, s, mass)) return {};
  return fmt::format(
      "pool at rest        height {:.4f} of what its volume gives, 1 is right; pressure {:.2g} % "
      "off the hydrostatic one, 0 is right\n",
      m.height_kept, 100 * m.hydrostatic_deviation);
}

/// Number of changes of the step, and its lengths.
std::string step_lines(const StepHistory& s, double step, std::int64_t all) {
  double updates = 0, steps = 0, shortest = step;
  std::string shares;
  for (std::size_t k = 0; k < s.updates.size(); ++k) {
    if (s.updates[k] == 0) continue;
    shortest = std::ldexp(step, -int(k));
    updates += double(s.updates[k]);
    steps += std::ldexp(double(s.updates[k]), int(k));
    shares += fmt::format("{}{:.4g} s in {:.3g} %", shares.empty() ? "" : ", ", shortest,
                          percent(double(s.updates[k]), double(all)));
  }
  std::string out =
      fmt::format("time step           {} changes, shortest {:.4g} s, mean {:.4g} s\n", s.changes,
                  shortest, steps > 0 ? step * updates / steps : 0);
  if (s.changes > 0) out += "                    " + shares + " of the updates\n";
  if (s.repeats > 0)
    out += fmt::format("                    {} times back to the last good state after an alarm\n",
                       s.repeats);
  if (s.floor > 0)
    out += fmt::format(
        "                    {} measures asked for less than time.adaptive.step_min\n", s.floor);
  return out;
}

/// "grid 1.107, neighbors 3.849": the stages of a group with their seconds. Adds them to `sum`.
std::string stages_of(StageGroup group, const std::vector<StageTime>& stages, double& sum) {
  std::vector<std::string> parts;
  for (const Stage& stage : kStages)
    for (const StageTime& s : stages)
      if (stage.group == group && s.name == stage.name) {
        sum += s.seconds;
        parts.push_back(fmt::format("{} {:.3f}", s.name, s.seconds));
      }
  return joined(parts, ", ");
}

/// Seconds per group of stages, and per stage.
std::string time_table(const std::vector<StageTime>& stages, double wall, bool fused) {
  std::string out = "time                        seconds  of the wall time, and by stage\n";
  const auto row = [&](const char* name, double seconds, const std::string& of) {
    out += fmt::format("  {:25} {:8.3f}  {:5.1f} %{}{}\n", name, seconds, percent(seconds, wall),
                       of.empty() ? "" : "  ", of);
  };
  double rest = wall;
  for (std::size_t g = 0; g < std::size(kStageGroups); ++g) {
    const auto group = static_cast<StageGroup>(g);
    double sum = 0;
    std::string of = stages_of(group, stages, sum);
    if (fused && group == StageGroup::density) of = "in lambda, in one loop";
    if (group == StageGroup::exchange && sum == 0) continue;  // on one rank
    row(kStageGroups[g].name, sum, of);
    rest -= sum;
  }
  row("other", rest, "");
  row("total", wall, "");
  return out;
}

/// The error of the run, and which values are good.
std::string error_lines(const Diagnostics& last, double max_of_run) {
  return fmt::format(
      "compression         of the fluid beyond its rest density, the error of the run: a mean "
      "below 1 % is good\n"
      "  at the end        mean {:.3g} %, RMS {:.3g} %, largest {:.3g} %; 99 % of the particles "
      "below {:.3g} %\n"
      "                    {:.3g} % of the particles above 1 %, {:.3g} % above 10 %\n"
      "  over the run      largest {:.3g} %\n",
      100 * last.compression_mean, 100 * last.compression_rms, 100 * last.compression_max,
      100 * last.compression_p99, 100 * last.share_above_1, 100 * last.share_above_10,
      100 * max_of_run);
}

/// Below this share of the energy, a loss is rounding.
constexpr double kRounding = 1e-6;

/// What took the energy that is gone, in shares of it. Empty if none is gone.
std::string lost_line(const Diagnostics& first, const Diagnostics& last,
                      const std::vector<ReadingColumn>& columns) {
  const double lost = first.energy + last.work - last.energy;
  if (!(lost > kRounding * (std::fabs(first.energy) + std::fabs(last.work)))) return {};
  std::string parts;
  double rest = lost;
  if (last.readings.empty() && !columns.empty()) return {};  // resumed, and nothing was left to do
  for_each_number(columns, Series::measures, [&](const ReadingColumn& c, int, std::size_t k) {
    if (c.kind != std::string_view("dissipation")) return;
    const double taken = last.readings[k];
    rest -= taken;
    parts += fmt::format("{:.3g} % by {}, ", 100 * taken / lost, c.of);
  });
  const std::string others =
      rest >= 0
          ? fmt::format("{:.3g} % in splashes and by the length of the steps", 100 * rest / lost)
          : fmt::format("less {:.3g} % that the method has added", -100 * rest / lost);
  return fmt::format("  lost              {:.4g} J: {}{}\n", lost, parts, others);
}

/// Below this share of the energy at rest, the packing of the particles says as much about what is
/// above it as the motion does.
constexpr double kAboveRest = 0.01;

/// How much of the energy above rest, and of the work put in, is left. at_rest: energy_at_rest().
/// Empty where there is none.
std::string kept_line(const Diagnostics& first, const Diagnostics& last, double at_rest) {
  const double given = first.energy - at_rest + last.work, left = last.energy - at_rest;
  if (!(given > kAboveRest * at_rest)) return {};
  return fmt::format("  kept              {:.3g} % of {:.4g} J above the energy at rest{}\n",
                     100 * left / given, given, last.moved ? ", work included" : "");
}

std::string energy_lines(const Diagnostics& first, const Diagnostics& last, const Plan& plan,
                         double at_rest) {
  std::string out = fmt::format(
      "energy              {:.6g} J at the start, {:.6g} J at the end ({:.3g} J of it kinetic)",
      first.energy, last.energy, last.kinetic_energy);
  if (std::isfinite(at_rest)) out += fmt::format(", {:.6g} J at rest on the floor", at_rest);
  out += "\n";
  if (last.moved)
    out += fmt::format("  work              {:.6g} J of what moves{}{}\n", last.work,
                       last.bodies.empty() ? " by itself" : ", free bodies too",
                       last.inflow != 0 ? ", and of what came and went" : "");
  const std::string kept = kept_line(first, last, at_rest);
  out += kept;
  // Relative to the start's energy, the loss of a driven tank says nothing.
  if (kept.empty() || !last.moved)
    out +=
        fmt::format("  drift             {:+.3g} % from start to end\n", 100 * last.energy_drift);
  return out + lost_line(first, last, plan.columns) +
         fmt::format(
             "  largest rise      {:.3g} % at any time: 0 is good, above {:g} % the "
             "method adds energy\n",
             100 * last.energy_rise, 100 * kAddsEnergy);
}

/// Updates and wall time: of the run and, if it was resumed, of this session.
std::string progress_lines(const RunParts& run, double wall) {
  const std::int64_t updates = run.solver.updates(), before = run.from.update();
  const std::string loop =
      duration_text(run.loop_seconds) + " of it from the first update to the last, with output";
  std::string out = fmt::format("updates             {} ({:.6g} s simulated)", updates,
                                double(updates) * run.scene.time.step);
  if (before == 0)
    return fmt::format("{}\nwall time           {}, {}\n", out, duration_text(wall), loop);
  out += fmt::format(
      ", {} of them in this session, which went on from update {}\n"
      "wall time           {} in this session, {}",
      updates - before, before, duration_text(wall), loop);
  if (const auto& earlier = run.from.earlier)
    out += fmt::format("\n                    {} {} in all {} sessions",
                       earlier->whole ? "about" : "at least",
                       duration_text(wall + earlier->seconds), earlier->sessions + 1);
  return out + "\n";
}

/// Nine digits, which distinguish any two floats.
double short_number(double value) {
  return std::strtod(fmt::format("{:.9g}", value).c_str(), nullptr);
}

}  // namespace

std::string run_summary(const RunParts& run, const Monitor& monitor,
                        const std::vector<StageTime>& stages) {
  const Scene& scene = run.scene;
  const Plan& plan = run.plan;
  const Diagnostics &first = monitor.first(), &last = monitor.last();
  const std::int64_t updates = run.solver.updates();
  const double wall = run.control.wall.seconds(), loop = run.loop_seconds;
  const auto own = double(updates - run.from.update());
  std::string out = fmt::format("particles           {}\n", plan.particles);
  if (comes_and_goes(scene))
    out = fmt::format("particles           {} at the start, {} at the end\n", plan.particles,
                      last.particles) +
          emission_lines(last, plan.columns);
  out += body_lines(last, scene) + progress_lines(run, wall);
  out += fmt::format("speed               {} particle-updates/s in these {}\n",
                     si_number(loop > 0 ? double(plan.particles) * own / loop : 0),
                     duration_text(loop));
  out += error_lines(last, run.compression_max) + energy_lines(first, last, plan, run.at_rest);
  out += "peak memory         " + bytes_text(double(peak_memory())) + " on the host\n";
  out += pool_line(last, scene, plan.mass * double(plan.particles));
  if (last.non_finite > 0)
    out +=
        fmt::format("not finite          {} particles at the end, left out of the figures above\n",
                    last.non_finite);
  if (!run.compared.empty())
    out += "compared with measurements (run, data)\n" + comparisons_text(run.compared);
  if (plan.tolerance > 0)
    out += fmt::format(
        "iterations          {:.3g} per substep on average, at most {}, for a tolerance of {:.4g} "
        "%\n",
        double(last.iterations_done) / (double(updates) * plan.substeps),
        scene.solver.iterations * (1 + plan.repeats), 100 * plan.tolerance);
  if (last.unresolved > 0)
    out += fmt::format(
        "fast fluid          {} times a particle moved by more than {:g} h past a neighbor in one "
        "step, at most by {:.3g} h;\n"
        "                    harmless while rare, else fluid may pass through fluid\n",
        last.unresolved, kResolvedWay, last.relative_way_max);
  if (const auto steps = monitor.steps(updates))
    out += step_lines(*steps, scene.time.step, updates);
  if (scene.solver.speed_limit > 0)
    out += fmt::format("speed limit         {} times a particle was slowed down to {:.4g} m/s\n",
                       last.fast, scene.solver.speed_limit * scene.h() / scene.time.step);
  out += time_table(stages, wall, scene.solver.fused);
  if (run.drawing_seconds > 0)
    out += fmt::format(
        "  drawing took {:.3f} s on a thread beside the run; render, above, is how long the run "
        "waited for it\n",
        run.drawing_seconds);
  out += "files in            " + run.folder.path();
  if (run.frames_written > 0)
    out += fmt::format("\n  run.vtkhdf        {} frames, {}", run.frames_written,
                       bytes_text(double(run.bytes)));
  if (run.pictures_drawn > 0)
    out += fmt::format("\n  frames/           {} pictures", run.pictures_drawn);
  return out;
}

std::string measure_json(const Diagnostics& m, double wall, std::int64_t frames,
                         const std::vector<StageTime>& stages,
                         const std::vector<ReadingColumn>& columns,
                         const std::vector<double>& poses) {
  Json out{{"update", m.update},
           {"time", short_number(m.time)},
           {"wall", short_number(wall)},
           {"frames", frames}};
  for (const Diagnostic& d : diagnostics()) {
    const std::string name = d.name;
    const Json value = d.number ? Json(short_number(d.number(m))) : Json(d.integer(m));
    if (name.ends_with("_x") || name.ends_with("_y") || name.ends_with("_z"))
      out[name.substr(0, name.size() - 2)].push_back(value);  // next component of the vector
    else
      out[name] = value;
  }
  const auto add = [&](Series series, const std::vector<double>& readings) {
    for_each_number(columns, series, [&](const ReadingColumn& c, int component, std::size_t k) {
      out[c.kind + std::string("s")][c.of][number_name(c, component)] = short_number(readings[k]);
    });
  };
  add(Series::measures, m.readings);
  add(Series::poses, poses);
  Json& times = out["stages"] = Json::object();
  for (const StageTime& s : stages) times[s.name] = short_number(s.seconds);
  return json_text(out);
}

}  // namespace pbf::run_module
