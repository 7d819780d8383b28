// The stages of a run: one name everywhere, in timers, run.vtkhdf, `pbf plan`, `pbf bench` and
// plots. This is the only list: `pbf config --stages` writes tools/pbf_tools/data/stages.json, and
// tests compare that file and the table of app/README.md with this list.
#pragma once

namespace pbf::base_module {

/// Groups of stages whose times the summary of a run adds up. An index of kStageGroups.
enum class StageGroup { init, grid, density, lambda, delta, move, exchange, output };

struct StageGroupInfo {
  const char *name, *color;  ///< color: of plots, #rrggbb
};

inline constexpr StageGroupInfo kStageGroups[] = {{"initialization", "#000000"},
                                                  {"grid/neighbors", "#D55E00"},
                                                  {"densities", "#009E73"},
                                                  {"lambdas", "#0072B2"},
                                                  {"deltas", "#56B4E9"},
                                                  {"position/velocity updates", "#CC79A7"},
                                                  {"exchange between ranks", "#7F4F24"},
                                                  {"post-processing", "#8A8A8A"}};

struct Stage {
  const char* name;
  StageGroup group;
  bool of_update;  ///< part of an update, and thus a column of `pbf bench`
  const char* color;
};

inline constexpr Stage kStages[] = {{"init", StageGroup::init, false, "#000000"},
                                    {"predict", StageGroup::move, true, "#F0E442"},
                                    {"grid", StageGroup::grid, true, "#E69F00"},
                                    {"neighbors", StageGroup::grid, true, "#D55E00"},
                                    {"density", StageGroup::density, true, "#009E73"},
                                    {"lambda", StageGroup::lambda, true, "#0072B2"},
                                    {"levels", StageGroup::lambda, true, "#88CCAA"},
                                    {"delta", StageGroup::delta, true, "#56B4E9"},
                                    {"residual", StageGroup::lambda, true, "#1B3A5C"},
                                    {"xsph", StageGroup::move, true, "#CC79A7"},
                                    {"vorticity", StageGroup::move, true, "#7A3E9D"},
                                    {"hyperviscosity", StageGroup::move, true, "#B387C9"},
                                    {"exchange", StageGroup::exchange, true, "#7F4F24"},
                                    {"measure", StageGroup::output, false, "#B0B0B0"},
                                    {"guard", StageGroup::output, false, "#C4B08B"},
                                    {"download", StageGroup::output, false, "#8A8A8A"},
                                    {"write", StageGroup::output, false, "#666666"},
                                    {"render", StageGroup::output, false, "#444444"}};

}  // namespace pbf::base_module
