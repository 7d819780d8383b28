#include "app/run_folder.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>
#include <vector>

#include "lib/base/error.h"

namespace pbf {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void fail(const fs::path& path, const std::string& what, const std::string& reason) {
  throw Error(ExitCode::io, path.string() + ": " + what + ": " + reason +
                                "; choose another folder with --out, or free space and rights");
}

bool starts_with(const std::string& s, const char* prefix) { return s.rfind(prefix, 0) == 0; }

bool own_picture(const std::string& name) {
  return starts_with(name, "frame_") && fs::path(name).extension() == ".png";
}

bool own_file(const std::string& name) {
  return name == "run.h5" || name == "scene.resolved.yaml" || name == "log.txt" || name == "DONE" ||
         name == "checkpoint.h5" || name == "checkpoint_prev.h5" || name == "checkpoint.h5.tmp" ||
         name == "guard_state.h5" || name == "guard_scene.yaml";
}

}  // namespace

bool RunFolder::check_finished(const std::string& path, ExistingFolder existing) {
  const fs::path folder(path);
  std::error_code error;
  const fs::file_status status = fs::status(folder, error);
  if (status.type() == fs::file_type::not_found) return false;
  if (status.type() == fs::file_type::none)  // below a regular file, or no right to look
    fail(folder, "the output folder cannot be used", error.message());
  if (!fs::is_directory(status))
    fail(folder, "the output folder cannot be used", "it is not a folder");
  if (existing == ExistingFolder::refuse)
    throw Error(ExitCode::bad_input,
                path +
                    ": the output folder exists; give --overwrite to replace the run in it, "
                    "--resume to leave a finished run as it is, or another folder with --out");
  if (existing == ExistingFolder::overwrite) return false;
  if (fs::exists(folder / "DONE", error)) return true;
  throw Error(ExitCode::bad_input,
              path +
                  ": holds no finished run (no file DONE), and this version cannot resume an "
                  "unfinished one; give --overwrite to start it again");
}

RunFolder::RunFolder(const std::string& path, ExistingFolder existing) : path_(path) {
  if (!path_.has_filename()) path_ = path_.parent_path();  // "out/" means "out"
  check_finished(path_.string(), existing);
  std::error_code error;
  if (path_.has_parent_path()) {
    fs::create_directories(path_.parent_path(), error);
    if (error) fail(path_, "the output folder cannot be made", error.message());
  }
  // One mkdir decides: of two runs started at the same time only one gets the folder.
  const bool made = fs::create_directory(path_, error);
  if (error) fail(path_, "the output folder cannot be made", error.message());
  if (!made && existing != ExistingFolder::overwrite)
    throw Error(ExitCode::bad_input, path_.string() + ": another run has just taken this folder");
  if (access(path_.c_str(), W_OK | X_OK) != 0)
    fail(path_, "the output folder cannot be written", std::strerror(errno));
  if (!made) remove_own_files();
}

void RunFolder::remove_own_files() const {
  std::error_code error;
  const auto remove = [&](const fs::path& p) {
    if (!fs::is_directory(fs::symlink_status(p)) && !fs::remove(p, error) && error)
      fail(p, "cannot be removed", error.message());
  };
  remove(path_ / "DONE");  // first: a folder that is half removed is not a finished run
  const auto remove_in = [&](const fs::path& folder, bool (*own)(const std::string&)) {
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(folder, error))
      if (own(entry.path().filename().string())) found.push_back(entry.path());
    if (error) fail(folder, "cannot be read", error.message());
    for (const auto& p : found) remove(p);
  };
  remove_in(path_, own_file);
  if (!fs::is_directory(path_ / "frames", error)) return;
  remove_in(path_ / "frames", own_picture);
  fs::remove(path_ / "frames", error);  // only when nothing foreign is left in it
}

void RunFolder::write_text(const std::string& name, const std::string& text) const {
  std::ofstream out(path_ / name, std::ios::binary | std::ios::trunc);
  out << text;
  out.close();
  if (!out) fail(path_ / name, "cannot be written", std::strerror(errno));
}

void RunFolder::make_frames_folder() const {
  std::error_code error;
  fs::create_directories(path_ / "frames", error);
  if (error) fail(path_ / "frames", "cannot be made", error.message());
}

}  // namespace pbf
