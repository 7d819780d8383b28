// The runs of `pbf batch`: scenes, and every combination of the values of --grid.
#pragma once

#include <string>
#include <vector>

#include "lib/campaign/grid.h"

namespace pbf::inline campaign_module {

struct BatchMember {
  std::string name;                    ///< of the run, its folder and its row: unique
  std::string scene;                   ///< path
  std::vector<std::string> overrides;  ///< key.path=value: of the list, then of the grid
};

/// The name of a scene, a folder, a list or a run in those of its runs and of their folder: its
/// file's, without the ending; of the files that every run has, such as run.vtkhdf, their folder's.
std::string batch_stem(const std::string& input);

/// Of `--grid key=v1,v2` and key=first:last:count. Throws Error(bad_input) for anything else.
GridAxis parse_axis(const std::string& text);

/// `input`: a folder (its *.yaml and *.yml, in order of names), a scene (*.yaml, *.yml, or a run
/// file *.vtkhdf), or a list: a text file with a scene, or a run's file or folder, on each line,
/// relative to the list, followed by key.path=value where wanted; # begins a comment. The last axis
/// runs fastest. Throws Error(bad_input) naming file and line.
std::vector<BatchMember> batch_members(const std::string& input, std::vector<GridAxis> axes);

}  // namespace pbf::inline campaign_module
