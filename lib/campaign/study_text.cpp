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

/// " J"; nothing for a number alone.
std::string unit_after(const MotionError& e) { return e.unit == "1" ? "" : " " + e.unit; }

bool is_share(const std::string& measure) {
  const auto begins = [&](const char* with) { return measure.rfind(with, 0) == 0; };
  return begins("compression") || begins("share") || begins("energy_") || begins("height");
}

/// With its unit.
std::string error_text(const Study& study, const std::string& measure, double value) {
  if (std::isnan(value)) return "-";
  for (const MotionError& e : study.motion) {
    if (measure == e.relative()) return fmt::format("{:.3g} %", 100 * value);
    if (measure == e.rms()) return fmt::format("{:.3g}{}", value, unit_after(e));
  }
  return is_share(measure) ? fmt::format("{:.3g} %", 100 * value) : fmt::format("{:.3g}", value);
}

bool is_of_motion(const Study& study, const std::string& measure) {
  return std::ranges::find(study.motion, measure, &MotionError::relative) != study.motion.end();
}

/// The table of an error of motion.
std::string motion_text(const Study& study, const std::vector<StudyRow>& rows, std::size_t error) {
  using R = const StudyRow&;
  const MotionError& e = study.motion[error];
  const std::vector<bool> front = pareto_front(study, rows, e.relative());
  const auto difference = [error](R r) { return r.motion[error].difference; };
  std::optional<SeriesDifference> any;
  for (R r : rows)
    if (!any) any = difference(r);
  const auto note = [error, difference](R r) {
    std::string text = r.motion[error].note;
    if (const auto d = difference(r); d && d->interpolated > 0)
      text += fmt::format("{}{} of {} points between readings", text.empty() ? "" : "; ",
                          d->interpolated, d->points);
    return " " + text;
  };
  const std::vector<Column<StudyRow>> columns{
      {"  setting",
       [&](R r) { return (front[std::size_t(&r - rows.data())] ? "* " : "  ") + setting_of(r); },
       -9},
      {"seconds", [](R r) { return known(r.result.seconds_median()); }, 12, "{:.4g}"},
      {"RMS" + (e.unit == "1" ? "" : ", " + e.unit),
       [&](R r) { return known(difference(r) ? difference(r)->rms : NAN); }, 12, "{:.3g}"},
      {"of range",
       [&](R r) -> Cell {
         const auto d = difference(r);
         if (!d || !d->rms_relative) return {};
         return error_text(study, e.relative(), *d->rms_relative);
       },
       10},
      {"order", [error](R r) { return known(r.motion[error].order.value_or(NAN)); }, 7, "{:.2f}"},
      {"", note, -1}};
  return fmt::format("{}: difference from {}, from {:g} s on{}\n", e.column,
                     study.reference_member ? study.reference->label : "the reference", study.from,
                     any ? fmt::format("; range {:.4g}{}, {} points", any->range, unit_after(e),
                                       any->points)
                         : "") +
         TableOf<StudyRow>(columns, rows).text();
}

/// "cheapest setting for compression_mean <= 1 %: ...", then the same per variant with the factor
/// to the first variant that gets there.
std::string cheapest_text(const Study& study, const std::vector<StudyRow>& rows,
                          const std::string& error, double target) {
  std::string out =
      fmt::format("cheapest setting for {} <= {}: ", error, error_text(study, error, target));
  const StudyRow* best = cheapest(study, rows, error, target, "");
  if (!best) return out + "none of these\n";
  const auto seconds = [](const StudyRow& r) {
    return fmt::format("{:.4g} s (spread {:.2g} s)", r.result.seconds_median(),
                       r.result.seconds_spread());
  };
  out += fmt::format("{}, {}, {}\n", setting_of(*best), seconds(*best),
                     error_text(study, error, measure_of(study, *best, error)));
  if (!study.has_variants) return out;
  const StudyRow* first = nullptr;
  for (const std::string& name : variants_of(rows)) {
    const StudyRow* row = cheapest(study, rows, error, target, name);
    out += fmt::format("  {:24} ", name);
    if (!row) {
      out += "does not get there\n";
      continue;
    }
    out += setting_of(*row) + ", " + seconds(*row);
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

std::string setting_of(const StudyRow& row) {
  return row.member->label + " on " + row.result.backend + " " + row.result.precision;
}

std::string study_text(const Study& study, const std::vector<StudyRow>& rows) {
  using R = const StudyRow&;
  const auto share = [&](const char* name) {
    return [&study, name](R r) -> Cell {
      const double v = measure_of(study, r, name);
      return std::isnan(v) ? Cell() : Cell(fmt::format("{:.3g} %", 100 * v));
    };
  };
  std::vector<Column<StudyRow>> columns{
      {"  setting", [](R r) { return (r.pareto ? "* " : "  ") + setting_of(r); }, -9},
      {"particles",
       [](R r) { return r.status == "unavailable" ? Cell() : Cell(r.result.particles); }, 9},
      {"seconds", [](R r) { return known(r.result.seconds_median()); }, 12, "{:.4g}"},
      {"spread", [](R r) { return known(r.result.seconds_spread()); }, 10, "{:.2g}"},
      {"compr.mean", share("compression_mean"), 11},
      {"compr.max", share("compression_max"), 11},
      {"energy rise", share("energy_rise"), 11},
      {"height kept", [&](R r) { return known(measure_of(study, r, "height_kept")); }, 11,
       "{:.4f}"}};
  for (const std::string& error : study.errors)
    if (error != "compression_mean" && !is_of_motion(study, error))
      columns.push_back(
          {error, [&](R r) { return error_text(study, error, measure_of(study, r, error)); }});
  const auto note = [](R r) {
    const char* colon = r.status == "unavailable" ? ": " : " ";
    return r.status == "finished" ? "" : " " + r.status + colon + r.message;
  };
  columns.push_back({"", note, -1});
  std::string out = TableOf<StudyRow>(columns, rows).text();
  out += "* on the Pareto front of seconds and " + study.errors[0] + "\n";
  for (std::size_t k = 0; k < study.motion.size(); ++k) out += motion_text(study, rows, k);
  if (!study.motion.empty()) out += "* on the Pareto front of seconds and this RMS\n";
  for (const std::string& error : study.errors)
    for (const double target : study.targets) out += cheapest_text(study, rows, error, target);
  if (study.front)
    for (const StudyRow& row : rows)
      for (std::size_t k = 0; k < study.front->data.size() && !row.front.empty(); ++k) {
        std::size_t points = 0;
        const FrontData& data = study.front->data[k];
        const double rms = front_deviation(row.front[0], data, &points);
        out += fmt::format("front of {} against {}: RMS {:.3g} over {} of {} points\n",
                           setting_of(row), data.name, rms, points, data.T.size());
      }
  out.pop_back();
  return out;
}

std::string study_json(const Study& study, const std::vector<StudyRow>& rows) {
  const BuildInfo build = build_info();
  Json best = Json::array();
  for (const std::string& error : study.errors)
    for (const double target : study.targets) {
      Json& item = best.emplace_back(Json{{"error", error}, {"target", target}});
      if (const StudyRow* row = cheapest(study, rows, error, target, "")) {
        item["setting"] = setting_of(*row);
        item["seconds"] = row->result.seconds_median();
      }
    }
  Json motion = Json::array();
  for (std::size_t k = 0; k < study.motion.size(); ++k)
    motion.push_back({{"column", study.motion[k].column},
                      {"unit", study.motion[k].unit},
                      {"reference", study.reference->label},
                      {"rows", motion_table(rows, k).json()}});
  const Json out{{"study", study.name},
                 {"error", study.errors[0]},
                 {"version", build.version},
                 {"commit", build.commit},
                 {"rows", study_table(study, rows).json()},
                 {"motion", motion},
                 {"cheapest", best}};
  return json_text(out, 1) + "\n";
}

}  // namespace pbf::campaign_module
