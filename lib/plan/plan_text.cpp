// The plan as text and as JSON.
#include "lib/base/text.h"
#include "lib/plan/plan.h"

namespace pbf {
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

}  // namespace

std::string plan_text(const Plan& plan, const Scene& s) {
  std::string out = format("scene %s: %lld particles, h = %g m, d = %g m, %s, %s\n", s.name.c_str(),
                           static_cast<long long>(plan.particles), s.h(), s.fluid.spacing,
                           s.backend == Backend::cuda ? "cuda" : "cpu",
                           s.precision == Precision::dbl ? "double" : "float");
  out += format("grid %d (half) x %d x %d cells of edge %g h\n", plan.cells[0], plan.cells[1],
                plan.cells[2], plan.cell_edge);
  out += "passes of one update\n";
  for (const auto& p : plan.passes)
    out += format("  %-22s x%-3d stage %-10s reads %-34s writes %s\n", p.name.c_str(), p.per_update,
                  p.stage.c_str(), p.reads.c_str(), p.writes.c_str());
  out += "arrays\n";
  for (const auto& a : plan.arrays)
    out += format("  %-28s %-12s %8.1f B/particle %10.3f MB\n", a.name.c_str(), a.element.c_str(),
                  a.bytes_per_particle, double(a.bytes) / 1e6);
  out += format("  %-28s %-12s %8.1f B/particle %10.3f MB\n", "total", "",
                plan.particles ? double(plan.bytes()) / double(plan.particles) : 0.0,
                double(plan.bytes()) / 1e6);
  out += "files\n";
  for (const auto& f : plan.files) out += "  " + f + "\n";
  out += "left out\n";
  for (const auto& l : plan.left_out) out += "  " + l.what + ": " + l.because + "\n";
  return out;
}

std::string plan_json(const Plan& plan, const Scene& s) {
  std::string out = "{\"scene\":" + json_string(s.name);
  out += format(",\"particles\":%lld,\"bytes\":%lld,\"cells\":[%d,%d,%d],\"cell_edge_h\":%.17g",
                static_cast<long long>(plan.particles), static_cast<long long>(plan.bytes()),
                plan.cells[0], plan.cells[1], plan.cells[2], plan.cell_edge);
  out += format(",\"vol\":%.17g,\"wall_scale\":%.17g,\"wall_range_h\":%.17g,\"mass_kg\":%.17g",
                plan.vol, plan.wall_scale, plan.wall_range, plan.mass);
  out += ",\"passes\":" + list(plan.passes, [](const PlanPass& p) {
           return "{\"name\":" + json_string(p.name) + ",\"stage\":" + json_string(p.stage) +
                  ",\"reads\":" + json_string(p.reads) + ",\"writes\":" + json_string(p.writes) +
                  format(",\"per_update\":%d}", p.per_update);
         });
  out += ",\"arrays\":" + list(plan.arrays, [](const PlanArray& a) {
           return "{\"name\":" + json_string(a.name) + ",\"element\":" + json_string(a.element) +
                  format(",\"bytes_per_particle\":%g,\"bytes\":%lld}", a.bytes_per_particle,
                         static_cast<long long>(a.bytes));
         });
  out += ",\"files\":" + list(plan.files, [](const std::string& f) { return json_string(f); });
  out +=
      ",\"left_out\":" + list(plan.left_out, [](const PlanLeftOut& l) {
        return "{\"what\":" + json_string(l.what) + ",\"because\":" + json_string(l.because) + "}";
      });
  return out + "}";
}

}  // namespace pbf
