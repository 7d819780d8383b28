// The folder of one run: run.h5, scene.resolved.yaml, log.txt, frames/, DONE written last.
#pragma once

#include <filesystem>
#include <string>

namespace pbf {

/// What to do with a folder that is there already.
enum class ExistingFolder { refuse, overwrite, resume };

class RunFolder {
 public:
  /// Says whether a run may go there, before any work is done and without touching anything.
  /// Throws Error(bad_input) for an existing folder when `refuse`, and for an unfinished one when
  /// `resume`, which this version cannot resume; Error(io) for something that is no folder.
  /// True when `resume` finds a finished run: there is nothing to do.
  static bool check_finished(const std::string& path, ExistingFolder existing);

  /// Makes the folder, after the same checks. `overwrite` removes the files that pbf itself writes
  /// and leaves everything else. Throws Error(io) when it cannot be made or written.
  RunFolder(const std::string& path, ExistingFolder existing);

  std::string file(const std::string& name) const { return (path_ / name).string(); }
  std::string path() const { return path_.string(); }
  /// Writes a text file. Throws Error(io).
  void write_text(const std::string& name, const std::string& text) const;
  void make_frames_folder() const;

 private:
  void remove_own_files() const;
  std::filesystem::path path_;
};

}  // namespace pbf
