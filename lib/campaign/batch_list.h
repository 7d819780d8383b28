// The runs of `pbf batch`: scenes, and every combination of the values of --grid; the check of all
// of them before the first one starts.
#pragma once

#include <string>
#include <vector>

#include "lib/campaign/batch_jobs.h"
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

/// Reads and plans every run, with `overrides` (key.path=value) applied before its own;
/// `base_folder` as in load_scene(). `here`: every run must fit into the memory of this machine.
/// ranks: of each run; host_bytes are then those of rank 0. If runs cannot run, throws Error with
/// the code of the first, naming up to ten of them with their messages.
std::vector<JobNeeds> check_members(const std::vector<BatchMember>& members,
                                    const std::vector<std::string>& overrides,
                                    const std::string& base_folder, bool here, int ranks = 1);

}  // namespace pbf::campaign_module
