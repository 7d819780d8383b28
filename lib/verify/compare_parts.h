// The three parts of a comparison of two solvers, and the code that they share.
#pragma once

#include "lib/program/plan.h"
#include "lib/scene/keys.h"
#include "lib/verify/compare.h"
#include "lib/verify/compare_readings.h"

namespace pbf::inline verify_module {

/// A tolerance is kNoiseFactor times the largest change that the ensemble of randomly rounded
/// references shows: the ensemble rounds what a pass stores, a solver of that precision rounds
/// inside its passes too, and the largest of a few members is an estimate. What clean
/// pairs need of it: tests/regression/defects.
inline constexpr double kNoiseFactor = 4;

/// The same for the statistics of the third part: single numbers, not the largest over thousands of
/// particles, whose largest change over a few members is a poorer estimate.
inline constexpr double kSpreadFactor = 8;

struct Comparison {
  const CompareSettings* settings;
  const Plan* plan;    ///< of A's scene
  const Scene* scene;  ///< A's
  const Plan* plan_b;
  const Scene* scene_b;
  Solver *a, *b;
  Solver* reference;  ///< A's scene on cpu in double, without fused density
  std::vector<std::unique_ptr<Solver>> members{};  ///< like the reference
  double u = 0;                                    ///< unit roundoff of the coarser precision
  double sides = 1;                                ///< how many of the two round to it
  bool same_bits = false;  ///< both sides promise the same bits: every tolerance is 0
  std::function<void(const std::string&)> progress{};

  /// Loads and gauges of the last `updates` updates, by the plan of A or of B.
  std::vector<Reading> take(Solver& of, int updates) const {
    return &of == b ? take_readings(of, *scene_b, *plan_b, updates)
                    : take_readings(of, *scene, *plan, updates);
  }
};

/// One update from `start` on both sides, stage by stage. Sets result.stage.
ComparePart compare_stages(const Comparison& c, const SolverState& start, CompareResult& result);

/// settings->updates updates from `start`: per-particle distances (second part) and statistics
/// (third part), each against the ensemble. first_failure: update at which the distances, or else
/// the statistics, left their tolerance, -1: never.
std::vector<ComparePart> compare_course(const Comparison& c, const SolverState& start,
                                        CompareResult& result, std::int64_t& first_failure);

/// The state with every number rounded at random: value (1 + r u), r uniform in [-1, 1).
SolverState rounded(const SolverState& s, double u, std::uint64_t seed);

/// The same for every number of the object that the table says is rounded (Key::exact).
void round_at_random(const KeyTable& table, const Object& object, double u, std::uint64_t seed);

/// |a - b|; 0 where neither is a number, infinite where one alone is not.
double apart(double a, double b);

/// Raises each number to how far `x` is from `from`: the same readings of two solvers of one scene.
void raise_to_distance(std::vector<double>& to, const std::vector<Reading>& x,
                       const std::vector<Reading>& from);

/// What rounding is relative to in a and b.
double scale_of(const Reading& a, const Reading& b);

struct Distance {
  double rms = 0, worst = 0;  ///< m
};
/// Of the particles at x from those at y, both by id.
Distance distance(const std::vector<double>& x, const std::vector<double>& y,
                  double (*difference)(double, double) = apart);

/// Keeps the worst share of a tolerance in the row of this name, which is made when new, with
/// `scale` for the relative error, and a unit roundoff `u` for that in units of the last place.
/// False, with the verdicts of the row and the part, where the error is outside its tolerance.
bool note(ComparePart& p, const std::string& what, const std::string& unit, double error,
          double scale, double tolerance, double u = 0);

/// Error over tolerance; 0 without an error, infinite without a tolerance.
double share_of(double error, double tolerance);

/// Unit in the last place of `value` for a unit roundoff u.
double ulp(double value, double u);

}  // namespace pbf::inline verify_module
