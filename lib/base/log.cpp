#include "lib/base/log.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "lib/base/error.h"
#include "lib/base/own_file.h"
#include "lib/base/plain_text.h"
#include "lib/base/text.h"

namespace pbf::base_module {
namespace {

int stdout_errno = 0;  // of the first failed write; stdio forgets it

void write_to(std::FILE* f, const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), f) == text.size() && std::fflush(f) == 0) return;
  if (f == stdout && stdout_errno == 0) stdout_errno = errno;
}

}  // namespace

Log::Log(bool quiet) : quiet_(quiet), terminal_(!quiet && isatty(STDERR_FILENO) == 1) {}

Log::~Log() {
  clear_transient();
  if (file_) std::fclose(file_);
}

void Log::open(const std::string& path, bool append) {
  path_ = path;
  // Do not truncate the old file: it may have another name (a hard link).
  if (!append) require_own_file(path), ::unlink(path.c_str());
  const int how = append ? O_APPEND : O_EXCL;
  file_ = ::fdopen(open_own_file(path, O_WRONLY | O_CREAT | how), append ? "a" : "w");
  if (!file_) throw Error(ExitCode::io, path + ": cannot be created: " + std::strerror(errno));
}

void Log::to_file(const std::string& text) {
  if (!file_) return;
  if (std::fwrite(text.data(), 1, text.size(), file_) != text.size() || std::fflush(file_) != 0)
    throw Error(ExitCode::io, path_ + ": cannot be written: " + std::strerror(errno));
}

void Log::clear_transient() {
  if (dirty_) write_to(stderr, "\r\033[K");
  dirty_ = false;
}

void Log::say(std::FILE* stream, const std::string& text) {
  const std::string lines = escaped(text) + "\n";
  clear_transient();
  if (sink_)
    sink_(lines);
  else if (stream)
    write_to(stream, lines);
  to_file(lines);
}

void Log::note(const std::string& text) { say(quiet_ ? nullptr : stderr, text); }
void Log::warning(const std::string& text) { say(stderr, "pbf: warning: " + text); }
void Log::result(const std::string& text) { say(stdout, text); }

void Log::transient(const std::string& text) {
  if (!terminal_) return;
  write_to(stderr, "\r\033[K" + escaped(text));
  dirty_ = true;
}

void Log::progress(const std::string& text) {
  if (terminal_ && since_transient_.seconds() >= 0.5) {
    transient(text);
    since_transient_ = Stopwatch();
  }
  if (since_progress_.seconds() < 10) return;
  terminal_ ? file_only(text) : note(text);
  since_progress_ = Stopwatch();
}

void Log::file_only(const std::string& text) { to_file(escaped(text) + "\n"); }

void Log::close() {
  clear_transient();
  if (!file_) return;
  const bool lost = std::fclose(file_) != 0;
  file_ = nullptr;
  if (lost) throw Error(ExitCode::io, path_ + ": cannot be written: " + std::strerror(errno));
}

std::string progress_line(const ProgressState& s, double wall, double wall_since,
                          std::int64_t updates_since) {
  const double part = s.updates > 0 ? double(s.update) / double(s.updates) : 1;
  std::string line = fmt::format("{:3.0f} %  update {}/{}  {:.4g} s simulated", 100 * part,
                                 s.update, s.updates, s.time);
  if (wall_since > 0 && updates_since > 0)
    line += fmt::format("  {} particle-updates/s",
                        si_number(double(updates_since) * double(s.particles) / wall_since));
  line += fmt::format("  compression mean {:.2g} %, max {:.2g} %", 100 * s.compression_mean,
                      100 * s.compression_max);
  const std::int64_t own = s.update - s.first_update;
  if (own > 0 && part < 1)
    line += "  " + duration_text(wall * double(s.updates - s.update) / double(own)) + " to go";
  return line;
}

void Progress::update(const ProgressState& state) {
  const double wall = monitor_.seconds();
  if (log_.terminal() && wall - last_wall_ >= 0.5) {
    log_.transient(progress_line(state, wall, wall - last_wall_, state.update - last_update_));
    last_wall_ = wall;
    last_update_ = state.update;
  }
  // The plain lines also make up the log file of a run watched on a terminal.
  const double since = wall - line_wall_;
  const std::int64_t done = state.update - line_update_;
  if (since < 10 && (since < 1 || done * 20 < state.updates)) return;
  if (log_.terminal())
    log_.file_only(progress_line(state, wall, since, done));
  else
    log_.note(progress_line(state, wall, since, done));
  line_wall_ = wall;
  line_update_ = state.update;
}

void hold_standard_streams() {
  // Opened in the wrong direction, so that using them fails as if they were closed.
  for (const int fd : {0, 1, 2})
    if (::fcntl(fd, F_GETFD) < 0 && errno == EBADF)
      (void)::open("/dev/null", fd == 0 ? O_WRONLY : O_RDONLY);
}

void finish_stdout() {
  if (std::fflush(stdout) != 0 && stdout_errno == 0) stdout_errno = errno;
  if (stdout_errno == EBADF)
    throw Error(ExitCode::io,
                "standard output is closed and results are lost; where they are not wanted, give "
                "> /dev/null");
  if (stdout_errno != 0 && stdout_errno != EPIPE)
    throw Error(ExitCode::io,
                std::string("standard output cannot be written: ") + std::strerror(stdout_errno));
}

}  // namespace pbf::base_module
