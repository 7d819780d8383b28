#include "lib/program/motion_times.h"

#include <algorithm>
#include <cmath>

#include "lib/program/motion_table.h"

namespace pbf::program_module {
namespace {

/// Collects times of a motion's own clock, which shows time.motion_begin at the start of the run.
class Times {
 public:
  Times(double begin, double from, double to)
      : begin_(begin), from_(from), to_(to), all_{from, to} {}
  double first() const { return begin_ + from_; }
  double last() const { return begin_ + to_; }
  void add(double t) {
    if (t - begin_ > from_ && t - begin_ < to_) all_.push_back(t - begin_);
  }
  std::vector<double> all() {
    std::sort(all_.begin(), all_.end());
    all_.erase(std::unique(all_.begin(), all_.end()), all_.end());
    return all_;
  }

 private:
  double begin_, from_, to_;
  std::vector<double> all_;
};

constexpr int kParts = 32;  // per period or ramp: between samples, a sine differs by 0.5 % at most

/// Samples of the ramp. A ramp of very many periods hardly grows within one period, so the last
/// period of each of its 64 parts is sampled.
void add_ramp(Times& times, const Swing& s) {
  const double ramp = s.ramp.value_or(0), begin = std::max(0.0, times.first()),
               end = std::min(ramp, times.last());
  if (!(begin < end)) return;
  const double fine = std::min(s.period, ramp) / kParts;
  const int parts = ramp > 64 * s.period ? 64 : 1;
  for (int k = 0; k < parts; ++k) {
    const double high = std::min(end, ramp * (k + 1) / parts);
    const double low = std::max(begin, parts > 1 ? high - s.period : 0);
    if (!(low < high)) continue;
    const double first = std::ceil(low / fine);
    const int count = int((high - low) / fine) + 1;
    for (int n = 0; n <= count; ++n) times.add((first + n) * fine);
  }
}

/// One period at full amplitude, with samples that include its extremes.
void add_period(Times& times, const Swing& s) {
  const double ramp = s.ramp.value_or(0);
  const double from = ramp > 0 ? std::max(times.first(), ramp) : times.first();
  times.add(from);
  const double shift = s.phase / 360;
  const double first = std::ceil((from / s.period + shift) * kParts);
  for (int k = 0; k <= kParts; ++k) times.add(((first + k) / kParts - shift) * s.period);
}

/// The rows, and the middle and the point of extreme slope of each piece between them.
void add_curve(Times& times, const MotionTable& table, double beside) {
  if (table.time.size() < 2) return;
  const std::size_t last = piece_at(table, times.last());
  for (std::size_t k = piece_at(table, times.first()); k <= last; ++k) {
    const double row = table.time[k], next = table.time[k + 1];
    for (const double t : {row, row + beside, 0.5 * (row + next), next - beside, next})
      times.add(t);
    for (int c = 0; c < table.columns; ++c)
      if (const auto t = curve_piece(table, std::size_t(c), k).steepest()) times.add(*t);
  }
}

}  // namespace

std::vector<double> telling_times(const Scene& s, const Motion& m, double from, double to) {
  Times times(s.time.motion_begin, from, to);
  if (m.kind == MotionKind::sine) add_ramp(times, m), add_period(times, m);
  if (has_table(m)) add_curve(times, m.table, 0);
  return times.all();
}

std::vector<double> telling_times(const Scene& s, const TankMotion& m, double from, double to) {
  Times times(s.time.motion_begin, from, to);
  if (m.kind == TankMotionKind::sine) add_ramp(times, m), add_period(times, m);
  // Accelerations are second differences of steps and jump at the rows of a curve, so samples lie
  // one step beside the rows. Tables of accelerations are linear between rows.
  if (m.kind == TankMotionKind::file && m.table.columns == 1)
    add_curve(times, m.table, s.time.step);
  if (m.kind == TankMotionKind::file && m.table.columns == 3)
    for (auto t = std::lower_bound(m.table.time.begin(), m.table.time.end(), times.first());
         t != m.table.time.end() && *t < times.last(); ++t)
      times.add(*t);
  return times.all();
}

}  // namespace pbf::program_module
