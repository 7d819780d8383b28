// Everything that a run needs, computed from the scene before anything is allocated: program,
// arrays, grid and files. The plan depends only on the scene and the number of particles.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernels/axes.h"
#include "lib/base/json.h"
#include "lib/program/column.h"
#include "lib/program/emission.h"
#include "lib/program/gauges.h"
#include "lib/program/hyperviscosity.h"
#include "lib/program/levels.h"
#include "lib/program/memory.h"
#include "lib/program/obstacles.h"
#include "lib/program/program.h"
#include "lib/scene/scene.h"
#include "lib/scene/viscosity.h"

namespace pbf::program_module {

/// What a start says that the scene alone does not: neighbors of a sample of the particles, spread
/// evenly over their ids, and where the particles of files are.
struct StartNeighbors {
  std::vector<int> count;       ///< particles within h, the particle itself included
  std::vector<double> scatter;  ///< standard deviation of the counts nearby; 0: sample too small
  BodyBox of_files = kNoBox;
  bool empty() const { return count.empty(); }  ///< no place can be denser than fluid at rest
};

/// Output files of one kind, with their estimated size.
struct PlanFile {
  std::string name;                    ///< "run.vtkhdf", "frames/frame_*.png"
  std::int64_t number = 1, bytes = 0;  ///< bytes: total of all files
  std::string note;                    ///< "101 frames"
};

struct Plan {
  std::int64_t particles = 0;  ///< at the start
  std::int64_t capacity = 0;   ///< rows of the arrays: of as many particles as may be, and images
  std::int64_t images = 0;     ///< rows for images beyond periodic faces, among them
  StartNeighbors start;        ///< lib/run/start_neighbors.h
  double cell_edge = 1;        ///< in h, >= 1: larger only if the box would need too many cells
  Axes axes;                   ///< of the internal frame; lib/program/axes.h
  int cells[3] = {1, 1, 1};    ///< of the grid, along the internal axes; half cells along x
  double vol = 1;              ///< m/(rho0 h^3), in 2-D m/(rho0 h^2 thickness); calibrate.h
  double wall_scale = 1, wall_range = 1;  ///< amplitude; range in h
  /// omega, the step length of the iterations: the key solver.sor, or a default that depends on h/d
  /// and on levels (kernels/README.md, "Step length").
  double sor = 1;
  Hyperviscosity hyperviscosity;
  ViscousSweeps viscosity;  ///< of updates of one step; shorter steps have a smaller factor
  /// Factors on omega, one per iteration of a substep; empty: all are 1 (solver.method: jacobi).
  std::vector<double> sor_factors;
  int substeps = 1;
  int lists_per_update = 1;  ///< substeps share lists (substep_lists.h)
  int finest_level = 0;      ///< of time.adaptive: an update is up to 2^finest_level steps
  double tolerance =
      0;            ///< mean compression above which the iterations are repeated; 0: they are not
  int repeats = 0;  ///< maximum number of these repetitions
  double mass = 0;  ///< kg, of one particle
  double dissipation_unit = 1;  ///< h^2/s^2 (kernels/dissipation.h); the same for all steps
  LevelPlan levels;
  bool turns = false;                  ///< takes_turns()
  bool packed = false;                 ///< packs_rows()
  std::vector<Solid<double>> solids;   ///< of obstacles, in internal axes; lib/program/obstacles.h
  std::vector<Solid<double>> casings;  ///< and a bore for each, of emitters; lib/program/emission.h
  GaugePlan gauges;
  EmissionPlan emission;
  std::vector<ReadingColumn> columns;  ///< of readings: reading_columns()
  Program program;
  MemoryPlan memory;
  std::vector<LeftOut> left_out;
  std::vector<PlanFile> files;

  std::int64_t bytes() const { return memory.solver_bytes(); }
  UpdateShape shape() const;
  std::int64_t most_particles() const { return capacity - images; }
};

/// Number of datasets of run.vtkhdf, including the columns of log and gauges. Each has an index.
double run_file_datasets(const Plan& plan, const Scene& scene);

/// Pure: touches no file and no device. `particles`: from count_particles(). `start`: from
/// start_neighbors(), for the memory of a over-dense start; without it, the start is planned as
/// fluid at rest.
Plan make_plan(const Scene& scene, std::int64_t particles, StartNeighbors start = {});

/// The plan in a few numbers.
struct PlanTotals {
  std::int64_t updates = 0;
  std::int64_t settling = 0;  ///< updates before time 0, not among `updates`
  double end = 0;             ///< s, simulated: whole updates
  /// Peak memory of the run, including program and libraries; device: 0 on the CPU.
  std::int64_t host_bytes = 0, device_bytes = 0;
  std::int64_t disk_bytes = 0;  ///< of all files
};
PlanTotals plan_totals(const Plan& plan, const Scene& scene);

// The plan as text, in parts.

/// The most important facts in five lines: particles, time, run time, memory, disk. `run_time`: the
/// text of its line; empty: no such line.
std::string plan_summary(const Plan& plan, const Scene& scene, const std::string& run_time);
/// Files, memory by backend and precision, grid, passes, and what is left out with the reasons.
std::string plan_details(const Plan& plan, const Scene& scene);
/// Every array with its type, life, place and size, and the memory that is fixed.
std::string plan_arrays(const Plan& plan, const Scene& scene);
/// All of it, as a run file keeps it.
std::string plan_text(const Plan& plan, const Scene& scene);

/// The same as one JSON object; plan_json.cpp.
Json plan_json(const Plan& plan, const Scene& scene);

}  // namespace pbf::program_module
