#include "lib/run/finished_run.h"

#include <filesystem>

#include "lib/base/error.h"
#include "lib/base/text.h"
#include "lib/run/schedule.h"
#include "lib/scene/difference.h"
#include "lib/scene/load.h"

namespace pbf::inline run_module {

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
    // The last frame is that of the end. The log is not asked: one of an earlier version will do.
    const std::vector<std::int64_t> frames = file.updates();
    const std::int64_t end = make_schedule(scene).updates,
                       last = frames.empty() ? 0 : frames.back();
    if (last < end)
      return format("the frames of run.vtkhdf end at update %lld, the run at %lld",
                    static_cast<long long>(last), static_cast<long long>(end));
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

}  // namespace pbf::inline run_module
