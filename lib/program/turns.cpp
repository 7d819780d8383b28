#include "lib/program/turns.h"

#include "lib/program/features/poses.h"
#include "lib/program/loads.h"

namespace pbf::program_module {

bool takes_turns(const Scene& s, const Plan& plan) {
  const bool few = is_fast_on_gpu(s) && plan.particles <= kMostInTurns;
  const bool one_step = plan.substeps == 1 && plan.finest_level == 0;
  const bool rounds = s.solver.iterations > 0 && s.solver.iterations <= kMostTurns &&
                      s.solver.fused && s.solver.kernels == KernelMode::consistent &&
                      plan.levels.all.count == 0 && (!s.tensile || s.tensile->n == 4);
  const bool in_a_box = s.dimensions == 3 && !has_obstacles(s) && !has_wall_loads(s) &&
                        !changes_rows(s) && s.domain.periodic.empty();
  return few && one_step && rounds && in_a_box;
}

}  // namespace pbf::program_module
