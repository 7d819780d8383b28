#include "lib/run/report_lines.h"

#include <fmt/core.h>

#include "lib/program/free_bodies.h"
#include "lib/scene/vector3.h"

namespace pbf::run_module {

std::string emission_lines(const Diagnostics& last, const std::vector<ReadingColumn>& columns) {
  std::string out, particles;
  if (last.readings.empty()) return {};  // resumed, and nothing was left to do
  for_each_number(columns, Series::measures, [&](const ReadingColumn& c, int, std::size_t k) {
    const std::string kind = c.kind, name = c.name;
    if (kind != "emitter" && kind != "sink") return;
    const double number = last.readings.at(k);
    if (name == "particles") particles = fmt::format("{:.0f}", number);
    if (name == "mass")
      out += fmt::format("  {:17} {} particles, {:.6g} kg{}\n", kind + " " + c.of, particles,
                         number, kind == "sink" ? " taken" : "");
  });
  return out;
}

std::string body_lines(const Diagnostics& last, const Scene& scene) {
  std::string out;
  const std::vector<std::string> names = names_of_bodies(scene);
  for (std::size_t k = 0; k < last.bodies.size(); ++k) {
    const BodyMotion& b = last.bodies[k];
    out += fmt::format("  {:17} at ({:.6g}, {:.6g}, {:.6g}) m, {:.3g} m/s, {:.3g} rad/s\n",
                       "body " + names.at(k), b.middle[0], b.middle[1], b.middle[2],
                       length(b.velocity), length(b.spin));
  }
  return out;
}

}  // namespace pbf::run_module
