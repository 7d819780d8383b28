// Messages for people, written to the terminal and to the log file of the run.
#pragma once

#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>
#include <utility>

#include "lib/base/stage_clock.h"

namespace pbf::inline base_module {

/// Notes and progress go to stderr, results to stdout, all of it to the log file once one is open.
/// What is no text (a stranger's file name, say) is written out, see escaped() in plain_text.h.
/// A closed pipe on either side is no error; finish_stdout() reports every other lost write.
class Log {
 public:
  /// quiet: nothing but results, warnings and errors on the terminal. The file still gets
  /// everything.
  explicit Log(bool quiet);
  /// Lines go to `sink`, with their newlines, in place of stdout and stderr.
  explicit Log(std::function<void(const std::string&)> sink) : sink_(std::move(sink)) {}
  ~Log();
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;

  /// Creates (or empties, or with `append` goes on with) the log file. Throws Error(io) with the
  /// system's reason.
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
  std::int64_t update = 0, updates = 0;  ///< done, and in all
  std::int64_t particles = 0;
  double time = 0;                                   ///< s, simulated
  double compression_mean = 0, compression_max = 0;  ///< of the last measure, 1
  std::int64_t first_update = 0;  ///< those before it were done by another process
};

/// "  42 %  update 420/1000 ..." with particle-updates per second since the last line and the time
/// left at the mean speed so far. Pure: `wall` and `wall_since`, `updates_since` are given.
std::string progress_line(const ProgressState& s, double wall, double wall_since,
                          std::int64_t updates_since);

/// Decides when a line is due: on a terminal twice a second, rewritten; else a plain line every
/// 10 s or 5 % of the updates, whichever comes first, but not more than one a second.
class Progress {
 public:
  explicit Progress(Log& log) : log_(log) {}
  /// Updates before this one were done by another process.
  void start_at(std::int64_t update) { last_update_ = line_update_ = update; }
  void update(const ProgressState& state);

 private:
  Log& log_;
  Stopwatch watch_;
  double last_wall_ = 0, line_wall_ = 0;
  std::int64_t last_update_ = 0, line_update_ = 0;
};

/// To be called before any file is opened: one that got the number of a standard stream that is
/// closed would also get what is written there.
void hold_standard_streams();

/// Flushes stdout at the end of the program. Throws Error(io) when results were lost (disk full);
/// a reader that has gone away (`pbf ... | head`) is no error.
void finish_stdout();

}  // namespace pbf::inline base_module
