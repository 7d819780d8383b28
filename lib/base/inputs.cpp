#include "lib/base/inputs.h"

#include <pthread.h>
#include <sys/stat.h>

#include <mutex>
#include <set>

namespace pbf::base_module {
namespace {

std::mutex mutex;
/// A copy of the process (fork) has only the thread that made it. Another one that held the lock
/// would hold it there for ever.
[[maybe_unused]] const int at_fork =
    pthread_atfork([] { mutex.lock(); }, [] { mutex.unlock(); }, [] { mutex.unlock(); });

std::set<std::string>& paths() {
  static std::set<std::string> all;
  return all;
}

}  // namespace

void note_input(const std::string& path) {
  const std::lock_guard lock(mutex);
  paths().insert(path);
}

std::vector<std::string> inputs() {
  const std::lock_guard lock(mutex);
  return {paths().begin(), paths().end()};
}

// Looks up every inode again: the system may have given the inode of a deleted file to another one.
std::string input_at(const std::string& path) {
  struct stat there {
  }, input{};
  if (::stat(path.c_str(), &there) != 0 || !S_ISREG(there.st_mode)) return {};
  for (const std::string& p : inputs())
    if (::stat(p.c_str(), &input) == 0 && input.st_dev == there.st_dev &&
        input.st_ino == there.st_ino)
      return p;
  return {};
}

}  // namespace pbf::base_module
