// The stages of a run: one name everywhere, in timers, run.vtkhdf, `pbf plan`, `pbf bench` and
// plots.
#pragma once

namespace pbf::inline base_module {

/// What the summary of a run adds up.
enum class StageGroup { init, grid, density, lambda, delta, move, output };

/// By StageGroup.
inline constexpr const char* kStageGroupNames[] = {
    "initialization", "gridding/neighbours",       "densities",      "lambdas",
    "deltas",         "position/velocity updates", "post-processing"};

struct Stage {
  const char* name;
  StageGroup group;
  bool of_update;  ///< of an update, not around it: a column of `pbf bench`
};

inline constexpr Stage kStages[] = {
    {"init", StageGroup::init, false},      {"predict", StageGroup::move, true},
    {"grid", StageGroup::grid, true},       {"neighbors", StageGroup::grid, true},
    {"density", StageGroup::density, true}, {"lambda", StageGroup::lambda, true},
    {"levels", StageGroup::lambda, true},   {"delta", StageGroup::delta, true},
    {"residual", StageGroup::lambda, true}, {"xsph", StageGroup::move, true},
    {"vorticity", StageGroup::move, true},  {"measure", StageGroup::output, false},
    {"guard", StageGroup::output, false},   {"download", StageGroup::output, false},
    {"write", StageGroup::output, false},   {"render", StageGroup::output, false}};

}  // namespace pbf::inline base_module
