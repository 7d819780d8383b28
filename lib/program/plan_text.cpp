// The plan as text and as JSON.
#include <cmath>
#include <nlohmann/json.hpp>

#include "lib/base/json.h"
#include "lib/base/text.h"
#include "lib/program/axes.h"
#include "lib/program/plan.h"
#include "lib/program/schedule.h"
#include "lib/program/substep_lists.h"
#include "lib/program/threads.h"

namespace pbf::inline program_module {
namespace {

std::string backend_text(const Scene& s) {
  return std::string(word(s.backend)) + " " + word(s.precision);
}

/// f(scene, memory) for every backend and precision.
template <class F>
void for_each_choice(const Plan& plan, const Scene& scene, F&& f) {
  for (const Backend backend : all_of<Backend>())
    for (const Precision precision : all_of<Precision>()) {
      Scene choice = scene;
      choice.backend = backend;
      choice.precision = precision;
      f(choice, plan_memory(choice, plan));
    }
}

std::string peak_text(std::int64_t arrays, std::int64_t fixed) {
  return format("%.2f + %.0f MB", double(arrays) / 1e6, double(fixed) / 1e6);
}

/// One object per backend and precision, with its arrays.
Json memory_json(const Plan& plan, const Scene& scene) {
  Json out = Json::array();
  const auto place = [](bool on_device) { return on_device ? "device" : "host"; };
  for_each_choice(plan, scene, [&](const Scene& s, const MemoryPlan& m) {
    Json fixed = Json::array(), arrays = Json::array();
    for (const FixedMemory& f : m.fixed)
      fixed.push_back({{"name", f.name}, {"bytes", f.bytes}, {"place", place(f.on_device)}});
    for (const PlanArray& a : m.arrays)
      arrays.push_back({{"name", a.name},
                        {"type", a.type},
                        {"components", a.components},
                        {"elements", a.elements},
                        {"bytes", a.bytes},
                        {"held", held_name(a.held)},
                        {"place", place(a.on_device)}});
    out.push_back({{"backend", word(s.backend)},
                   {"precision", word(s.precision)},
                   {"solver_bytes", m.solver_bytes()},
                   {"host_arrays", m.host_arrays},
                   {"host_fixed", m.fixed_bytes(false)},
                   {"host_peak", m.host_peak()},
                   {"device_arrays", m.device_arrays},
                   {"device_fixed", m.fixed_bytes(true)},
                   {"device_peak", m.device_peak()},
                   {"fixed", fixed},
                   {"arrays", arrays}});
  });
  return out;
}

/// ", dt sqrt(g/h) = 0.029"; empty without gravity.
std::string relative_step_text(const Scene& s) {
  const double g = std::hypot(s.gravity[0], s.gravity[1], s.gravity[2]);
  return g > 0 ? format(", dt sqrt(g/h) = %.3g", s.time.step * std::sqrt(g / s.h()))
               : std::string();
}

}  // namespace

std::string plan_text(const Plan& plan, const Scene& s) {
  std::string out = format("scene %s: %lld particles, h = %g m, d = %g m, %s\n", s.name.c_str(),
                           static_cast<long long>(plan.particles), s.h(), s.fluid.spacing,
                           backend_text(s).c_str());
  out += format(
      "grid %d (half) x %d x %d cells of edge %g h; internal axes x, y, z: %s of the scene\n",
      plan.cells[0], plan.cells[1], plan.cells[2], plan.cell_edge, axes_text(plan.axes).c_str());
  out += format("step %.6g s%s\n", s.time.step, relative_step_text(s).c_str());
  if (!about(s.backend).on_device) out += threads_text(s, plan.particles) + "\n";
  if (const StartCrowd crowd = start_crowd(s, plan); crowd.neighbors > 0)
    out += format("start: about %.0f neighbours of a particle, at rest %.0f%s\n", crowd.neighbors,
                  rest_neighbors(s),
                  crowd.decides ? "; they decide the size of the lists, and fluid that crowds more "
                                  "later takes more"
                                : "");
  out += plan.finest_level == 0
             ? "passes of one update\n"
             : format("passes of one step; 2^k of them in an update at level k = 0 ... %d\n",
                      plan.finest_level);
  for (const auto& [p, times] : count_passes(plan.program))
    out += format("  %-22s x%-3d stage %-10s reads %-34s writes %s", p->name, times, p->stage,
                  field_names(p->reads).c_str(), field_names(p->writes).c_str()) +
           (p->gathers == 0 ? "\n" : "; of neighbours " + gathers_text(*p) + "\n");
  if (plan.substeps > 1)
    out += format("  %d substeps of %.4g s on %d list%s: at most %.3g h of way on one list\n",
                  plan.substeps, s.time.step / plan.substeps, plan.lists_per_update,
                  plan.lists_per_update == 1 ? "" : "s", way_per_update(s) / plan.lists_per_update);
  out += format("arrays, %s\n", backend_text(s).c_str());
  for (const PlanArray& a : plan.memory.arrays)
    out += format("  %-33s %2d x %-6s  %-6s  %-6s %11.3f MB %8.1f B/particle\n", a.name.c_str(),
                  a.components, a.type.c_str(), held_name(a.held), a.on_device ? "device" : "host",
                  double(a.bytes) / 1e6, double(a.bytes) / double(plan.particles));
  out += format("  %-33s %30s %11.3f MB %8.1f B/particle\n", "held by the solver", "",
                double(plan.bytes()) / 1e6, double(plan.bytes()) / double(plan.particles));
  out += "fixed memory\n";
  for (const FixedMemory& f : plan.memory.fixed)
    out += format("  %-33s %s %.0f MB\n", f.name.c_str(), f.on_device ? "device" : "host",
                  double(f.bytes) / 1e6);
  out += "peak memory: arrays + fixed\n";
  for_each_choice(plan, s, [&](const Scene& choice, const MemoryPlan& m) {
    out += format("  %-14s host %s", backend_text(choice).c_str(),
                  peak_text(m.host_arrays, m.fixed_bytes(false)).c_str());
    if (m.device_peak() > 0) out += "   device " + peak_text(m.device_arrays, m.fixed_bytes(true));
    out += "\n";
  });
  out += "files\n";
  for (const PlanFile& f : plan.files)
    out += format("  %-22s %6lld x %9.3f MB", f.name.c_str(), static_cast<long long>(f.number),
                  double(f.bytes) / double(f.number) / 1e6) +
           (f.note.empty() ? "\n" : "  (" + f.note + ")\n");
  for (const std::string& note : rounded_times(s)) out += "  " + note + "\n";
  out += "left out\n";
  for (const auto& l : plan.left_out) out += "  " + l.what + ": " + l.because + "\n";
  return out;
}

Json plan_json(const Plan& plan, const Scene& s) {
  Json axes = Json::array(), passes = Json::array(), files = Json::array(), left = Json::array();
  for (const int axis : plan.axes.of) axes.push_back(std::string(1, char('x' + axis)));
  for (const PassCount& c : count_passes(plan.program))
    passes.push_back({{"name", c.pass->name},
                      {"stage", c.pass->stage},
                      {"reads", field_names(c.pass->reads)},
                      {"writes", field_names(c.pass->writes)},
                      {"gathers", gathers_text(*c.pass)},
                      {"per_update", c.times}});
  for (const PlanFile& f : plan.files)
    files.push_back({{"name", f.name}, {"number", f.number}, {"bytes", f.bytes}});
  for (const LeftOut& l : plan.left_out) left.push_back({{"what", l.what}, {"because", l.because}});
  return {{"scene", s.name},
          {"particles", plan.particles},
          {"bytes", plan.bytes()},
          {"cells", {plan.cells[0], plan.cells[1], plan.cells[2]}},
          {"cell_edge_h", plan.cell_edge},
          {"vol", plan.vol},
          {"wall_scale", plan.wall_scale},
          {"wall_range_h", plan.wall_range},
          {"mass_kg", plan.mass},
          {"axes", axes},
          {"finest_level", plan.finest_level},
          {"lists_per_update", plan.lists_per_update},
          {"threads", about(s.backend).on_device ? 0 : solver_threads(s, plan.particles)},
          {"passes", passes},
          {"memory", memory_json(plan, s)},
          {"files", files},
          {"left_out", left}};
}

}  // namespace pbf::inline program_module
