// The table of a study as text, and all of it as JSON.
#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "lib/base/version.h"
#include "lib/campaign/study_table.h"

namespace pbf::campaign_module {
namespace {

std::vector<std::string> variants_of(const std::vector<StudyRow>& rows) {
  std::vector<std::string> names;
  for (const StudyRow& row : rows)
    if (std::ranges::find(names, row.member->variant) == names.end())
      names.push_back(row.member->variant);
  return names;
}

std::string setting(const StudyRow& row) {
  return row.member->label + " on " + row.result.backend + " " + row.result.precision;
}

bool is_share(const std::string& measure) {
  return measure.rfind("compression", 0) == 0 || measure.rfind("share", 0) == 0 ||
         measure.rfind("energy", 0) == 0 || measure.rfind("height", 0) == 0;
}

std::string error_text(const std::string& measure, double value) {
  if (std::isnan(value)) return "-";
  return is_share(measure) ? fmt::format("{:.3g} %", 100 * value) : fmt::format("{:.3g}", value);
}

/// "cheapest setting for compression_mean <= 1 %: ...", then the same per variant with the factor
/// to the first variant that gets there.
std::string cheapest_text(const Study& study, const std::vector<StudyRow>& rows, double target) {
  std::string out =
      fmt::format("cheapest setting for {} <= {}: ", study.error, error_text(study.error, target));
  const StudyRow* best = cheapest(study, rows, target, "");
  if (!best) return out + "none of these\n";
  const auto seconds = [](const StudyRow& r) {
    return fmt::format("{:.4g} s (spread {:.2g} s)", r.result.seconds_median(),
                       r.result.seconds_spread());
  };
  out += fmt::format("{}, {}, {}\n", setting(*best), seconds(*best),
                     error_text(study.error, measure_of(study, *best, study.error)));
  if (!study.has_variants) return out;
  const StudyRow* first = nullptr;
  for (const std::string& name : variants_of(rows)) {
    const StudyRow* row = cheapest(study, rows, target, name);
    out += fmt::format("  {:24} ", name);
    if (!row) {
      out += "does not get there\n";
      continue;
    }
    out += setting(*row) + ", " + seconds(*row);
    if (first)
      out += fmt::format(", {:.3g} times the time of {}",
                         row->result.seconds_median() / first->result.seconds_median(),
                         first->member->variant);
    else
      first = row;
    out += "\n";
  }
  return out;
}

}  // namespace

std::string study_text(const Study& study, const std::vector<StudyRow>& rows) {
  using R = const StudyRow&;
  const auto share = [&](const char* name) {
    return [&study, name](R r) -> Cell {
      const double v = measure_of(study, r, name);
      return std::isnan(v) ? Cell() : Cell(fmt::format("{:.3g} %", 100 * v));
    };
  };
  std::vector<Column<StudyRow>> columns{
      {"  setting", [](R r) { return (r.pareto ? "* " : "  ") + setting(r); }, -9},
      {"particles",
       [](R r) { return r.status == "unavailable" ? Cell() : Cell(r.result.particles); }, 9},
      {"seconds", [](R r) { return known(r.result.seconds_median()); }, 12, "{:.4g}"},
      {"spread", [](R r) { return known(r.result.seconds_spread()); }, 10, "{:.2g}"},
      {"compr.mean", share("compression_mean"), 11},
      {"compr.max", share("compression_max"), 11},
      {"energy rise", share("energy_rise"), 11},
      {"height kept", [&](R r) { return known(measure_of(study, r, "height_kept")); }, 11,
       "{:.4f}"}};
  if (study.error != "compression_mean")
    columns.push_back({study.error, [&](R r) {
                         return error_text(study.error, measure_of(study, r, study.error));
                       }});
  const auto note = [](R r) {
    const char* colon = r.status == "unavailable" ? ": " : " ";
    return r.status == "finished" ? "" : " " + r.status + colon + r.message;
  };
  columns.push_back({"", note, -1});
  std::string out = TableOf<StudyRow>(columns, rows).text();
  out += "* on the Pareto front of seconds and " + study.error + "\n";
  for (const double target : study.targets) out += cheapest_text(study, rows, target);
  if (study.front)
    for (const StudyRow& row : rows)
      for (std::size_t k = 0; k < study.front->data.size() && !row.front.empty(); ++k) {
        std::size_t points = 0;
        const FrontData& data = study.front->data[k];
        const double rms = front_deviation(row.front[0], data, &points);
        out += fmt::format("front of {} against {}: RMS {:.3g} over {} of {} points\n",
                           setting(row), data.name, rms, points, data.T.size());
      }
  out.pop_back();
  return out;
}

std::string study_json(const Study& study, const std::vector<StudyRow>& rows) {
  const BuildInfo build = build_info();
  Json best = Json::array();
  for (const double target : study.targets) {
    Json& item = best.emplace_back(Json{{"target", target}});
    if (const StudyRow* row = cheapest(study, rows, target, "")) {
      item["setting"] = setting(*row);
      item["seconds"] = row->result.seconds_median();
    }
  }
  const Json out{{"study", study.name},
                 {"error", study.error},
                 {"version", build.version},
                 {"commit", build.commit},
                 {"rows", study_table(study, rows).json()},
                 {"cheapest", best}};
  return json_text(out, 1) + "\n";
}

}  // namespace pbf::campaign_module
