// The plan as text and as JSON.
#include "lib/base/text.h"
#include "lib/program/axes.h"
#include "lib/program/plan.h"
#include "lib/program/substep_lists.h"
#include "lib/program/threads.h"

namespace pbf::inline program_module {
namespace {

/// "[a,b,...]" from one string per element.
template <class Range, class F>
std::string list(const Range& range, F&& f) {
  std::string out = "[";
  for (const auto& e : range) {
    if (out.size() > 1) out += ',';
    out += f(e);
  }
  return out + "]";
}

std::string backend_text(const Scene& s) {
  return std::string(s.backend == Backend::cuda ? "cuda" : "cpu") +
         (s.precision == Precision::dbl ? " double" : " float");
}

/// f(scene, memory) for both backends and both precisions.
template <class F>
void for_each_choice(const Plan& plan, const Scene& scene, F&& f) {
  for (const Backend backend : {Backend::cpu, Backend::cuda})
    for (const Precision precision : {Precision::single, Precision::dbl}) {
      Scene choice = scene;
      choice.backend = backend;
      choice.precision = precision;
      f(choice, plan_memory(choice, plan));
    }
}

std::string peak_text(std::int64_t arrays, std::int64_t fixed) {
  return format("%.2f + %.0f MB", double(arrays) / 1e6, double(fixed) / 1e6);
}

std::string arrays_json(const MemoryPlan& memory) {
  return list(memory.arrays, [](const PlanArray& a) {
    return "{\"name\":" + json_string(a.name) + ",\"type\":" + json_string(a.type) +
           format(",\"components\":%d,\"elements\":%lld,\"bytes\":%lld", a.components,
                  static_cast<long long>(a.elements), static_cast<long long>(a.bytes)) +
           ",\"held\":" + json_string(held_name(a.held)) +
           ",\"place\":" + (a.on_device ? "\"device\"}" : "\"host\"}");
  });
}

/// One object per backend and precision, with its arrays.
std::string memory_json(const Plan& plan, const Scene& scene) {
  std::string out;
  for_each_choice(plan, scene, [&](const Scene& s, const MemoryPlan& m) {
    out += out.empty() ? "[" : ",";
    out += "{\"backend\":" + json_string(s.backend == Backend::cuda ? "cuda" : "cpu");
    out += ",\"precision\":" + json_string(s.precision == Precision::dbl ? "double" : "float");
    const auto number = [&](const char* name, std::int64_t value) {
      out += format(",\"%s\":%lld", name, static_cast<long long>(value));
    };
    number("solver_bytes", m.solver_bytes());
    number("host_arrays", m.host_arrays);
    number("host_fixed", m.fixed_bytes(false));
    number("host_peak", m.host_peak());
    number("device_arrays", m.device_arrays);
    number("device_fixed", m.fixed_bytes(true));
    number("device_peak", m.device_peak());
    out += ",\"fixed\":" + list(m.fixed, [](const FixedMemory& f) {
             return "{\"name\":" + json_string(f.name) +
                    format(",\"bytes\":%lld", static_cast<long long>(f.bytes)) +
                    ",\"place\":" + (f.on_device ? "\"device\"}" : "\"host\"}");
           });
    out += ",\"arrays\":" + arrays_json(m) + "}";
  });
  return out + "]";
}

}  // namespace

std::string plan_text(const Plan& plan, const Scene& s) {
  std::string out = format("scene %s: %lld particles, h = %g m, d = %g m, %s\n", s.name.c_str(),
                           static_cast<long long>(plan.particles), s.h(), s.fluid.spacing,
                           backend_text(s).c_str());
  out += format(
      "grid %d (half) x %d x %d cells of edge %g h; internal axes x, y, z: %s of the scene\n",
      plan.cells[0], plan.cells[1], plan.cells[2], plan.cell_edge, axes_text(plan.axes).c_str());
  if (s.backend == Backend::cpu) out += threads_text(s, plan.particles) + "\n";
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
  out += "left out\n";
  for (const auto& l : plan.left_out) out += "  " + l.what + ": " + l.because + "\n";
  return out;
}

std::string plan_json(const Plan& plan, const Scene& s, const std::string& members) {
  std::string out = "{\"scene\":" + json_string(s.name);
  out += format(",\"particles\":%lld,\"bytes\":%lld,\"cells\":[%d,%d,%d],\"cell_edge_h\":%.17g",
                static_cast<long long>(plan.particles), static_cast<long long>(plan.bytes()),
                plan.cells[0], plan.cells[1], plan.cells[2], plan.cell_edge);
  out += format(",\"vol\":%.17g,\"wall_scale\":%.17g,\"wall_range_h\":%.17g,\"mass_kg\":%.17g",
                plan.vol, plan.wall_scale, plan.wall_range, plan.mass);
  out += ",\"axes\":" +
         list(plan.axes.of, [](int axis) { return json_string(std::string(1, char('x' + axis))); });
  out += format(",\"finest_level\":%d,\"lists_per_update\":%d,\"threads\":%d", plan.finest_level,
                plan.lists_per_update,
                s.backend == Backend::cpu ? solver_threads(s, plan.particles) : 0);
  out += ",\"passes\":" + list(count_passes(plan.program), [](const PassCount& c) {
           return "{\"name\":" + json_string(c.pass->name) +
                  ",\"stage\":" + json_string(c.pass->stage) +
                  ",\"reads\":" + json_string(field_names(c.pass->reads)) +
                  ",\"writes\":" + json_string(field_names(c.pass->writes)) +
                  ",\"gathers\":" + json_string(gathers_text(*c.pass)) +
                  format(",\"per_update\":%d}", c.times);
         });
  out += ",\"memory\":" + memory_json(plan, s);
  out += ",\"files\":" + list(plan.files, [](const PlanFile& f) {
           return "{\"name\":" + json_string(f.name) +
                  format(",\"number\":%lld,\"bytes\":%lld}", static_cast<long long>(f.number),
                         static_cast<long long>(f.bytes));
         });
  out +=
      ",\"left_out\":" + list(plan.left_out, [](const LeftOut& l) {
        return "{\"what\":" + json_string(l.what) + ",\"because\":" + json_string(l.because) + "}";
      });
  return out + members + "}";
}

}  // namespace pbf::inline program_module
