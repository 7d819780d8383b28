// Messages for people, written to the terminal and to the log file of the run.
#pragma once

#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>
#include <utility>

#include "lib/base/stage_clock.h"

namespace pbf::base_module {

/// Notes and progress go to stderr, results to stdout, and everything to the log file once it is
/// open. Bytes that are not valid text are escaped (escaped() in plain_text.h). A closed pipe is no
/// error; finish_stdout() reports other failed writes.
class Log {
 public:
  /// quiet: the terminal gets only results, warnings and errors. The file still gets everything.
  explicit Log(bool quiet);
  /// Lines go to `sink`, with their newlines, in place of stdout and stderr.
  explicit Log(std::function<void(const std::string&)> sink) : sink_(std::move(sink)) {}
  ~Log();
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;

  /// Creates the log file and removes an old one; with `append` continues the old one. Throws
  /// Error(io) with the system's reason.
  void open(const std::string& path, bool append = false);
  /// Lines to stderr and the file. `text` ends without a newline.
  void note(const std::string& text);
  /// "pbf: warning: TEXT" to stderr, also when quiet, and the file.
  void warning(const std::string& text);
  /// Lines to stdout and the file.
  void result(const std::string& text);
  /// A line that the next one overwrites on a terminal; the file does not get it.
  void transient(const std::string& text);
  /// A line of progress: every 10 s as note(), on a terminal twice a second as transient() instead,
  /// and every 10 s for the file.
  void progress(const std::string& text);
  /// A line for the file alone.
  void file_only(const std::string& text);
  /// Closes the log file. Throws Error(io) when something could not be written (disk full).
  void close();
  bool terminal() const { return terminal_; }  ///< stderr is a terminal and not quiet

 private:
  void clear_transient();
  void say(std::FILE* stream, const std::string& text);
  void to_file(const std::string& text);

  bool quiet_ = false, terminal_ = false, dirty_ = false;
  std::function<void(const std::string&)> sink_;
  std::string path_;
  std::FILE* file_ = nullptr;
  Stopwatch since_progress_, since_transient_;
};

/// Where a run stands, for one line of progress.
struct ProgressState {
  std::int64_t update = 0, updates = 0;  ///< done; total
  std::int64_t particles = 0;
  double time = 0;                                   ///< s, simulated
  double compression_mean = 0, compression_max = 0;  ///< of the last measurement, 1
  std::int64_t first_update = 0;                     ///< earlier ones were done by another process
};

/// "  42 %  update 420/1000 ..." with particle-updates per second since the last line and the time
/// left at the mean speed so far. Seconds: `wall` since the start, `wall_since` since the last
/// line.
std::string progress_line(const ProgressState& s, double wall, double wall_since,
                          std::int64_t updates_since);

/// Decides when a line is due. On a terminal, a line is rewritten twice a second. Otherwise there
/// is a plain line every 10 s or 5 % of the updates, whichever comes first, at most one per second.
class Progress {
 public:
  explicit Progress(Log& log) : log_(log) {}
  /// Updates before this one were done by another process.
  void start_at(std::int64_t update) { last_update_ = line_update_ = update; }
  void update(const ProgressState& state);

 private:
  Log& log_;
  Stopwatch monitor_;
  double last_wall_ = 0, line_wall_ = 0;
  std::int64_t last_update_ = 0, line_update_ = 0;
};

/// Call this before any file is opened. Otherwise a file could get the descriptor of a closed
/// standard stream, and with it the output to that stream.
void hold_standard_streams();

/// Flushes stdout at the end of the program. Throws Error(io) when results were lost (disk full);
/// a reader that has gone away (`pbf ... | head`) is no error.
void finish_stdout();

}  // namespace pbf::base_module
