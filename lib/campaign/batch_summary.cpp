#include "lib/campaign/batch_summary.h"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <regex>
#include <set>
#include <utility>

#include "lib/base/error.h"
#include "lib/base/plain_text.h"
#include "lib/base/text.h"
#include "lib/base/version.h"
#include "lib/data/comparison.h"
#include "lib/data/summary.h"
#include "lib/io/run_file.h"
#include "lib/io/table.h"
#include "lib/scene/keys.h"
#include "lib/scene/load.h"
#include "lib/scene/number.h"
#include "lib/solver/diagnostics.h"

namespace pbf::campaign_module {
namespace {

/// Columns of a run's log whose last values are in the summary.
std::vector<std::string> last_values() {
  std::vector<std::string> names{"time", "update"};
  for (const Diagnostic& d : diagnostics())
    if (d.summary) names.push_back(d.name);
  return names;
}

std::map<std::string, std::string> units_of_results() {
  std::map<std::string, std::string> units{{"time", "s"}, {"seconds", "s"}};
  for (const Diagnostic& d : diagnostics()) units[d.name] = d.unit;
  return units;
}

/// Keys that the list and the grid set, in order of first appearance.
std::vector<std::string> set_keys(const std::vector<BatchMember>& members) {
  std::vector<std::string> keys;
  std::set<std::string> seen;
  for (const BatchMember& m : members)
    for (const std::string& o : m.overrides)
      if (const std::string key = o.substr(0, o.find('=')); seen.insert(key).second)
        keys.push_back(key);
  return keys;
}

/// The last setting of a key is used, as for --set.
Cell value_of(const BatchMember& m, const std::string& key) {
  Cell value;
  for (const std::string& o : m.overrides)
    if (o.compare(0, key.size() + 1, key + "=") == 0) {
      const std::string text = o.substr(key.size() + 1);
      double number = 0;
      value = read_number(text, number) == NumberError::none ? Cell{number} : Cell{text};
    }
  return value;
}

/// "bodies[0].velocity" and "bodies.0.velocity" mean bodies[].velocity, "gravity[2]" gravity.
std::string unit_of_key(const std::string& key) {
  static const std::regex index(R"((\.|\[)\d+\]?)"), last(R"(\[\]$)");
  std::string path = std::regex_replace(key, index, "[]");
  const Key* found = scene_table().find_key(path);
  if (!found) found = scene_table().find_key(std::regex_replace(path, last, ""));
  return found ? unit_text(*found) : "";
}

constexpr const char* kOfFile[] = {"particles", "frames", "warnings", "seconds"};

/// A column that not every run has.
struct NamedNumber {
  std::string name, unit;
  double value = 0;  ///< NaN: there is none
};

/// What a run file says: last measurements, numbers of particles, frames and warnings, seconds, as
/// empty cells if there is no file; gauges and loads; comparisons with measurements.
struct Results {
  std::vector<Cell> cells;
  std::vector<NamedNumber> readings, compared;
  bool named = false;     ///< its scene says which readings
  bool too_many = false;  ///< it does not, and they are too many
};

/// "compare/H2/rms"
std::vector<NamedNumber> compared_in(const RunReader& file) {
  std::vector<NamedNumber> all;
  for (const StoredComparison& c : file.comparisons()) {
    std::map<std::string, StoredComparison::Number> numbers;
    for (const StoredComparison::Number& n : c.numbers) numbers[n.name] = n;
    for (const std::string& name : comparison_numbers())
      if (numbers.contains(name))
        all.push_back({"compare/" + c.name + "/" + name, numbers[name].unit, numbers[name].value});
  }
  return all;
}

/// The scene of a member as it is now, or else that of its run; none: of an earlier version.
std::optional<Scene> scene_of(const SceneOfMember& now, const BatchMember& m,
                              const RunReader& file) {
  try {
    return now(m);
  } catch (const Error&) {
  }
  try {
    return parse_stored_scene(file.info().resolved_scene, m.name, {});
  } catch (const Error&) {
    return std::nullopt;
  }
}

/// Gauges and loads.
void read_readings(const RunReader& file, const std::optional<Scene>& scene, Results& out) {
  if (!scene) return;
  const std::vector<SummaryColumn> columns = wanted_summary_columns(*scene);
  const std::vector<double> values = summary_numbers(file, columns, scene->summary_from);
  for (std::size_t k = 0; k < columns.size(); ++k)
    out.readings.push_back({columns[k].name, columns[k].unit, values[k]});
  out.named = !scene->summary.empty();
  out.too_many = columns.empty() && !summary_columns(*scene).empty();
}

Results read_results(const BatchMember& m, const std::string& out_folder,
                     const SceneOfMember& now) {
  const std::string path = out_folder + "/" + m.name + "/" + kRunFile;
  const std::vector<std::string> names = last_values();
  Results out;
  std::vector<Cell>& cells = out.cells;
  cells.resize(names.size() + std::size(kOfFile));
  std::error_code error;
  if (std::filesystem::exists(path, error)) try {
      const RunReader file(path);
      std::map<std::string, std::vector<double>> log = file.log();
      for (std::size_t k = 0; k < names.size(); ++k)
        if (!log[names[k]].empty()) cells[k] = log[names[k]].back();
      const RunInfo info = file.info();
      cells[names.size()] = info.particles;
      cells[names.size() + 1] = file.frames();
      cells[names.size() + 2] = std::int64_t(info.warnings.size());
      double seconds = 0;
      for (const auto& [name, column] : log)
        if (name.starts_with("stage/"))
          for (const double s : column) seconds += s;
      cells.back() = seconds;
      out.compared = compared_in(file);
      read_readings(file, scene_of(now, m, file), out);
    } catch (const Error&) {
      cells.assign(cells.size(), Cell{});  // the message of the run tells what is wrong
    }
  return out;
}

/// Columns of all runs in the order of first appearance.
class NamedColumns {
 public:
  void take(const std::vector<NamedNumber>& numbers, bool without_number) {
    for (const NamedNumber& n : numbers)
      if ((without_number || !std::isnan(n.value)) && units_.try_emplace(n.name, n.unit).second)
        names_.push_back(n.name);
  }
  const std::vector<std::string>& names() const { return names_; }
  const std::map<std::string, std::string>& units() const { return units_; }
  void add(const std::vector<NamedNumber>& numbers, std::vector<Cell>& row) const {
    std::map<std::string, double> values;
    for (const NamedNumber& n : numbers) values[n.name] = n.value;
    for (const std::string& name : names_)
      row.push_back(values.contains(name) ? known(values[name]) : Cell{});
  }

 private:
  std::vector<std::string> names_;
  std::map<std::string, std::string> units_;
};

/// Those of gauges and loads: where all would be too many, of the runs that name theirs.
NamedColumns reading_columns_of(const std::vector<Results>& results, bool& too_many) {
  NamedColumns all, named;
  for (const Results& r : results) {
    all.take(r.readings, true);
    if (r.named) named.take(r.readings, true);
  }
  too_many = all.names().size() > kMostSummaryColumns && named.names().size() < all.names().size();
  return too_many ? named : all;
}

}  // namespace

std::string exit_reason(int code) {
  static const std::map<int, std::string> kReasons{
      {-1, "waiting"},
      {int(ExitCode::done), "finished"},
      {int(ExitCode::bad_input), "bad input"},
      {int(ExitCode::guard), "diverged"},
      {int(ExitCode::unavailable), "unavailable"},
      {int(ExitCode::io), "file error"},
      {int(ExitCode::difference), "warned"},  // --strict
      {int(ExitCode::resumable), "stopped"}};
  if (code > 128) return "killed by signal " + std::to_string(code - 128);
  const auto known = kReasons.find(code);
  return known == kReasons.end() ? "internal error" : known->second;
}

BatchSummary batch_summary(const std::vector<BatchMember>& members,
                           const std::map<std::string, JobEnd>& ends, const std::string& out,
                           const SceneOfMember& scene_now) {
  const std::vector<std::string> keys = set_keys(members);
  std::vector<std::string> columns{"name", "scene", "settings", "exit_code", "reason", "message"};
  const std::vector<std::string> names = last_values();
  columns.insert(columns.end(), names.begin(), names.end());
  columns.insert(columns.end(), std::begin(kOfFile), std::end(kOfFile));
  std::map<std::string, std::string> units = units_of_results();
  std::vector<std::string> of_keys;
  for (const std::string& key : keys) {
    const bool taken = std::ranges::find(columns, key) != columns.end();
    of_keys.push_back((taken ? "set." : "") + key);
    units[of_keys.back()] = unit_of_key(key);
  }
  columns.insert(columns.begin() + 3, of_keys.begin(), of_keys.end());
  std::vector<Results> results;
  for (const BatchMember& m : members) results.push_back(read_results(m, out, scene_now));
  bool too_many = false;
  const NamedColumns readings = reading_columns_of(results, too_many);
  NamedColumns compared;
  for (const Results& r : results) compared.take(r.compared, false);
  for (const NamedColumns* more : {&readings, &std::as_const(compared)}) {
    columns.insert(columns.end(), more->names().begin(), more->names().end());
    units.insert(more->units().begin(), more->units().end());
  }
  Table table(columns);
  for (std::size_t k = 0; k < members.size(); ++k) {
    const BatchMember& m = members[k];
    const JobEnd end = ends.contains(m.name) ? ends.at(m.name) : JobEnd{-1, ""};
    std::vector<Cell> row{m.name, m.scene, joined(m.overrides, " ")};
    for (const std::string& key : keys) row.push_back(value_of(m, key));
    row.insert(row.end(), {end.code < 0 ? Cell{} : Cell{std::int64_t{end.code}},
                           exit_reason(end.code), end.message});
    row.insert(row.end(), results[k].cells.begin(), results[k].cells.end());
    readings.add(results[k].readings, row);
    compared.add(results[k].compared, row);
    table.add(row);
  }
  BatchSummary summary{table, {}, {}};
  const auto alone = std::ranges::count_if(results, &Results::too_many);
  if (too_many)
    summary.note = fmt::format(
        "gauges and loads would be more than {} columns of summary.csv, and only those are there "
        "that scenes name in their key summary",
        kMostSummaryColumns);
  else if (alone > 0)
    summary.note = fmt::format(
        "the gauges and loads of {} of {} runs would be more than {} columns of summary.csv each, "
        "and are left out; name the wanted ones in the key summary of their scenes",
        alone, members.size(), kMostSummaryColumns);
  for (const std::string& c : columns)
    if (const std::string& unit = units[c]; !unit.empty() && unit != "1")
      summary.units.emplace_back(c, unit);
  return summary;
}

std::string BatchSummary::csv() const {
  std::vector<std::string> with_unit;
  for (const auto& [column, unit] : units) with_unit.push_back(column + "=" + unit);
  return "# units: " + escaped(joined(with_unit, ", ")) + "\n" + table.csv();
}

std::string BatchSummary::json() const {
  Json by_column = Json::object();
  for (const auto& [column, unit] : units) by_column[column] = unit;
  return json_text(
             {{"version", build_info().version}, {"units", by_column}, {"rows", table.json()}}) +
         "\n";
}

}  // namespace pbf::campaign_module
