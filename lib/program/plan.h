// What a scene needs, computed before anything is allocated: program, arrays, grid, files, and what
// is left out. It depends only on the scene; all later code follows it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernels/axes.h"
#include "lib/base/json.h"
#include "lib/program/gauges.h"
#include "lib/program/levels.h"
#include "lib/program/memory.h"
#include "lib/program/obstacles.h"
#include "lib/program/program.h"
#include "lib/scene/scene.h"

namespace pbf::inline program_module {

/// Of a sample of the scene's particles, spread evenly over their ids.
struct StartNeighbors {
  std::vector<int> count;       ///< particles within h, the particle itself included
  std::vector<double> scatter;  ///< standard deviation of the counts around it; 0: too few sampled
  bool empty() const { return count.empty(); }
};

/// Files of one kind that the run leaves behind, with their estimated size.
struct PlanFile {
  std::string name;                    ///< "run.vtkhdf", "frames/frame_*.png"
  std::int64_t number = 1, bytes = 0;  ///< of all of them
  std::string note;                    ///< "101 frames"
};

struct Plan {
  std::int64_t particles = 0;
  StartNeighbors start;      ///< lib/run/start_neighbors.h
  double cell_edge = 1;      ///< in h, >= 1: larger only where the box would need too many cells
  Axes axes;                 ///< of the internal frame; lib/program/axes.h
  int cells[3] = {1, 1, 1};  ///< of the grid, in internal axes; along x half cells
  double vol = 1;            ///< m/(rho0 h^3), in 2-D m/(rho0 h^2 thickness); calibrate.h
  double wall_scale = 1, wall_range = 1;  ///< amplitude; range in h
  /// omega. By default min(1, (2.5 d/h)^2): one Jacobi iteration moves every particle for all its
  /// neighbours' constraints at once, so its stable step falls with their number. Measured on a
  /// column of 24 layers: 1 is stable at h = 2.5 d and throws particles up at 3 d, 0.7 is stable at
  /// 3 d and 0.3 at 4 d. In two dimensions min(1, (3 d/h)^(4/3)), the same power of the number of
  /// neighbours: measured on a column of 24 squares, 1 is stable at h = 3 d, gains 1.5 % of energy
  /// at 4 d and throws particles up at 5 d, 0.7 is stable at 4 d and 0.5 at 5 d. Unless the scene
  /// sets it, it falls further where the density is above rho0 (kernels/pass_lambda.h): a closed
  /// box with 1.3 times its particles boiled with 58 times the energy of its start, and now comes
  /// to rest. With levels 2 d/h and 2.4 d/h in place of 2.5 and 3: they need more damping of what
  /// is short; kernels/README.md, "Levels".
  double sor = 1;
  /// Factors on omega, one per iteration of a substep; empty: 1 in all (solver.method: jacobi).
  std::vector<double> sor_factors;
  int substeps = 1;
  int lists_per_update = 1;  ///< substeps share lists (substep_lists.h)
  int finest_level = 0;      ///< of time.adaptive: an update is up to 2^finest_level steps
  double tolerance =
      0;            ///< mean compression above which the iterations are repeated; 0: they are not
  int repeats = 0;  ///< at most so many, besides the first
  double mass = 0;  ///< kg, of one particle as reported
  LevelPlan levels;
  std::vector<Solid<double>> solids;  ///< of obstacles, in internal axes; lib/program/obstacles.h
  GaugePlan gauges;
  Program program;
  MemoryPlan memory;
  std::vector<LeftOut> left_out;
  std::vector<PlanFile> files;

  std::int64_t bytes() const { return memory.solver_bytes(); }
  UpdateShape shape() const;
};

/// Datasets of run.vtkhdf, each with an index: the columns of log and gauges among them.
double run_file_datasets(const Scene& scene);

/// Pure: touches no file and no device. `particles` from count_particles(). `start`: of
/// start_neighbors(), for the memory of a crowded start; without it the start counts as fluid at
/// rest. Throws Error(bad_input) where the grid of the scene cannot be numbered.
Plan make_plan(const Scene& scene, std::int64_t particles, StartNeighbors start = {});

/// What a run comes to, as one number each.
struct PlanTotals {
  std::int64_t updates = 0;
  double end = 0;  ///< s, simulated: whole updates
  /// Peaks of all that the run holds, with program and libraries; device: 0 where there is none.
  std::int64_t host_bytes = 0, device_bytes = 0;
  std::int64_t disk_bytes = 0;  ///< of all files
};
PlanTotals plan_totals(const Plan& plan, const Scene& scene);

// The plan for people, in parts.

/// What is asked first, in five lines: particles, time, run time, memory, disk. `run_time`: what
/// its line says; empty: there is none.
std::string plan_summary(const Plan& plan, const Scene& scene, const std::string& run_time);
/// Files, memory by backend and precision, grid, passes, what is left out because of which key.
std::string plan_details(const Plan& plan, const Scene& scene);
/// Every array with its type, life, place and size, and the memory that is fixed.
std::string plan_arrays(const Plan& plan, const Scene& scene);
/// All of it, as a run file keeps it.
std::string plan_text(const Plan& plan, const Scene& scene);

/// The same as one JSON object; plan_json.cpp.
Json plan_json(const Plan& plan, const Scene& scene);

}  // namespace pbf::inline program_module
