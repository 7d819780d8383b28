// The totals of a plan, and the plan as text.
#include <fmt/core.h>
#include <algorithm>

#include "lib/base/text.h"
#include "lib/program/axes.h"
#include "lib/program/body_mass.h"
#include "lib/program/free_bodies.h"
#include "lib/program/numbers.h"
#include "lib/program/plan.h"
#include "lib/program/relaxation.h"
#include "lib/program/schedule.h"
#include "lib/program/settings_row.h"
#include "lib/program/settling.h"
#include "lib/program/substep_lists.h"
#include "lib/program/threads.h"
#include "lib/program/wave_plan.h"
#include "lib/scene/auto_step.h"

namespace pbf::program_module {
namespace {

double mib(std::int64_t bytes) { return double(bytes) / 1048576; }

std::string backend_text(Backend backend, Precision precision) {
  return std::string(word(backend)) + " " + word(precision);
}

std::string time_line(const Plan& plan, const Scene& s, const PlanTotals& totals) {
  std::string out =
      fmt::format("{:.6g} s in {} updates of {:.6g} s", totals.end, totals.updates, s.time.step);
  if (totals.settling > 0)
    out += fmt::format(" after {} updates in which the start settles", totals.settling);
  if (plan.finest_level > 0) out += fmt::format(", each of 1 to {} steps", 1 << plan.finest_level);
  if (const double step = relative_step(s); step > 0)
    out += fmt::format("; dt sqrt(g/h) = {:.3g} (time.step: auto takes {:g} at most)", step,
                       kSafeStep);
  return out;
}

std::string memory_line(const Plan& plan, const Scene& s, const PlanTotals& totals) {
  const bool on_device = about(s.backend).on_device;
  std::string out = "about " + bytes_text(double(totals.host_bytes)) + " on the host";
  if (on_device) out += ", " + bytes_text(double(totals.device_bytes)) + " on the device";
  out += std::string("; ") + word(s.backend) + " " + word(s.precision);
  return out + (on_device ? "" : ", " + threads_text(s, plan.particles));
}

/// The total and the files that contribute to it.
std::string disk_line(const Plan& plan, const PlanTotals& totals) {
  std::string parts;
  for (const PlanFile& f : plan.files)
    if (100 * f.bytes >= totals.disk_bytes)
      parts += (parts.empty() ? ": " : ", ") + f.name + " " + bytes_text(double(f.bytes)) +
               (f.number > 1     ? fmt::format(" ({} files)", f.number)
                : f.note.empty() ? std::string()
                                 : " (" + f.note + ")");
  return bytes_text(double(totals.disk_bytes)) + parts;
}

std::string files_part(const Plan& plan, const Scene& s) {
  std::string out = "files\n";
  for (const PlanFile& f : plan.files) {
    const std::string each = f.number > 1 ? fmt::format("  {} of ", f.number) +
                                                bytes_text(double(f.bytes) / double(f.number))
                                          : std::string();
    out += fmt::format("  {:33} {:>10}", f.name, bytes_text(double(f.bytes))) + each +
           (f.note.empty() ? "\n" : "  (" + f.note + ")\n");
  }
  for (const std::string& note : rounded_times(s)) out += "  " + note + "\n";
  return out;
}

/// "151 MiB = 46.5 in arrays + 105 fixed".
std::string peak_text(std::int64_t arrays, std::int64_t fixed) {
  return fmt::format("{:.0f} MiB = {:.1f} in arrays + {:.0f} fixed", mib(arrays + fixed),
                     mib(arrays), mib(fixed));
}

std::string memory_part(const Plan& plan, const Scene& s) {
  std::string out = "peak memory by backend and precision; fixed: the program and its libraries\n";
  for (const MemoryChoice& c : memory_choices(s, plan)) {
    const MemoryPlan& m = c.memory;
    out += fmt::format("  {:12}  host {}", backend_text(c.backend, c.precision),
                       peak_text(m.host_arrays, m.fixed_bytes(false)));
    if (m.device_peak() > 0) out += "; device " + peak_text(m.device_arrays, m.fixed_bytes(true));
    out += "\n";
  }
  return out;
}

/// What the viscosity is, beside that of the method.
std::string viscosity_line(const Plan& plan, const Scene& s) {
  if (plan.viscosity.sweeps == 0) return "";
  const double nu = kinematic_viscosity(s), own = kOwnViscosity * s.fluid.spacing;
  return fmt::format(
      "  viscosity {:.3g} m^2/s{}: {} sweep{} of factor {:.3g}; the method adds about {:.2g} m^2/s "
      "per m/s of the flow, which is more above {:.3g} m/s\n",
      nu, s.viscosity->kinematic ? "" : " with this time.step", plan.viscosity.sweeps,
      plan.viscosity.sweeps == 1 ? "" : "s", plan.viscosity.factor, own, nu / own);
}

/// The obstacles that the fluid moves.
std::string bodies_part(const Scene& s) {
  if (!has_free_bodies(s)) return "";
  const bool flat = s.dimensions == 2;
  std::string out = "obstacles that the fluid moves\n";
  for (const Obstacle& o : s.obstacles) {
    if (!o.free) continue;
    const BodyMass m = body_mass(s, o);
    out += fmt::format("  {}: {:.6g} {}, {:.6g} kg/m^3, the fluid has {:g}", o.name, m.mass,
                       flat ? "kg/m" : "kg", m.mass / m.volume, s.fluid.rest_density);
    if (!o.free->lock.empty()) out += "; locked: " + base_module::joined(o.free->lock, ", ");
    out += "\n";
  }
  return out;
}

std::string passes_part(const Plan& plan, const Scene& s) {
  std::string out =
      plan.finest_level == 0
          ? "passes of one update\n"
          : fmt::format("passes of one step; 2^k of them in an update at level k = 0 ... {}\n",
                        plan.finest_level);
  const auto add = [&](const std::vector<PassCount>& passes) {
    for (const auto& [p, times] : passes) {
      const std::string gathers = gathers_text(*p);
      out += fmt::format("  {:22} x{:<3} stage {:10} reads {:34} writes {}", p->name, times,
                         p->stage, reads_text(*p), writes_text(*p)) +
             (gathers.empty() ? "\n" : "; of neighbors " + gathers + "\n");
    }
  };
  add(count_passes(plan.program));
  if (s.solver.iterations > 0)
    out += fmt::format(
        "  omega {:.3g} in each iteration{}; safe up to {:.3g} with {} in a substep\n", plan.sor,
        s.solver.sor ? "" : " (solver.sor: auto)", sor_limit(s), s.solver.iterations);
  out += viscosity_line(plan, s);
  if (plan.substeps > 1)
    out += fmt::format(
        "  {} substeps of {:.4g} s on {} list{}: at most {:.3g} h of way on one list\n",
        plan.substeps, s.time.step / plan.substeps, plan.lists_per_update,
        plan.lists_per_update == 1 ? "" : "s", way_per_update(s) / plan.lists_per_update);
  if (plan.program.between_every > 0) {
    out += plan.program.between_every == 1
               ? "passes between updates\n"
               : fmt::format("passes after every {} updates\n", plan.program.between_every);
    add(count_passes(plan.program, plan.program.between));
  }
  return out;
}

std::string settings_line(const Scene& s) {
  const std::optional<SettingsRow> row = settings_row(s);
  return row ? fmt::format("settings for such scenes: \"{}\" of configs/SETTINGS.md ({})\n",
                           row->heading, row->because)
             : "";
}

std::string grid_part(const Plan& plan, const Scene& s) {
  std::string out = fmt::format(
      "grid {} (half) x {} x {} cells of edge {:g} h; internal axes x, y, z: {} of the scene\n",
      plan.cells[0], plan.cells[1], plan.cells[2], plan.cell_edge, axes_text(plan.axes));
  if (const DenseStart dense = dense_start(s, plan); dense.neighbors > 0)
    out +=
        fmt::format("start: about {:.0f} neighbors of a particle, at rest {:.0f}{}\n",
                    dense.neighbors, rest_neighbors(s),
                    dense.decides ? "; they decide the size of the lists, and fluid that is denser "
                                    "later takes more"
                                  : "");
  return out;
}

}  // namespace

PlanTotals plan_totals(const Plan& plan, const Scene& s) {
  PlanTotals out;
  out.updates = make_schedule(s).updates;
  out.settling = settling_updates(s);
  out.end = double(out.updates) * s.time.step;
  out.host_bytes = plan.memory.host_peak();
  out.device_bytes = plan.memory.device_peak();
  for (const PlanFile& f : plan.files) out.disk_bytes += f.bytes;
  return out;
}

std::string plan_summary(const Plan& plan, const Scene& s, const std::string& run_time) {
  const PlanTotals totals = plan_totals(plan, s);
  const std::string most =
      comes_and_goes(s) ? fmt::format(" at the start, at most {}", plan.most_particles()) : "";
  std::string out =
      fmt::format("scene {}: {} particles{}, spacing d = {:g} m, smoothing length h = {:g} m\n",
                  s.name, plan.particles, most, s.fluid.spacing, s.h());
  out += "  time      " + time_line(plan, s, totals) + "\n";
  if (!run_time.empty()) out += "  run time  " + run_time + "\n";
  out += "  memory    " + memory_line(plan, s, totals) + "\n";
  return out + "  disk      " + disk_line(plan, totals) + "\n";
}

std::string plan_details(const Plan& plan, const Scene& s) {
  std::string out = settings_line(s) + wave_part(s) + numbers_part(s) + emission_text(s, plan) +
                    bodies_part(s) + files_part(plan, s) + memory_part(plan, s) +
                    passes_part(plan, s) + grid_part(plan, s);
  out += "left out\n";
  for (const auto& l : plan.left_out) out += "  " + l.what + ": " + l.because + "\n";
  return out;
}

std::string plan_arrays(const Plan& plan, const Scene& s) {
  std::string out = "arrays, " + backend_text(s.backend, s.precision) + "\n";
  const auto add = [&](const char* name, const std::string& what, std::int64_t bytes) {
    out += fmt::format("  {:35} {:30} {:11.3f} MiB {:8.1f} B/particle\n", name, what, mib(bytes),
                       double(bytes) / double(plan.particles));
  };
  for (const PlanArray& a : plan.memory.arrays)
    add(a.name.c_str(),
        fmt::format("{:3} x {:6}  {:6}  {:6}", a.components, a.type, kHeldNames[int(a.held)],
                    a.on_device ? "device" : "host"),
        a.bytes);
  add("held by the solver", "", plan.bytes());
  out += "fixed memory\n";
  for (const FixedMemory& f : plan.memory.fixed)
    out += fmt::format("  {:35} {:6} {:.0f} MiB\n", f.name, f.on_device ? "device" : "host",
                       mib(f.bytes));
  return out;
}

std::string plan_text(const Plan& plan, const Scene& s) {
  return plan_summary(plan, s, "") + plan_details(plan, s) + plan_arrays(plan, s);
}

}  // namespace pbf::program_module
