#include "lib/campaign/batch_summary.h"

#include <filesystem>

#include "lib/base/error.h"
#include "lib/base/text.h"
#include "lib/io/run_file.h"
#include "lib/io/table.h"
#include "lib/solver/diagnostics.h"

namespace pbf::inline campaign_module {
namespace {

/// Columns of a run's log whose last value is in the summary.
std::vector<std::string> last_values() {
  std::vector<std::string> names{"time", "update"};
  for (const Diagnostic& d : diagnostics())
    if (d.summary) names.push_back(d.name);
  return names;
}

/// Of a run's file: the last measures, the numbers of frames and warnings, seconds; empty cells
/// without one.
void add_results(const std::string& path, std::vector<Cell>& row) {
  const std::vector<std::string> names = last_values();
  std::vector<Cell> cells(names.size() + 3);
  std::error_code error;
  if (std::filesystem::exists(path, error)) try {
      const RunReader file(path);
      for (std::size_t k = 0; k < names.size(); ++k)
        if (const auto column = file.log_column(names[k]); !column.empty())
          cells[k] = column.back();
      cells[names.size()] = file.frames();
      double seconds = 0;
      for (const std::string& name : file.log_columns())
        if (name.rfind("stage/", 0) == 0)
          for (const double s : file.log_column(name)) seconds += s;
      cells[names.size() + 1] = std::int64_t(file.info().warnings.size());
      cells.back() = seconds;
    } catch (const Error&) {
      cells.assign(cells.size(), Cell{});  // the message of the run says what is wrong with it
    }
  row.insert(row.end(), cells.begin(), cells.end());
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

std::string batch_summary(const std::vector<BatchMember>& members,
                          const std::map<std::string, JobEnd>& ends, const std::string& out) {
  std::vector<std::string> columns{"name", "scene", "settings", "exit_code", "reason", "message"};
  const std::vector<std::string> names = last_values();
  columns.insert(columns.end(), names.begin(), names.end());
  columns.insert(columns.end(), {"frames", "warnings", "seconds"});
  Table table(columns);
  for (const BatchMember& m : members) {
    const JobEnd end = ends.contains(m.name) ? ends.at(m.name) : JobEnd{-1, ""};
    std::vector<Cell> row{m.name,
                          m.scene,
                          joined(m.overrides, " "),
                          end.code < 0 ? Cell{} : Cell{std::int64_t{end.code}},
                          exit_reason(end.code),
                          end.message};
    add_results(out + "/" + m.name + "/" + kRunFile, row);
    table.add(row);
  }
  return table.csv();
}

}  // namespace pbf::inline campaign_module
