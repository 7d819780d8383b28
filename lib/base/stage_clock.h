// The only timer of the program: a stopwatch, and times in seconds booked by stage name.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace pbf::base_module {

/// Measures seconds since its construction or last reset, on the monotonic clock.
class Stopwatch {
 public:
  Stopwatch() : start_(std::chrono::steady_clock::now()) {}
  void reset() { start_ = std::chrono::steady_clock::now(); }
  double seconds() const {  ///< s
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  double lap() {  ///< s since the last lap (or the start); the next lap begins here
    const auto now = std::chrono::steady_clock::now();
    const double s = std::chrono::duration<double>(now - start_).count();
    start_ = now;
    return s;
  }

 private:
  std::chrono::steady_clock::time_point start_;
};

/// Seconds booked to one stage.
struct StageTime {
  std::string name;
  double seconds = 0;      ///< s
  std::int64_t calls = 0;  ///< number of marks
};

/// Books wall-clock time to named stages: after begin(), mark("grid") books the time since begin()
/// or the last mark. Entries are in the order of their first mark. For one thread.
class StageClock {
 public:
  /// Time before this call is not booked.
  void begin() { monitor_.reset(); }

  /// Books the time since begin() or the last mark to `stage`.
  void mark(std::string_view stage) { add(stage, monitor_.lap()); }

  /// Books seconds measured elsewhere (a device, another thread).
  void add(std::string_view stage, double seconds, std::int64_t calls = 1) {
    StageTime& e = entry(stage);
    e.seconds += seconds;
    e.calls += calls;
  }

  /// The entry of `stage`; a new one has zero seconds. Also used to fix the order of entries.
  StageTime& entry(std::string_view stage) {
    for (StageTime& e : entries_)
      if (e.name == stage) return e;
    entries_.push_back({std::string(stage), 0, 0});
    return entries_.back();
  }

  const std::vector<StageTime>& entries() const { return entries_; }

 private:
  Stopwatch monitor_;
  std::vector<StageTime> entries_;  // a dozen: a linear search beats a map
};

}  // namespace pbf::base_module
