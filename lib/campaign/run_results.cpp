#include "lib/campaign/run_results.h"

#include <cmath>
#include <filesystem>
#include <optional>

#include "lib/base/error.h"
#include "lib/data/comparison.h"
#include "lib/data/summary.h"
#include "lib/io/run_file.h"
#include "lib/scene/load.h"
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

constexpr const char* kOfFile[] = {"particles", "frames", "warnings", "seconds"};

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
void read_readings(const RunReader& file, const std::optional<Scene>& scene, FileResults& out) {
  if (!scene) return;
  const std::vector<SummaryColumn> columns = wanted_summary_columns(*scene);
  const std::vector<double> values = summary_numbers(file, columns, scene->summary_from);
  for (std::size_t k = 0; k < columns.size(); ++k)
    out.readings.push_back({columns[k].name, columns[k].unit, values[k]});
  out.named = !scene->summary.empty();
  out.too_many = columns.empty() && !summary_columns(*scene).empty();
}

FileResults read_results(const BatchMember& m, const std::string& out_folder,
                         const SceneOfMember& now) {
  const std::string path = out_folder + "/" + m.name + "/" + kRunFile;
  const std::vector<std::string> names = last_values();
  FileResults out;
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

}  // namespace

std::vector<std::string> file_columns() {
  std::vector<std::string> names = last_values();
  names.insert(names.end(), std::begin(kOfFile), std::end(kOfFile));
  return names;
}

void RunResults::read(const BatchMember& m) {
  worker_.push([this, m] { read_.insert_or_assign(m.name, read_results(m, out_, scene_now_)); },
               false);
}

std::vector<FileResults> RunResults::of(const std::vector<BatchMember>& members) {
  worker_.wait();
  for (const BatchMember& m : members)
    if (!read_.contains(m.name)) read(m);
  worker_.wait();
  if (const std::exception_ptr failure = worker_.failure()) std::rethrow_exception(failure);
  std::vector<FileResults> all;
  for (const BatchMember& m : members) all.push_back(read_.at(m.name));
  return all;
}

}  // namespace pbf::campaign_module
