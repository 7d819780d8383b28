// The columns of what a run reads besides its diagnostics: loads of walls and gauges. The log,
// JSON, /pbf/gauges of the run file, compare and the plan follow this table.
#pragma once

#include <string>
#include <vector>

#include "lib/scene/scene.h"

namespace pbf::program_module {

struct Plan;

/// Diagnostics in the log. Their table is diagnostics() (lib/solver/diagnostics.cpp), which must
/// have so many rows.
inline constexpr int kDiagnosticColumns = 32;

/// When columns are read: with the measures (the log), or every output.gauges_every. Poses are
/// in the log too; those of prescribed motions are known without a solver.
enum class Series { measures, gauges, poses };

/// How far a number may be off if the terms of its sum differ only in their last bits: sums are of
/// whole numbers (kLoadUnits, kProbeUnits, particles).
struct Grain {
  double value = 0;   ///< in the unit of the column
  double of_sum = 0;  ///< of the sum over an interval (unit times s), of which it is the mean
};

struct ReadingColumn {
  const char* kind;  ///< "load", "dissipation", "emitter", "sink", or the kind of a gauge
  std::string of;    ///< wall, obstacle, cause, emitter, sink or gauge
  const char* name;  ///< "force"; empty: the gauge's own data
  const char* unit;
  std::string place{};  ///< "x = 0.5 m"; empty for loads
  Join join = Join::now;
  int components = 1;
  Series series = Series::gauges;
  Grain grain{};
  /// Reference for rounding: this (1, or m) times the peak of the same wall. 0: the length of the
  /// vector of all numbers of the same gauge and unit.
  double lever = 0;
};

/// Loads of the walls in the order x_min, x_max ..., then of obstacles, then what took energy from
/// the motion, then emitters and sinks, then gauges, then the poses of moving obstacles. Readings
/// are the numbers of the columns of a series, one behind the other. Loads are along the scene's
/// axes, a torque is about the present middle. A velocity is NaN if no particle is within h. A mean
/// over an interval of length 0 is 0.
std::vector<ReadingColumn> reading_columns(const Scene& scene, const Plan& plan);

/// The columns of a wall or obstacle whose loads are recorded. grain: load_grain(); arm: m, of its
/// torques.
std::vector<ReadingColumn> load_columns(const std::string& of, double grain, double arm);
/// The walls and obstacles whose loads are recorded, in the order of their columns.
std::vector<std::string> loaded_names(const Scene& scene);

/// The columns of the poses of a free body: the numbers of a BodyMotion in their order. Those of a
/// prescribed motion are the first two.
std::vector<ReadingColumn> body_columns(const std::string& name);

/// Calls f(column, component, number) for each number of a series in their order.
template <class F>
void for_each_number(const std::vector<ReadingColumn>& columns, Series series, F&& f) {
  std::size_t number = 0;
  for (const ReadingColumn& c : columns)
    for (int k = 0; c.series == series && k < c.components; ++k) f(c, k, number++);
}

/// Present position of the middle of each moving obstacle and the rows of its rotation from the
/// pose in the scene file, `time` s after the start; of a free body also its velocities. bodies: of
/// all free bodies.
std::vector<double> pose_readings(const Scene& scene, double time,
                                  const std::vector<BodyMotion>& bodies);

/// "force_x", "total", "x", "turn_xy".
std::string number_name(const ReadingColumn& column, int component);

}  // namespace pbf::program_module
