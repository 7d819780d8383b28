// Scenes of few particles, whose lists and iterations a GPU runs in one launch.
#pragma once

#include "lib/program/plan.h"

namespace pbf::program_module {

inline constexpr std::int64_t kMostInTurns = 24000;  ///< particles for which this is faster
inline constexpr int kMostTurns = 32;                ///< iterations

/// Whether lambda and delta, also alone, are those of lib/exec/cuda/turns.cuh. It follows from the
/// scene, not from the card or the number of ranks: these passes add in an order of their own.
bool takes_turns(const Scene& scene, const Plan& plan);

}  // namespace pbf::program_module
