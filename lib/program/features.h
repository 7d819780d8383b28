// All features, in the order of their passes in an update. This is the only list: every executor
// instantiates its passes, and programs are made from it.
#pragma once

#include <tuple>

#include "lib/program/features/bodies.h"
#include "lib/program/features/confinement.h"
#include "lib/program/features/constraint.h"
#include "lib/program/features/correction.h"
#include "lib/program/features/emission.h"
#include "lib/program/features/gauges.h"
#include "lib/program/features/hyperviscosity.h"
#include "lib/program/features/levels.h"
#include "lib/program/features/loads.h"
#include "lib/program/features/motion.h"
#include "lib/program/features/solids.h"
#include "lib/program/features/sponge.h"
#include "lib/program/features/time_order.h"
#include "lib/program/features/viscosity.h"

namespace pbf::PBF_VARIANT {

/// The memory of feature F in one solver.
template <class F, class Real>
struct MemoryOf : NoMemory {};
template <class F, class Real>
requires requires { typename F::template Memory<Real>; }
struct MemoryOf<F, Real> : F::template Memory<Real> {};

template <class... Fs>
struct FeatureList {
  using Passes = typename Joined<typename Fs::Passes...>::type;
  // The passes that make_program() and the stepper know.
  using Predict = pbf::Predict;
  using Sort = pbf::Sort;
  using MakeLists = pbf::MakeLists;
  static void add(const Scene& scene, auto& b) { (Fs::add(scene, b), ...); }
  /// Whether passes may add or remove particles (kernels/row_state.h).
  static constexpr bool changes_rows = (false || ... || requires { Fs::changes_rows; });
  template <class Real>
  using Memory = std::tuple<MemoryOf<Fs, Real>...>;
  template <class... More>
  using With = FeatureList<Fs..., More...>;
};

using Features = FeatureList<Motion, NearSolids, FreeBodies, Constraint, Levels, Correction,
                             Emission, Viscosities, VorticityConfinement, Sponges, Loads, Gauges,
                             StepLengths, Hyperviscosities>;
using Passes = Features::Passes;

}  // namespace pbf::PBF_VARIANT
