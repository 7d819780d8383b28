// The step length of the iterations: its default, and how large it may be.
#pragma once

#include <string>

#include "lib/scene/scene.h"

namespace pbf::program_module {

/// omega without the key solver.sor: the largest with which still water stays still. It falls with
/// the number of neighbors. With one or two iterations in a substep it is smaller, because the
/// velocity then takes part in the iteration, and smaller in time steps of second order.
/// kernels/README.md, "Step length".
double default_sor(const Scene& scene);

/// The largest omega that is known to be safe.
double sor_limit(const Scene& scene);

/// A warning for omega above that: what may happen, and what to do; empty if there is no need.
std::string sor_text(const Scene& scene);

}  // namespace pbf::program_module
