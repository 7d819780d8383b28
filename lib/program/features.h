// All features, in the order of their passes in an update. This is the only list: every executor
// instantiates its passes, and programs are made from it.
#pragma once

#include "lib/program/features/confinement.h"
#include "lib/program/features/constraint.h"
#include "lib/program/features/correction.h"
#include "lib/program/features/gauges.h"
#include "lib/program/features/levels.h"
#include "lib/program/features/loads.h"
#include "lib/program/features/motion.h"
#include "lib/program/features/solids.h"
#include "lib/program/features/viscosity.h"

namespace pbf::inline PBF_VARIANT {

template <class... Fs>
struct FeatureList {
  using Passes = typename Joined<typename Fs::Passes...>::type;
  template <class B>
  static void add(const Scene& scene, B& b) {
    (Fs::add(scene, b), ...);
  }
};

using Features = FeatureList<Motion, NearSolids, Constraint, Levels, Correction, XsphViscosity,
                             VorticityConfinement, Loads, Gauges>;
using Passes = Features::Passes;

}  // namespace pbf::inline PBF_VARIANT
