#include "lib/campaign/batch_summary.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "lib/base/error.h"
#include "lib/base/plain_text.h"
#include "lib/base/text.h"
#include "lib/base/version.h"
#include "lib/data/comparison.h"
#include "lib/io/run_file.h"
#include "lib/io/table.h"
#include "lib/scene/keys.h"
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

/// What a run file says: last measurements, numbers of particles, frames and warnings, seconds, as
/// empty cells if there is no file; and comparisons with measurements.
struct Results {
  std::vector<Cell> cells;
  std::vector<StoredComparison> compared;
};
Results read_results(const std::string& path) {
  const std::vector<std::string> names = last_values();
  Results out;
  std::vector<Cell>& cells = out.cells;
  cells.resize(names.size() + std::size(kOfFile));
  std::error_code error;
  if (std::filesystem::exists(path, error)) try {
      const RunReader file(path);
      for (std::size_t k = 0; k < names.size(); ++k)
        if (const auto column = file.log_column(names[k]); !column.empty())
          cells[k] = column.back();
      const RunInfo info = file.info();
      cells[names.size()] = info.particles;
      cells[names.size() + 1] = file.frames();
      cells[names.size() + 2] = std::int64_t(info.warnings.size());
      double seconds = 0;
      for (const std::string& name : file.log_columns())
        if (name.rfind("stage/", 0) == 0)
          for (const double s : file.log_column(name)) seconds += s;
      cells.back() = seconds;
      out.compared = file.comparisons();
    } catch (const Error&) {
      cells.assign(cells.size(), Cell{});  // the message of the run tells what is wrong
    }
  return out;
}

/// "compare/H2/rms", with its unit, of all runs in the order of first appearance.
class ComparedColumns {
 public:
  explicit ComparedColumns(const std::vector<Results>& all) {
    for (const Results& r : all)
      for (const StoredComparison& c : r.compared)
        for (const std::string& number : comparison_numbers())
          if (!std::isnan(number_of(c, number)) && seen_.insert(column(c, number)).second)
            names_.push_back(column(c, number));
  }
  const std::vector<std::string>& names() const { return names_; }
  void add(const Results& r, std::vector<Cell>& row) const {
    std::map<std::string, double> values;
    for (const StoredComparison& c : r.compared)
      for (const StoredComparison::Number& n : c.numbers) values[column(c, n.name)] = n.value;
    for (const std::string& name : names_)
      row.push_back(values.contains(name) ? known(values[name]) : Cell{});
  }
  static std::string column(const StoredComparison& c, const std::string& number) {
    return "compare/" + c.name + "/" + number;
  }

 private:
  std::vector<std::string> names_;
  std::set<std::string> seen_;
};

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
                           const std::map<std::string, JobEnd>& ends, const std::string& out) {
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
  for (const BatchMember& m : members)
    results.push_back(read_results(out + "/" + m.name + "/" + kRunFile));
  const ComparedColumns compared(results);
  columns.insert(columns.end(), compared.names().begin(), compared.names().end());
  for (const Results& r : results)
    for (const StoredComparison& c : r.compared)
      for (const StoredComparison::Number& n : c.numbers)
        units[ComparedColumns::column(c, n.name)] = n.unit;
  Table table(columns);
  for (std::size_t k = 0; k < members.size(); ++k) {
    const BatchMember& m = members[k];
    const JobEnd end = ends.contains(m.name) ? ends.at(m.name) : JobEnd{-1, ""};
    std::vector<Cell> row{m.name, m.scene, joined(m.overrides, " ")};
    for (const std::string& key : keys) row.push_back(value_of(m, key));
    row.insert(row.end(), {end.code < 0 ? Cell{} : Cell{std::int64_t{end.code}},
                           exit_reason(end.code), end.message});
    row.insert(row.end(), results[k].cells.begin(), results[k].cells.end());
    compared.add(results[k], row);
    table.add(row);
  }
  BatchSummary summary{table, {}};
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
