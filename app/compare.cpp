// pbf compare: two run files, or one scene on two backends.
#include <filesystem>

#include "app/commands.h"
#include "lib/base/error.h"
#include "lib/base/inputs.h"
#include "lib/base/log.h"
#include "lib/base/output_file.h"
#include "lib/scene/load.h"
#include "lib/verify/compare.h"

namespace pbf::inline app_module {
namespace {

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

void check_report(const std::string& path) {
  if (path.empty() || ends_with(path, ".html") || ends_with(path, ".json")) return;
  throw Error(ExitCode::bad_input,
              "--report " + path + ": the name must end in .html (with diagrams) or .json");
}

void write_report(const std::string& path, const CompareResult& result) {
  if (path.empty()) return;
  write_text_file(path, ends_with(path, ".json") ? compare_json(result) : compare_html(result));
}

CompareResult between(const CompareOptions& o, Log& log) {
  if (o.between.size() != 2)
    throw Error(ExitCode::bad_input,
                "--between needs two sides separated by a comma, e.g. cpu:double,cuda:float");
  if (o.inputs.size() != 1)
    throw Error(ExitCode::bad_input, "--between compares one scene; " +
                                         std::to_string(o.inputs.size()) + " files are given");
  CompareSettings s;
  s.a = parse_side(o.between[0]);
  s.b = parse_side(o.between[1]);
  s.warmup = o.warmup;
  s.updates = o.updates;
  s.members = o.members;
  s.seed = o.seed;
  const LoadedScene a = load_scene(o.inputs[0], o.overrides);
  std::vector<std::string> more = o.overrides;
  more.insert(more.end(), o.overrides_b.begin(), o.overrides_b.end());
  const LoadedScene b = load_scene(o.inputs[0], more);
  check_output("--report", o.report);
  CompareResult result =
      compare_between(a.scene, b.scene, std::filesystem::path(a.path).parent_path().string(), s,
                      [&](const std::string& line) { log.note(line); });
  for (const std::string& key : o.overrides_b) result.notes.push_back("on B alone: " + key);
  return result;
}

CompareResult files(const CompareOptions& o) {
  if (!o.overrides.empty() || !o.overrides_b.empty())
    throw Error(ExitCode::bad_input,
                "--set and --set-b go with --between: run files are what they are");
  if (o.inputs.size() != 2)
    throw Error(ExitCode::bad_input, "two run files are needed, or one scene with --between A,B; " +
                                         std::to_string(o.inputs.size()) + " given");
  for (const std::string& path : o.inputs) note_input(path);
  check_output("--report", o.report);
  return compare_files(o.inputs[0], o.inputs[1]);
}

}  // namespace

int command_compare(const CompareOptions& o) {
  check_report(o.report);
  Log log(o.quiet);
  const CompareResult result = o.between.empty() ? files(o) : between(o, log);
  log.result(compare_text(result));
  write_report(o.report, result);
  return static_cast<int>(result.same() ? ExitCode::done : ExitCode::difference);
}

}  // namespace pbf::inline app_module
