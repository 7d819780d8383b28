// Every array of a run and its peak memory, computed from the scene before anything is allocated.
// `pbf plan` prints it, a run that does not fit is refused by it, and tests compare it with the
// solvers' own count.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lib/scene/scene.h"

namespace pbf::inline program_module {

struct Plan;

/// How long an array lives: while the solver is made, as long as the solver, while a frame or a
/// picture is under way, while a checkpoint is written.
enum class Held { start, solver, output, checkpoint };
const char* held_name(Held held);

/// One array, or one kind of array where threads or frames have one each.
struct PlanArray {
  std::string name;  ///< "position", "lists"
  std::string type;  ///< of a component: float, double, int32, uint32, int64, byte
  int components = 1;
  std::int64_t elements = 0, bytes = 0;
  bool on_device = false;
  Held held = Held::solver;
};

/// Memory that does not grow with the scene: measured, not computed.
struct FixedMemory {
  std::string name;
  std::int64_t bytes = 0;
  bool on_device = false;
  bool after_start = false;  ///< not there yet while the solver is made
};

struct MemoryPlan {
  std::vector<PlanArray> arrays;
  std::vector<FixedMemory> fixed;
  /// Peaks less the fixed memory. Host: what is resident, pages that are never touched left out;
  /// arrays of the start lie where fixed memory comes later, and only what exceeds it counts.
  std::int64_t host_arrays = 0, device_arrays = 0;

  /// What the solver holds where it runs: SolverInfo.bytes after a measure and a download.
  std::int64_t solver_bytes() const;
  std::int64_t host_peak() const { return host_arrays + fixed_bytes(false); }
  std::int64_t device_peak() const { return device_arrays + fixed_bytes(true); }
  std::int64_t fixed_bytes(bool on_device) const;
};

/// Neighbours of a particle in fluid at rest, itself included: the ball of radius h holds
/// (4/3) pi (h/d)^3 particles of spacing d, the disc pi (h/d)^2.
double rest_neighbors(const Scene& scene);

/// Room of one list on the CPU: `rest_neighbors`, and what fills up groups of up to 16 lists to the
/// longest: a tenth, and more where particles start at random places, whose numbers of neighbours
/// scatter like Poisson's. Lists of 1024 particles share their room, so it is the mean that counts;
/// where the fluid is denser the executor takes more.
int cpu_list_entries(const Scene& scene);
/// Mean number of neighbours at the start, and whether that, not fluid at rest, decides the size of
/// the lists. Later the fluid may crowd more than it did at the start; that is not foreseen.
struct StartCrowd {
  double neighbors = 0;  ///< 0: not counted (Plan::start)
  bool decides = false;
};
StartCrowd start_crowd(const Scene& scene, const Plan& plan);
/// What to change where the memory does not suffice, for the end of a message.
std::string memory_remedy(const Scene& scene, const Plan& plan);

/// Room for the lists that one thread makes: those of 1024 particles, and of one group.
constexpr std::int64_t cpu_scratch_entries(int list_entries) {
  return (1024 + 32) * std::int64_t(list_entries);
}

/// For the scene's backend and precision (change them in a copy for the others). Pure but for the
/// number of CPU threads, which depends on this machine where the scene leaves it open.
MemoryPlan plan_memory(const Scene& scene, const Plan& plan);

/// The memory of the scene on a backend, in a precision.
struct MemoryChoice {
  Backend backend;
  Precision precision;
  MemoryPlan memory;
};
/// One for every backend and precision.
std::vector<MemoryChoice> memory_choices(const Scene& scene, const Plan& plan);

}  // namespace pbf::inline program_module
