// Every array of a run and its peak memory, computed from the scene before anything is allocated.
// `pbf plan` prints it, a run that does not fit is refused, and tests compare it with the memory
// that solvers report.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lib/scene/scene.h"

namespace pbf::program_module {

struct Plan;

/// Lifetime of an array: while the solver is created, as long as the solver, while a frame or
/// picture is written, while a checkpoint is written.
enum class Held { start, solver, output, checkpoint };
constexpr const char* kHeldNames[] = {"start", "solver", "output", "checkpoint"};

/// One array, or all arrays of a kind if each thread or frame has one.
struct PlanArray {
  std::string name;  ///< "position", "lists"
  std::string type;  ///< type of a component: float, double, int32, uint32, int64, byte
  int components = 1;
  std::int64_t elements = 0, bytes = 0;
  bool on_device = false;
  Held held = Held::solver;
};

/// Memory that does not grow with the scene: a measured constant.
struct FixedMemory {
  std::string name;
  std::int64_t bytes = 0;
  bool on_device = false;
  bool after_start = false;  ///< allocated only after the solver was created
};

struct MemoryPlan {
  std::vector<PlanArray> arrays;
  std::vector<FixedMemory> fixed;
  /// Peaks without the fixed memory. On the host, resident memory: pages that are never touched do
  /// not count, and arrays of the start count only as far as they exceed later fixed memory.
  std::int64_t host_arrays = 0, device_arrays = 0;

  /// Memory of the solver on its device: SolverInfo.bytes after a measurement and a download.
  std::int64_t solver_bytes() const;
  std::int64_t host_peak() const { return host_arrays + fixed_bytes(false); }
  std::int64_t device_peak() const { return device_arrays + fixed_bytes(true); }
  std::int64_t fixed_bytes(bool on_device) const;
};

/// Neighbors of a particle in fluid at rest, itself included: (4/3) pi (h/d)^3, which is the number
/// of particles of spacing d in a ball of radius h; in two dimensions pi (h/d)^2.
double rest_neighbors(const Scene& scene);

/// Entries planned for one list on the CPU: `rest_neighbors` plus the padding of the lists of a
/// vector (lib/program/simd.h) to the longest. The padding is a tenth, or more if particles start
/// at random positions, because their numbers of neighbors have a Poisson distribution. Lists of
/// 1024 particles share memory, so only the mean matters. The executor allocates more where the
/// fluid is denser.
int cpu_list_entries(const Scene& scene);
/// The mean number of neighbors at the start, and whether it, rather than fluid at rest, determines
/// the size of the lists. Denser fluid at later times is not considered.
struct DenseStart {
  double neighbors = 0;  ///< 0: not counted (Plan::start)
  bool decides = false;
};
DenseStart dense_start(const Scene& scene, const Plan& plan);
/// The end of a message about insufficient memory: what to change in the scene.
std::string memory_remedy(const Scene& scene, const Plan& plan);

/// For the scene's backend and precision (for others, change them in a copy). Pure, except that the
/// number of CPU threads depends on this machine if the scene does not set it, and the padding of
/// lists on the length of its vectors.
MemoryPlan plan_memory(const Scene& scene, const Plan& plan);

/// The memory of the scene on a backend, in a precision.
struct MemoryChoice {
  Backend backend;
  Precision precision;
  MemoryPlan memory;
};
/// One for every backend and precision.
std::vector<MemoryChoice> memory_choices(const Scene& scene, const Plan& plan);

}  // namespace pbf::program_module
