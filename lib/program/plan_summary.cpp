// The totals of a plan, and its five-line summary.
#include <fmt/core.h>
#include <algorithm>

#include "lib/base/text.h"
#include "lib/program/plan.h"
#include "lib/program/schedule.h"
#include "lib/program/threads.h"
#include "lib/scene/auto_step.h"

namespace pbf::program_module {
namespace {

std::string time_line(const Plan& plan, const Scene& s, const PlanTotals& totals) {
  std::string out =
      fmt::format("{:.6g} s in {} updates of {:.6g} s", totals.end, totals.updates, s.time.step);
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

}  // namespace

PlanTotals plan_totals(const Plan& plan, const Scene& s) {
  PlanTotals out;
  out.updates = make_schedule(s).updates;
  out.end = double(out.updates) * s.time.step;
  out.host_bytes = plan.memory.host_peak();
  out.device_bytes = plan.memory.device_peak();
  for (const PlanFile& f : plan.files) out.disk_bytes += f.bytes;
  return out;
}

std::string plan_summary(const Plan& plan, const Scene& s, const std::string& run_time) {
  const PlanTotals totals = plan_totals(plan, s);
  std::string out =
      fmt::format("scene {}: {} particles, spacing d = {:g} m, smoothing length h = {:g} m\n",
                  s.name, plan.particles, s.fluid.spacing, s.h());
  out += "  time      " + time_line(plan, s, totals) + "\n";
  if (!run_time.empty()) out += "  run time  " + run_time + "\n";
  out += "  memory    " + memory_line(plan, s, totals) + "\n";
  return out + "  disk      " + disk_line(plan, totals) + "\n";
}

}  // namespace pbf::program_module
