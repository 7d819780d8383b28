// The CUDA solver in its two variants: fast, and with the host's bits (solver.reproducible).
#pragma once

#include <memory>

#include "lib/exec/ranks/communicator.h"
#include "lib/program/list_capacity.h"
#include "lib/solver/solver.h"

namespace pbf {

namespace plain {
std::unique_ptr<Solver> make_stepping_solver(const Scene& scene, const Plan& plan,
                                             Particles particles, ListCapacity capacity,
                                             Communicator* ranks);
}
namespace pinned {
std::unique_ptr<Solver> make_stepping_solver(const Scene& scene, const Plan& plan,
                                             Particles particles, ListCapacity capacity,
                                             Communicator* ranks);
}

}  // namespace pbf
