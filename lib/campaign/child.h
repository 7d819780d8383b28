// Child processes of this program.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

namespace pbf::campaign_module {

/// How a job of a batch ended.
struct JobEnd {
  int code = 0;         ///< exit code; 128 + signal when a signal ended it
  std::string message;  ///< the line after "pbf: error: " on stderr; may be empty
};

/// An error's text as JobEnd has it: on one line.
std::string job_message(std::string text);

/// This program with other arguments, in a process of its own without standard output. It gets
/// SIGTERM when this process ends, in any way. Not copied.
class Child {
 public:
  /// input: file descriptor that becomes its standard input; -1: that of this process.
  /// environment: NAME=VALUE, in place of what the name has here. Throws Error(unavailable) if no
  /// process can be started.
  explicit Child(const std::vector<std::string>& args, int input = -1,
                 const std::vector<std::string>& environment = {});
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  void terminate() const;       ///< SIGTERM
  std::optional<JobEnd> end();  ///< none while it runs
  /// Waits for it.
  JobEnd wait();

 private:
  JobEnd ended(int status);

  pid_t pid_ = -1;
  int err_ = -1;  ///< file descriptor of its stderr
  std::optional<JobEnd> end_;
};

}  // namespace pbf::campaign_module
