#include "lib/run/run_record.h"

#include <fmt/core.h>
#include <filesystem>
#include <sstream>

#include "lib/base/error.h"
#include "lib/io/run_file.h"
#include "lib/program/schedule.h"
#include "lib/scene/difference.h"
#include "lib/scene/load.h"

namespace pbf::run_module {

std::string scene_record(const Scene& scene, const std::string& files) {
  std::string text = files.empty() ? "" : "# SHA-256 of its particle files:\n";
  std::istringstream lines(files);
  for (std::string line; std::getline(lines, line);) text += "# " + line + "\n";
  return text + resolved_yaml(scene);
}

std::string recorded_files(const std::string& record) {
  std::string files;
  std::istringstream lines(record);
  for (std::string line; std::getline(lines, line) && line.rfind("# ", 0) == 0;)
    if (line.find("  ") != std::string::npos) files += line.substr(2) + "\n";
  return files;
}

std::string difference_of_runs(const Scene& before, const std::string& files_before,
                               const Scene& now, const std::vector<SceneFile>& files) {
  const std::string keys = physics_difference(before, now),
                    contents = files_difference(files_before, files);
  return keys + (keys.empty() || contents.empty() ? "" : "; ") + contents;
}

std::string difference_of_file(const std::string& folder, const Scene& scene) {
  const std::string path = folder + "/" + kRunFile;
  try {
    try_run_file(path);
    return physics_difference(
        parse_stored_scene(RunReader(path).info().resolved_scene, path + ": its scene", {}), scene);
  } catch (const Error&) {
    return {};
  }
}

std::string why_not_finished(const std::string& folder, const Scene& scene) {
  if (!scene.output) return {};
  const std::string path = folder + "/" + kRunFile;
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return "run.vtkhdf is missing";
  try {
    try_run_file(path);
    const RunReader file(path);
    if (file.status() != "finished") return "run.vtkhdf is of a run that is " + file.status();
    // The last frame is at the end. The log is not checked: that of an earlier version is fine.
    const std::vector<std::int64_t> frames = file.updates();
    const std::int64_t end = make_schedule(scene).updates,
                       last = frames.empty() ? 0 : frames.back();
    if (last < end)
      return fmt::format("the frames of run.vtkhdf end at update {}, the run at {}", last, end);
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

}  // namespace pbf::run_module
