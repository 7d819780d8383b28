#include "lib/campaign/batch_summary.h"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <utility>

#include "lib/base/error.h"
#include "lib/base/plain_text.h"
#include "lib/base/text.h"
#include "lib/base/version.h"
#include "lib/data/summary.h"
#include "lib/io/table.h"
#include "lib/scene/keys.h"
#include "lib/scene/number.h"
#include "lib/solver/diagnostics.h"

namespace pbf::campaign_module {
namespace {

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
NamedColumns reading_columns_of(const std::vector<FileResults>& results, bool& too_many) {
  NamedColumns all, named;
  for (const FileResults& r : results) {
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
                           const std::map<std::string, JobEnd>& ends, RunResults& read) {
  const std::vector<std::string> keys = set_keys(members);
  std::vector<std::string> columns{"name", "scene", "settings", "exit_code", "reason", "message"};
  const std::vector<std::string> names = file_columns();
  columns.insert(columns.end(), names.begin(), names.end());
  std::map<std::string, std::string> units = units_of_results();
  std::vector<std::string> of_keys;
  for (const std::string& key : keys) {
    const bool taken = std::ranges::find(columns, key) != columns.end();
    of_keys.push_back((taken ? "set." : "") + key);
    units[of_keys.back()] = unit_of_key(key);
  }
  columns.insert(columns.begin() + 3, of_keys.begin(), of_keys.end());
  const std::vector<FileResults> results = read.of(members);
  bool too_many = false;
  const NamedColumns readings = reading_columns_of(results, too_many);
  NamedColumns compared;
  for (const FileResults& r : results) compared.take(r.compared, false);
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
  const auto alone = std::ranges::count_if(results, &FileResults::too_many);
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
