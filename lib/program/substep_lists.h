// How often an update with substeps makes neighbor lists.
#pragma once

#include "lib/scene/scene.h"

namespace pbf::program_module {

/// m/s: largest speed after a fall through the domain; with open faces, after a fall until the end
/// of the run in addition.
double fall_speed(const Scene& scene);

/// h: largest displacement of a particle in one update, from fall_speed() and the fastest body.
double way_per_update(const Scene& scene);

/// Number of lists per update, 1 ... substeps. Substeps that share lists miss pairs that come
/// within h of each other after the lists were made, and can thus gain energy. The number keeps n
/// (u n dt)/h below a limit, for n substeps of dt on one list and fluid of speed u, where u dt =
/// way_per_update()/substeps (kernels/README.md, "Substeps"). With bodies from files, whose
/// velocities are not known here, at most 8 substeps share lists.
int lists_per_update(const Scene& scene);

}  // namespace pbf::program_module
