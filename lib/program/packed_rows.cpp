#include "lib/program/packed_rows.h"

namespace pbf::program_module {

bool packs_rows(const Scene& s, const Plan& plan) {
  const bool many = is_fast_on_gpu(s) && plan.particles > kMostUnpacked;
  const bool fused =
      s.solver.iterations > 0 && s.solver.fused && s.solver.kernels == KernelMode::consistent;
  const bool at_rows = s.domain.periodic.empty() && !changes_rows(s);
  return many && fused && at_rows && s.dimensions == 3;
}

}  // namespace pbf::program_module
