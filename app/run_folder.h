// The folder of one run: run.h5, scene.resolved.yaml, log.txt, frames/, DONE written last.
#pragma once

#include <filesystem>
#include <string>

namespace pbf {

/// What to do with a folder that is there already.
enum class ExistingFolder { refuse, overwrite, resume };

class RunFolder {
 public:
  /// Makes the folder. An existing one is refused with Error(bad_input); `overwrite` removes the
  /// files that pbf itself writes and leaves everything else; `resume` accepts a finished one
  /// (then finished() is true) and refuses an unfinished one, which this version cannot resume.
  /// Throws Error(io) when the folder cannot be made or written.
  RunFolder(const std::string& path, ExistingFolder existing);

  bool finished() const;  ///< DONE is there
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
