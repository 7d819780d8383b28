// The folder of one run: run.vtkhdf, checkpoints, scene.resolved.yaml, log.txt, frames/, and DONE,
// which is written last. A process that writes there holds the lock .lock.
#pragma once

#include <filesystem>
#include <string>

namespace pbf::inline run_module {

/// What to do with a folder that is there already.
enum class ExistingFolder { refuse, overwrite, resume };

class RunFolder {
 public:
  static constexpr const char* kPictures = "frames";  ///< the folder of the pictures in it

  /// Whether the folder is there, before any work is done and without touching anything. Throws
  /// Error(bad_input) for an existing one when `refuse`; Error(io) for something that is no folder.
  static bool check(const std::string& path, ExistingFolder existing);

  /// Makes or opens the folder, after the same checks, and locks it: Error(bad_input) when another
  /// run writes there, Error(io) when a link or a FIFO has the name of a file of the run.
  /// `overwrite` removes the files that pbf itself writes and leaves everything else. Throws
  /// Error(io) when it cannot be made or written.
  RunFolder(const std::string& path, ExistingFolder existing);
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;

  /// Error(bad_input) when `overwrite` would remove a file there that this command has read.
  static void refuse_overwrite(const std::string& path);
  /// Whether `path` is a file that a run in `folder` writes itself, be it there or not.
  static bool owns(const std::string& folder, const std::string& path);

  std::string file(const std::string& name) const { return (path_ / name).string(); }
  std::string path() const { return path_.string(); }
  bool has(const std::string& name) const;
  /// Whether there is anything in it that pbf did not write.
  bool holds_other_files() const;
  /// Writes a text file, which nobody sees half written. Throws Error(io).
  void write_text(const std::string& name, const std::string& text) const;
  void remove(const std::string& name) const;

 private:
  void lock();
  void remove_own_files() const;
  void refuse_special_files() const;
  std::filesystem::path path_;
  int lock_ = -1;
};

}  // namespace pbf::inline run_module
