#include "app/run_place.h"

#include <filesystem>

#include "lib/base/error.h"
#include "lib/base/output_file.h"
#include "lib/io/run_path.h"
#include "lib/run/run_folder.h"

namespace pbf::inline app_module {
namespace {

namespace fs = std::filesystem;

}  // namespace

std::string run_place(const LoadedScene& loaded, const std::string& given, bool resume) {
  if (!given.empty()) return given;
  const std::string own = folder_of_run(loaded.run_file);
  return resume && !own.empty() ? own : "out/" + loaded.scene.name;
}

void refuse_own_folder(const LoadedScene& loaded, const std::string& out) {
  const std::string own = folder_of_run(loaded.run_file);
  std::error_code error;
  if (own.empty() || !fs::equivalent(own, out, error)) return;
  bad_input(out,
            "holds the run that is to be repeated; give another folder with --out, or --resume to "
            "go on with it");
}

std::string not_there_note(const LoadedScene& loaded, const std::string& out, bool given) {
  const std::string text = out + " is not there: the run begins at its start";
  if (given) return text;
  // Runs of scenes without a name were kept in out/scene by earlier versions.
  const std::string before = std::string("out/") + Scene{}.name;
  std::error_code error;
  if (loaded.named_by_file && fs::exists(before + "/" + kResolvedScene, error))
    return text + "; " + before +
           " holds a run of a scene without a name: to go on with that one, give --out " + before;
  return text + "; to go on with one that was begun with --out FOLDER, give the same --out";
}

void check_log_json(const std::string& path, const std::string& out) {
  if (path.empty()) return;
  if (RunFolder::owns(out, path))
    throw Error(ExitCode::bad_input,
                "--log-json " + path + ": the run itself writes this file; give another name");
  const fs::path parent = fs::path(path).parent_path();
  std::error_code error;
  if (parent.empty() || fs::is_directory(parent, error)) return check_output("--log-json", path);
  // It may be the run folder itself, which is made later.
  if (fs::absolute(parent).lexically_normal() == fs::absolute(out).lexically_normal()) return;
  throw Error(ExitCode::io, "--log-json " + path + ": the folder " + parent.string() +
                                " is not there; make it first");
}

}  // namespace pbf::inline app_module
