// The runs of `pbf batch`: scenes, and every combination of the values of --grid.
#pragma once

#include <string>
#include <vector>

#include "lib/campaign/grid.h"

namespace pbf::campaign_module {

struct BatchMember {
  std::string name;                    ///< unique name of the run, its folder and its row
  std::string scene;                   ///< path
  std::vector<std::string> overrides;  ///< key.path=value: of the list, then of the grid
};

/// Short name of a scene, folder, list or run, for names of runs and of their folder: the file name
/// without ending or, for a file that every run has (run.vtkhdf), the name of its folder.
std::string batch_stem(const std::string& input);

/// Parses `--grid key=v1,v2` or key=first:last:count. Throws Error(bad_input) for anything else.
GridAxis parse_axis(const std::string& text);

/// `input`: a folder (its *.yaml and *.yml in order of names), a scene (*.yaml, *.yml, or a run
/// file *.vtkhdf), or a list: a text file with a scene, run file or run folder per line, relative
/// to the list, optionally followed by key.path=value; # begins a comment. The last axis varies
/// fastest. Throws Error(bad_input) with file and line.
std::vector<BatchMember> batch_members(const std::string& input, std::vector<GridAxis> axes);

}  // namespace pbf::campaign_module
