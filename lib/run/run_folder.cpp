#include "lib/run/run_folder.h"

#include <fcntl.h>
#include <pthread.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <mutex>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "lib/base/error.h"
#include "lib/base/inputs.h"
#include "lib/base/output_file.h"
#include "lib/base/own_file.h"
#include "lib/io/run_file.h"
#include "lib/io/run_path.h"
#include "lib/run/wave_files.h"

namespace pbf::run_module {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void fail(const fs::path& path, const std::string& what, const std::string& reason) {
  throw Error(ExitCode::io, path.string() + ": " + what + ": " + reason +
                                "; choose another folder with --out, or free space and rights");
}

bool own_picture(const std::string& name) {
  return name.starts_with(kTemporaryPrefix) || is_wave_file(name) ||
         (name.starts_with("frame_") && fs::path(name).extension() == ".png");
}

bool own_file(const std::string& name) {
  static const char* const kNames[] = {kRunFile,
                                       kEarlierRunFile,
                                       "run.damaged.h5",
                                       kDamagedRunFile,
                                       kResolvedScene,
                                       "log.txt",
                                       "DONE",
                                       "checkpoint.h5",
                                       "checkpoint_prev.h5",
                                       "checkpoint.h5.tmp",
                                       "guard_state.h5",
                                       "guard_scene.yaml"};
  return name.starts_with(kTemporaryPrefix) || std::ranges::find(kNames, name) != std::end(kNames);
}

/// What is in a folder and has such a name, in alphabetical order.
std::set<fs::path> named_in(const fs::path& folder, bool (*own)(const std::string&),
                            std::error_code& error) {
  std::set<fs::path> found;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (own(entry.path().filename().string())) found.insert(entry.path());
  return found;
}

/// The first letters of a regular file; empty for a link, a folder or a missing file.
std::optional<std::string> start_of(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(fs::symlink_status(path, error))) return {};
  std::string text(3, '\0');
  std::ifstream in(path, std::ios::binary);
  in.read(text.data(), std::ssize(text));
  text.resize(std::size_t(in.gcount()));
  return text;
}

/// A foreign file: it has the name of a run's file, but is in a folder without a run. Links are
/// ignored, since replacing one harms nobody.
std::optional<fs::path> others_file(const fs::path& folder) {
  const auto log = start_of(folder / "log.txt");
  if (log && *log == "pbf") return {};  // the log of a run begins with the name of the program
  if (log && !log->empty()) return folder / "log.txt";
  const auto all_in = [](const fs::path& where, bool (*own)(const std::string&)) {
    std::error_code error;
    std::set<fs::path> found = named_in(where, own, error);
    std::erase_if(found, [](const fs::path& file) {
      return file.filename().string().starts_with(kTemporaryPrefix) ||
             start_of(file).value_or("").empty();
    });
    return found;
  };
  const std::set<fs::path> found = all_in(folder, own_file);
  // A run whose log was removed has the record of its scene, and something beside it; one that was
  // killed before its first line has an empty log.
  if (found.contains(folder / kResolvedScene) && (found.size() > 1 || log)) return {};
  if (!found.empty()) return *found.begin();
  const fs::path frames = folder / RunFolder::kPictures;
  if (fs::is_symlink(frames)) return {};
  const std::set<fs::path> pictures = all_in(frames, own_picture);
  return pictures.empty() ? std::nullopt : std::optional(*pictures.begin());
}

/// File descriptors of all locks of this process.
struct Locks {
  std::mutex mutex;  // for `all`, also locked during fork
  std::set<int> all;
};

Locks& locks() {
  static Locks all;
  return all;
}

}  // namespace

bool RunFolder::check(const std::string& path, ExistingFolder existing) {
  const fs::path folder(path);
  std::error_code error;
  const fs::file_status status = fs::status(folder, error);
  if (status.type() == fs::file_type::not_found) return false;
  if (status.type() == fs::file_type::none)  // below a regular file, or no permission
    fail(folder, "the output folder cannot be used", error.message());
  if (!fs::is_directory(status))
    fail(folder, "the output folder cannot be used", "it is not a folder");
  if (existing == ExistingFolder::refuse)
    bad_input(path, fs::exists(folder / kResolvedScene, error)
                        ? "the output folder exists; give --overwrite to replace the run in it, "
                          "--resume to go on with it, or another folder with --out"
                        : "the output folder exists, without a run in it; give --overwrite to "
                          "write into it beside what is there, or another folder with --out");
  if (const auto file = others_file(folder))
    bad_input(file->string(),
              "a run would replace this file, which is of no run of pbf; move it away, or give "
              "another folder with --out");
  return true;
}

RunFolder::RunFolder(const std::string& path, ExistingFolder existing) : path_(path) {
  if (!path_.has_filename()) path_ = path_.parent_path();  // "out/" means "out"
  check(path_.string(), existing);
  std::error_code error;
  if (path_.has_parent_path()) {
    fs::create_directories(path_.parent_path(), error);
    if (error) fail(path_, "the output folder cannot be made", error.message());
  }
  // A single mkdir decides which of two simultaneous runs gets the folder.
  const bool made = fs::create_directory(path_, error);
  if (error) fail(path_, "the output folder cannot be made", error.message());
  if (!made && existing == ExistingFolder::refuse)
    bad_input(path_.string(), "another run has just taken this folder");
  if (access(path_.c_str(), W_OK | X_OK) != 0)
    fail(path_, "the output folder cannot be written", std::strerror(errno));
  lock();
  if (!made && existing == ExistingFolder::overwrite) remove_own_files();
  if (!made) refuse_special_files();
}

RunFolder::~RunFolder() {
  if (lock_ < 0) return;
  const std::lock_guard alone(locks().mutex);
  locks().all.erase(lock_);
  ::unlink(file(".lock").c_str());  // while locked: the next run makes a new file
  ::close(lock_);
}

/// The system releases the lock when the process ends, in any way. A forked child (which tests a
/// file) would inherit the lock and keep it after a SIGKILL of this process: it closes its copy.
void RunFolder::lock() {
  static const int closed_in_children =
      pthread_atfork([] { locks().mutex.lock(); }, [] { locks().mutex.unlock(); },
                     [] {
                       for (const int fd : locks().all) ::close(fd);
                       locks().mutex.unlock();
                     });
  if (closed_in_children != 0)
    fail(path_ / ".lock", "cannot be kept from other processes", std::strerror(closed_in_children));
  const std::lock_guard alone(locks().mutex);
  for (;;) {
    lock_ = open_own_file(file(".lock"), O_RDWR | O_CREAT);
    if (::flock(lock_, LOCK_EX | LOCK_NB) != 0) {
      const int reason = errno;
      char who[200] = "";
      const ssize_t size = ::pread(lock_, who, sizeof who - 1, 0);
      ::close(std::exchange(lock_, -1));
      if (reason != EWOULDBLOCK)
        fail(path_ / ".lock", "this file system has no locks (flock)", std::strerror(reason));
      bad_input(path_.string(),
                "another run writes here" + (size > 0 ? " (" + std::string(who) + ")" : "") +
                    "; wait for its end, stop it, or give another folder with --out");
    }
    // Another run may have unlinked the file between our open and our lock.
    struct stat mine {
    }, there{};
    if (::fstat(lock_, &mine) == 0 && ::stat(file(".lock").c_str(), &there) == 0 &&
        mine.st_ino == there.st_ino)
      break;
    ::close(std::exchange(lock_, -1));
  }
  locks().all.insert(lock_);
  char host[256] = "";
  gethostname(host, sizeof host - 1);
  const std::string who = "process " + std::to_string(getpid()) + " on " + host;
  if (::ftruncate(lock_, 0) != 0 ||
      ::pwrite(lock_, who.data(), who.size(), 0) != static_cast<ssize_t>(who.size()))
    errno = 0;  // failure only costs the message to a second run; a full disk shows soon enough
}

void RunFolder::refuse_overwrite(const std::string& path) {
  std::error_code error;
  const fs::path folder = fs::canonical(path, error);
  for (const std::string& input : inputs()) {
    const fs::path file = fs::canonical(input, error);
    if (!error && file.parent_path() == folder && own_file(file.filename().string()))
      bad_input(path, "--overwrite would remove " + input +
                          ", which this run reads; give another folder with --out");
  }
}

bool RunFolder::owns(const std::string& folder, const std::string& path) {
  const auto place = [](const fs::path& file) {
    std::error_code error;
    return fs::weakly_canonical(fs::absolute(file), error);
  };
  const std::string name = fs::path(path).filename().string();
  const bool inside = place(path).parent_path() == place(fs::path(folder) / name).parent_path();
  return inside && (own_file(name) || name == ".lock" || name == kPictures);
}

/// These names belong to pbf. Following a link or waiting for a FIFO of such a name could harm
/// others. The folder itself may be reached through a link.
void RunFolder::refuse_special_files() const {
  std::error_code error;
  for (const fs::path& file : named_in(path_, own_file, error)) require_own_file(file.string());
  if (error) fail(path_, "cannot be read", error.message());
  if (!fs::is_directory(fs::symlink_status(path_ / kPictures, error)))
    require_own_file((path_ / kPictures).string());
}

bool RunFolder::has(const std::string& name) const {
  std::error_code error;
  return fs::exists(path_ / name, error);
}

bool RunFolder::holds_other_files() const {
  std::error_code error;
  const auto other = [](const std::string& name) {
    return !own_file(name) && name != ".lock" && name != kPictures;
  };
  return !named_in(path_, other, error).empty();
}

void RunFolder::remove(const std::string& name) const {
  std::error_code error;
  fs::remove(path_ / name, error);
  if (error) fail(path_ / name, "cannot be removed", error.message());
}

void RunFolder::remove_own_files() const {
  std::error_code error;
  const auto remove = [&](const fs::path& p) {
    if (!fs::is_directory(fs::symlink_status(p)) && !fs::remove(p, error) && error)
      fail(p, "cannot be removed", error.message());
  };
  remove(path_ / "DONE");  // first: a folder that is half removed is not a finished run
  const auto remove_in = [&](const fs::path& folder, bool (*own)(const std::string&)) {
    const std::set<fs::path> found = named_in(folder, own, error);
    if (error) fail(folder, "cannot be read", error.message());
    for (const auto& p : found) remove(p);
  };
  remove_in(path_, own_file);
  const fs::file_status frames = fs::symlink_status(path_ / kPictures, error);
  if (fs::exists(frames) && !fs::is_directory(frames)) remove(path_ / kPictures);
  if (!fs::is_directory(frames)) return;
  remove_in(path_ / kPictures, own_picture);
  fs::remove(path_ / kPictures, error);  // fails if it holds foreign files, as intended
}

void RunFolder::write_text(const std::string& name, const std::string& text) const {
  write_text_file(file(name), text, Naming::own);
}

}  // namespace pbf::run_module
