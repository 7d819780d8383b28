// Definitions shared by writer and reader of run.vtkhdf: names, versions, the columns of the log.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "lib/io/run_file.h"
#include "lib/solver/diagnostics.h"

namespace pbf::io_module::run_layout {

/// Version of everything under /pbf. A reader refuses newer files.
inline constexpr int format_version = 1;

/// Rows in a chunk of the tables of steps (/VTKHDF/Steps) and of the columns of the log.
inline constexpr unsigned step_rows = 512, log_rows = 1024;

/// Where the free bodies of every frame are, (frames, bodies, BodyMotion::kNumbers) in float64,
/// below /pbf; only in runs that have some. Attributes: `names` of the bodies, `columns` and
/// `units` of their numbers. Rows in a chunk.
inline constexpr const char* bodies = "frames/bodies";
inline constexpr unsigned body_rows = 64;

/// Rows of the log and of gauges wait for so many, or so long (s).
inline constexpr std::size_t waiting_rows = 256;
inline constexpr double waiting_seconds = 5;
/// Frames that come faster than this (s) are committed together. A commit waits for the disk three
/// times, and writes the waiting rows of the log.
inline constexpr double commit_seconds = 0.25;

/// Where readings of gauges lie below /pbf.
inline constexpr const char* gauges = "gauges/";

/// Where the results of comparisons are below /pbf: a group for each, with a scalar for each
/// number.
inline constexpr const char* compare = "compare";

/// Rows in a chunk of the table of sessions, and bytes of its texts.
inline constexpr unsigned session_rows = 16, session_text = 96;

inline constexpr const char* topologies[4] = {"Vertices", "Lines", "Polygons", "Strips"};

/// A column of the log: a float64 or an int64 dataset /pbf/log/<name>.
struct LogColumn {
  const char* name;
  const char* unit;
  bool real;                                   ///< float64
  std::function<double(const LogRow&)> value;  ///< whole where it is not real
};

/// The columns of every run, in the order of their creation: what a row has besides measures,
/// then the table of diagnostics.
const std::vector<LogColumn>& log_columns();

/// A number of a row whose column not every run has: "stage/lambda", "load/z_min/force_x".
struct FurtherNumber {
  std::string column;
  const char* unit;
  double value;
};
/// "load/post/force_x": the column in the log of a number of a reading.
std::string further_column(const ReadingColumn& column, int component);
/// In so many groups below the log.
inline constexpr int log_groups = 2;
/// `columns`: of the run's readings.
std::vector<FurtherNumber> further_numbers(const LogRow& row,
                                           const std::vector<ReadingColumn>& columns);

/// f(column name, value) for every text, and every integer, of a RunSession: one list for both
/// directions.
template <class F>
void for_each_text(RunSession& s, F&& f) {
  f("started", s.started);
  f("ended", s.ended);
  f("reason", s.reason);
  f("host", s.host);
  f("device", s.device);
  f("program", s.program);
}
template <class F>
void for_each_integer(RunSession& s, F&& f) {
  f("threads", s.threads);
  f("first_update", s.first_update);
  f("last_update", s.last_update);
}

/// f(attribute name, text, older files lack it) for every text of a RunInfo (const or not): one
/// list for both directions.
template <class Info, class F>
void for_each_text(Info& info, F&& f) {
  constexpr bool newer = true;
  f("scene_path", info.scene_path);
  f("scene_text", info.scene_text);
  f("resolved_scene", info.resolved_scene);
  f("program_version", info.program_version);
  f("commit", info.commit);
  f("compiler", info.compiler);
  f("build_flags", info.build_flags);
  f("host", info.host);
  f("started", info.started);
  f("plan", info.plan);
  f("backend", info.solver.backend);
  f("precision", info.solver.precision);
  f("device", info.solver.device);
  f("driver", info.solver.driver);
  f("scene_sha256", info.scene_sha256, newer);
  f("scene_files", info.scene_files, newer);
  f("scene_bases", info.scene_bases, newer);
}

/// f(dataset name, unit, values, older files lack it) for every quantity of a RunInfo (const or
/// not).
template <class Info, class F>
void for_each_quantity(Info& info, F&& f) {
  f("domain_min", "m", info.domain_min, false);
  f("domain_max", "m", info.domain_max, false);
  f("spacing", "m", std::span(&info.spacing, 1), false);
  f("smoothing_length", "m", std::span(&info.smoothing_length, 1), false);
  f("rest_density", "kg/m^3", std::span(&info.rest_density, 1), false);
  f("energy_at_rest", "J", std::span(&info.energy_at_rest, 1), true);
  f("particle_weight", "1", std::span(&info.solver.vol, 1), false);
  f("wall_scale", "1", std::span(&info.solver.wall_scale, 1), false);
}

}  // namespace pbf::io_module::run_layout
