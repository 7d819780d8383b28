// The folder of one run: run.vtkhdf, checkpoints, scene.resolved.yaml, log.txt, frames/, and DONE,
// which is written last. The process that writes there holds the lock .lock.
#pragma once

#include <filesystem>
#include <string>

namespace pbf::run_module {

/// What to do with an existing folder.
enum class ExistingFolder { refuse, overwrite, resume };

class RunFolder {
 public:
  static constexpr const char* kPictures = "frames";  ///< subfolder of the pictures

  /// Whether the folder exists; changes nothing. Throws Error(bad_input) if it exists and
  /// `existing` is refuse; Error(io) if the path is no folder.
  static bool check(const std::string& path, ExistingFolder existing);

  /// Makes or opens the folder, after the same checks, and locks it. Throws Error(bad_input) if
  /// another run writes there; Error(io) if a link or a FIFO has the name of a file of the run, or
  /// if the folder cannot be made or written. `overwrite` removes only files that pbf itself
  /// writes.
  RunFolder(const std::string& path, ExistingFolder existing);
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;

  /// Throws Error(bad_input) if `overwrite` would remove a file there that this command has read.
  static void refuse_overwrite(const std::string& path);
  /// Whether `path` is a file that a run in `folder` writes itself; it need not exist.
  static bool owns(const std::string& folder, const std::string& path);

  std::string file(const std::string& name) const { return (path_ / name).string(); }
  std::string path() const { return path_.string(); }
  bool has(const std::string& name) const;
  /// Whether the folder holds files that pbf did not write.
  bool holds_other_files() const;
  /// Writes a text file atomically. Throws Error(io).
  void write_text(const std::string& name, const std::string& text) const;
  void remove(const std::string& name) const;

 private:
  void lock();
  void remove_own_files() const;
  void refuse_special_files() const;
  std::filesystem::path path_;
  int lock_ = -1;
};

}  // namespace pbf::run_module
