// A study's table for people, and all of it as JSON.
#include <algorithm>
#include <cmath>

#include "lib/base/text.h"
#include "lib/base/version.h"
#include "lib/campaign/study_table.h"

namespace pbf::inline campaign_module {
namespace {

std::vector<std::string> variants_of(const std::vector<StudyRow>& rows) {
  std::vector<std::string> names;
  for (const StudyRow& row : rows)
    if (std::find(names.begin(), names.end(), row.member->variant) == names.end())
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
  return is_share(measure) ? format("%.3g %%", 100 * value) : format("%.3g", value);
}

/// "cheapest setting for compression_mean <= 1 %: ...", then the same per variant with the factor
/// to the first variant that gets there.
std::string cheapest_text(const Study& study, const std::vector<StudyRow>& rows, double target) {
  std::string out = format("cheapest setting for %s <= %s: ", study.error.c_str(),
                           error_text(study.error, target).c_str());
  const StudyRow* best = cheapest(study, rows, target, "");
  if (!best) return out + "none of these\n";
  const auto seconds = [](const StudyRow& r) {
    return format("%.4g s (spread %.2g s)", r.result.seconds_median(), r.result.seconds_spread());
  };
  out += setting(*best) + ", " + seconds(*best) + ", " +
         error_text(study.error, measure_of(study, *best, study.error)) + "\n";
  if (!study.has_variants) return out;
  const StudyRow* first = nullptr;
  for (const std::string& name : variants_of(rows)) {
    const StudyRow* row = cheapest(study, rows, target, name);
    out += format("  %-24s ", name.c_str());
    if (!row) {
      out += "does not get there\n";
      continue;
    }
    out += setting(*row) + ", " + seconds(*row);
    if (first)
      out += format(", %.3g times the time of %s",
                    row->result.seconds_median() / first->result.seconds_median(),
                    first->member->variant.c_str());
    else
      first = row;
    out += "\n";
  }
  return out;
}

}  // namespace

std::string study_text(const Study& study, const std::vector<StudyRow>& rows) {
  std::size_t width = 7;
  for (const StudyRow& row : rows) width = std::max(width, setting(row).size());
  const int w = int(width);
  const bool other = study.error != "compression_mean";
  std::string out =
      format("  %-*s %9s %12s %10s %11s %11s %11s %11s", w, "setting", "particles", "seconds",
             "spread", "compr.mean", "compr.max", "energy rise", "height kept");
  if (other) out += " " + study.error;
  out += "\n";
  for (const StudyRow& row : rows) {
    const auto share = [&](const char* name) {
      const double v = measure_of(study, row, name);
      return std::isnan(v) ? std::string("-") : format("%.3g %%", 100 * v);
    };
    out += format("%c %-*s ", row.pareto ? '*' : ' ', w, setting(row).c_str());
    if (row.status == "unavailable") {
      out += row.status + ": " + row.message + "\n";
      continue;
    }
    const double height = measure_of(study, row, "height_kept");
    out += format("%9lld %12.4g %10.2g %11s %11s %11s %11s",
                  static_cast<long long>(row.result.particles), row.result.seconds_median(),
                  row.result.seconds_spread(), share("compression_mean").c_str(),
                  share("compression_max").c_str(), share("energy_rise").c_str(),
                  std::isnan(height) ? "-" : format("%.4f", height).c_str());
    if (other)
      out += format(" %*s", int(study.error.size()),
                    error_text(study.error, measure_of(study, row, study.error)).c_str());
    if (row.status != "finished") out += "  " + row.status + " " + row.message;
    out += "\n";
  }
  out += "* on the Pareto front of seconds and " + study.error + "\n";
  for (const double target : study.targets) out += cheapest_text(study, rows, target);
  if (study.front)
    for (const StudyRow& row : rows)
      for (std::size_t k = 0; k < study.front->data.size() && !row.front.empty(); ++k) {
        std::size_t points = 0;
        const FrontData& data = study.front->data[k];
        const double rms = front_deviation(row.front[0], data, &points);
        out += format("front of %s against %s: RMS %.3g over %zu of %zu points\n",
                      setting(row).c_str(), data.name.c_str(), rms, points, data.T.size());
      }
  out.pop_back();
  return out;
}

std::string study_json(const Study& study, const std::vector<StudyRow>& rows) {
  const BuildInfo build = build_info();
  JsonObject object;
  object.add("study", study.name).add("error", study.error);
  object.add("version", build.version).add("commit", build.commit);
  object.add_json("rows", study_table(study, rows).json());
  std::vector<std::string> best;
  for (const double target : study.targets) {
    JsonObject item;
    item.add("target", target);
    const StudyRow* row = cheapest(study, rows, target, "");
    if (row) item.add("setting", setting(*row)).add("seconds", row->result.seconds_median());
    best.push_back(item.text());
  }
  object.add_json("cheapest", json_array(best));
  return object.text() + "\n";
}

}  // namespace pbf::inline campaign_module
