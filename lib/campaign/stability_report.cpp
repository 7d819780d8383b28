// Results of the stability suite and of stability maps as text, tables and JUnit XML.
#include <fmt/core.h>

#include "lib/campaign/stability_map.h"
#include "lib/io/junit.h"

namespace pbf::campaign_module {
namespace {

std::string cut(const std::string& text, std::size_t width) {
  std::string line = text.substr(0, text.find('\n'));
  return line.size() <= width ? line : line.substr(0, width - 3) + "...";
}

}  // namespace

std::string stability_text(const StabilityRow& r) {
  // The criterion nearest to its limit, as a share of the limit.
  const std::string margin =
      r.used > 0 ? fmt::format("{:>3.0f} % of {}", 100 * r.used, r.tightest) : std::string();
  return fmt::format("{:24} {:4}  {:16} must  {}\n{:>49} {}", r.name, r.good ? "ok" : "FAIL",
                     margin, r.must, "did ", cut(r.happened, 150));
}

Table stability_table(const std::vector<StabilityRow>& rows, const StabilityOptions& o) {
  using R = const StabilityRow&;
  return TableOf<StabilityRow>({{"case", [](R r) { return r.name; }},
                                {"group", [](R r) { return r.group; }},
                                {"backend", [&](R) { return word(o.backend); }},
                                {"precision", [&](R) { return word(o.precision); }},
                                {"size", [&](R) { return o.reduced ? "reduced" : "full"; }},
                                {"particles", [](R r) { return r.particles; }},
                                {"updates", [](R r) { return r.updates; }},
                                {"dt_hat", [](R r) { return r.dt_hat; }},
                                {"verdict", [](R r) { return r.good ? "ok" : "fail"; }},
                                {"used", [](R r) { return r.used; }},
                                {"tightest", [](R r) { return r.tightest; }},
                                {"must", [](R r) { return r.must; }},
                                {"happened", [](R r) { return r.happened; }},
                                {"speed_max", [](R r) { return r.speed_max; }},
                                {"energy_rise", [](R r) { return r.energy_rise; }},
                                {"compression_mean", [](R r) { return r.compression_mean; }},
                                {"compression_max", [](R r) { return r.compression_max; }},
                                {"nearest", [](R r) { return r.nearest; }},
                                {"slowed_down", [](R r) { return r.fast; }},
                                {"seconds", [](R r) { return r.seconds; }}},
                               rows);
}

Table map_table(const std::vector<MapCell>& cells, const StabilityMap& map) {
  using C = const MapCell&;
  return TableOf<MapCell>({{"scene", [](C c) { return c.scene; }},
                           {"backend", [&](C) { return word(map.run.backend); }},
                           {"precision", [&](C) { return word(map.run.precision); }},
                           {"x_key", [&](C) { return map.x_key; }},
                           {"y_key", [&](C) { return map.y_key; }},
                           {"x", [](C c) { return c.x; }},
                           {"y", [](C c) { return c.y; }},
                           {"iterations", [](C c) { return c.iterations; }},
                           {"class", [](C c) { return kMapClassNames[int(c.verdict)]; }},
                           {"dt_hat", [](C c) { return c.dt_hat; }},
                           {"compression_mean", [](C c) { return c.compression_mean; }},
                           {"compression_max", [](C c) { return c.compression_max; }},
                           {"energy_rise", [](C c) { return c.energy_rise; }},
                           {"stopped_for", [](C c) { return c.stopped_for; }}},
                          cells);
}

std::string stability_junit(const std::vector<StabilityRow>& rows, const StabilityOptions& o,
                            double seconds) {
  JunitSuite suite{"pbf stability",
                   {{"backend", word(o.backend)},
                    {"precision", word(o.precision)},
                    {"size", o.reduced ? "reduced" : "full"}},
                   {},
                   seconds};
  for (const StabilityRow& r : rows)
    suite.cases.push_back({r.group, r.name, r.seconds, r.good ? "" : cut(r.happened, 150),
                           "must " + r.must + "\ndid " + r.happened});
  return junit_xml(suite);
}

}  // namespace pbf::campaign_module
