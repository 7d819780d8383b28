// How often an update with substeps makes neighbour lists.
#pragma once

#include "lib/scene/scene.h"

namespace pbf::inline program_module {

/// m/s: the fastest fall from one side of the domain to the other; through an open face, until the
/// end of the run.
double fall_speed(const Scene& scene);

/// h: how far a particle goes in one update at most, by fall_speed() and the fastest body.
double way_per_update(const Scene& scene);

/// Lists of one update, 1 ... substeps. Substeps that share lists miss the pairs that come within h
/// of each other since. The next lists find them too near and part them within one substep, with a
/// speed of (what they have approached)/(one substep). For a fluid of speed u and n substeps of dt
/// on one list this is n u at most, and so has a bound only where n (u n dt)/h has one
/// (kernels/README.md, "Substeps"). u dt: way_per_update()/substeps. With bodies of files, whose
/// velocities are not known here, at most 8 substeps share lists.
int lists_per_update(const Scene& scene);

}  // namespace pbf::inline program_module
