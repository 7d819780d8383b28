#include "lib/io/run_path.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <vector>

#include "lib/base/error.h"
#include "lib/base/text.h"
#include "lib/io/h5_read.h"
#include "lib/io/run_file.h"
#include "lib/scene/file_kind.h"

namespace pbf::io_module {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostLooked = 10000, kMostShown = 3;

bool is_there(const fs::path& file) {
  std::error_code error;
  return fs::exists(file, error);
}

/// Whether it has one or may have: what cannot be looked at, or is a link to nothing, is told when
/// it is opened.
bool has_run_file(const fs::path& folder) {
  std::error_code error;
  return fs::symlink_status(folder / kRunFile, error).type() != fs::file_type::not_found;
}

/// What a folder without a run file holds, of the kinds that a command may be meant for.
struct Contents {
  std::vector<std::string> runs_below, run_files, scenes;
};

Contents look_into(const fs::path& folder) {
  Contents found;
  std::error_code error;
  std::size_t looked = 0;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string path = it->path().string();
    if (++looked > kMostLooked) break;
    if (it->path().filename() == kResolvedScene) continue;
    if (is_there(it->path() / kRunFile)) found.runs_below.push_back(path);
    if (has_run_name(path)) found.run_files.push_back(path);
    if (has_scene_name(path)) found.scenes.push_back(path);
  }
  for (auto* list : {&found.runs_below, &found.run_files, &found.scenes}) std::ranges::sort(*list);
  return found;
}

std::string some(const std::vector<std::string>& paths) {
  const std::vector<std::string> first(
      paths.begin(), paths.begin() + std::ptrdiff_t(std::min(paths.size(), kMostShown)));
  return joined(first, ", ") + (paths.size() > kMostShown ? ", ..." : "");
}

std::string why_not(const std::string& path) {
  const std::string missing = std::string("no ") + kRunFile + " in this folder";
  const Contents in = look_into(path);
  if (!in.runs_below.empty())
    return missing + ", but in " + some(in.runs_below) + "; name " +
           (in.runs_below.size() == 1 ? "that" : "one of them");
  if (!in.run_files.empty()) return missing + ", but " + some(in.run_files) + "; name the file";
  if (is_there(fs::path(path) / kResolvedScene))
    return missing +
           ": a run that writes no frames, or one that has not begun; give its scene "
           "output: {} and run it again";
  if (!in.scenes.empty())
    return missing + ", but " + some(in.scenes) + "; name one, or run all with pbf batch " + path;
  return missing + "; name a scene or a run file, or the folder of a run";
}

}  // namespace

std::string run_path(const std::string& path) {
  std::error_code error;
  if (!fs::is_directory(path, error)) return path;
  if (!has_run_file(path)) bad_input(path, why_not(path));
  return (fs::path(path) / kRunFile).string();
}

bool is_hdf5_file(const std::string& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return false;
  std::string head(8, '\0');
  std::ifstream in(path, std::ios::binary);
  return in.read(head.data(), std::ssize(head)) && h5::is_signature(head);
}

std::string only_run_path(const std::string& path) {
  const std::string file = run_path(path);
  std::error_code error;
  if (fs::is_regular_file(file, error) && std::ifstream(file).good() && !is_hdf5_file(file))
    throw Error(
        ExitCode::io,
        file + ": cannot read the run file: " +
            (has_scene_name(file) ? "it is a scene, not a run; pbf run " + file + " simulates it"
             : fs::file_size(file, error) == 0 ? std::string("it is empty")
                                               : std::string("it is no HDF5 file")));
  return file;
}

std::string folder_of_run(const std::string& run_file) {
  const fs::path file(run_file);
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  return file.filename() == kRunFile && is_there(folder / kResolvedScene) ? folder.string() : "";
}

}  // namespace pbf::io_module
