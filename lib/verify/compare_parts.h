// The parts of a comparison of two solvers and of one of two run files, and the code that they
// share.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lib/io/run_file.h"
#include "lib/program/plan.h"
#include "lib/scene/keys.h"
#include "lib/scene/periodic.h"
#include "lib/verify/compare.h"

namespace pbf::verify_module {

/// A tolerance is kNoiseFactor times the largest change in the ensemble of randomly rounded
/// references. The factor is needed because the ensemble rounds only stored values, while a real
/// solver also rounds inside its passes, and because the maximum of a few members is an estimate.
/// tests/regression/defects measures the factor that pairs without a defect need.
inline constexpr double kNoiseFactor = 4;

/// The same for the statistics of the third part. They are single numbers, not maxima over
/// thousands of particles, so the largest change over a few members is a poorer estimate.
inline constexpr double kSpreadFactor = 8;

/// A load on a wall or an obstacle, a reading of a gauge, or where a free body is, as a number to
/// compare.
struct Reading {
  std::string stage;  ///< "loads", "gauges", "poses" ...
  std::string what, unit;
  double value = 0;
  double scale = 0;  ///< reference for rounding if it is more than |value|
  double grain = 0;  ///< ReadingColumn::grain, of this interval
};

/// Readings of the last `updates` updates, since the last call or since a state with empty sums was
/// set; of free bodies those of now. Empty if the scene has neither loads, gauges nor free bodies.
std::vector<Reading> take_readings(Solver& solver, const Scene& scene, const Plan& plan,
                                   int updates);

/// The reading of this name; null if there is none.
const Reading* find_reading(const std::vector<Reading>& readings, const std::string& what);

struct Comparison {
  const CompareSettings* settings;
  const Plan* plan;    ///< of A
  const Scene* scene;  ///< of A
  const Plan* plan_b;
  const Scene* scene_b;
  Solver *a, *b;
  Solver* reference;  ///< A's scene on cpu in double, without fused density
  std::vector<std::unique_ptr<Solver>> members{};  ///< like the reference
  double u = 0;                                    ///< unit roundoff of the coarser precision
  double sides = 1;                                ///< number of sides with this roundoff
  bool same_bits = false;  ///< both sides promise the same bits: every tolerance is 0
  std::function<void(const std::string&)> progress{};

  /// Loads and gauges of the last `updates` updates, by the plan of the solver's side.
  std::vector<Reading> take(Solver& of, int updates) const {
    return &of == b ? take_readings(of, *scene_b, *plan_b, updates)
                    : take_readings(of, *scene, *plan, updates);
  }
};

/// One update from `start` on both sides, stage by stage. Sets result.stage.
ComparePart compare_stages(const Comparison& c, const SolverState& start, CompareResult& result);

/// Makes settings->updates updates from `start`: distances per particle (second part) and
/// statistics (third part), each against the ensemble. first_failure: update at which the
/// distances, or else the statistics, left their tolerance; -1: never.
std::vector<ComparePart> compare_course(const Comparison& c, const SolverState& start,
                                        CompareResult& result, std::int64_t& first_failure);

/// The state with all numbers rounded at random: value (1 + r u), r uniform in [-1, 1).
SolverState rounded(const SolverState& s, double u, std::uint64_t seed);

/// The same for the numbers of an object, except keys with Key::exact.
void round_at_random(const KeyTable& table, const Object& object, double u, std::uint64_t seed);

/// |a - b|; 0 if both are NaN, infinite if only one is.
double apart(double a, double b);

/// Raises each element to |x - from| of its reading; both are readings of the same scene.
void raise_to_distance(std::vector<double>& to, const std::vector<Reading>& x,
                       const std::vector<Reading>& from);

/// Reference value of rounding for a and b.
double scale_of(const Reading& a, const Reading& b);

struct Distance {
  double rms = 0, worst = 0;  ///< m
};
/// Distance between particles at x and at y, both in the order of the same ids. period: of the
/// axes, in the unit of x; 0: not periodic.
Distance distance(const std::vector<double>& x, const std::vector<double>& y, const Double3& period,
                  double (*difference)(double, double) = apart);
/// periods() in h.
Double3 periods_in_h(const Scene& scene);

/// The rows of particles that two sides have both. Empty lists: all rows, which are the same
/// particles in the same order.
struct CommonRows {
  std::vector<std::size_t> a, b;
  std::size_t only_a = 0, only_b = 0;  ///< particles of one side alone
  bool all() const { return only_a == 0 && only_b == 0; }
};
/// a, b: ids, ascending.
CommonRows common_rows(const std::vector<std::int64_t>& a, const std::vector<std::int64_t>& b);
/// The rows of `width` values each, one behind the other.
template <class T>
std::vector<T> rows_of(const std::vector<T>& values, const std::vector<std::size_t>& rows,
                       std::size_t width) {
  std::vector<T> out;
  for (const std::size_t i : rows)
    out.insert(out.end(), values.begin() + std::ptrdiff_t(width * i),
               values.begin() + std::ptrdiff_t(width * (i + 1)));
  return out;
}

/// Updates the row of this name (added if missing) to the largest error relative to its tolerance.
/// `scale`: reference of the relative error; `u`: unit roundoff for units in the last place.
/// Returns false, and sets the verdicts of row and part, if the error exceeds the tolerance.
bool note(ComparePart& p, const std::string& what, const std::string& unit, double error,
          double scale, double tolerance, double u = 0);

/// Error divided by tolerance; 0 without an error, infinite without a tolerance.
double share_of(double error, double tolerance);

/// Unit in the last place of `value` for a unit roundoff u.
double ulp(double value, double u);

// ------------------------------------------------------------------------------ two run files

/// A run file with values that are needed several times.
struct ComparedRun {
  std::string path;
  RunReader reader;
  RunInfo info;
  Scene scene;
  std::vector<double> times;  ///< of frames, s
  std::string status;
  /// Throws Error(io) if the file cannot be read, Error(bad_input) if its scene cannot.
  explicit ComparedRun(const std::string& path);
  /// Frame k. Throws Error(io) if its arrays do not have the shape of a frame, or ids do not
  /// ascend.
  Snapshot frame(std::int64_t k) const;
  /// The status, with the reason if the session gives one.
  std::string end_text() const;
};

/// Frames of A and B at the same time, within half an update, and the unpaired ones.
struct FramePairs {
  std::vector<std::pair<std::int64_t, std::int64_t>> common;
  std::vector<double> only_a, only_b;  ///< s
};
FramePairs pair_frames(const ComparedRun& a, const ComparedRun& b);
/// The same for any ascending times (s) that differ by at most `apart`.
FramePairs pair_times(const std::vector<double>& a, const std::vector<double>& b, double apart);

/// Parts "particles" and "distributions" over the common frames. `exact`: both sides promise
/// identical bits.
std::vector<ComparePart> compare_frames(const ComparedRun& a, const ComparedRun& b,
                                        const FramePairs& frames, bool exact,
                                        CompareResult& result);

/// Part "bodies": where the free bodies are in the common frames and in the rows of the log at
/// common times. None if no run has free bodies.
std::optional<ComparePart> compare_bodies(const ComparedRun& a, const ComparedRun& b,
                                          const FramePairs& frames, bool exact);

}  // namespace pbf::verify_module
