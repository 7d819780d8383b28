// What pbf batch is told, and what follows from it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/options.h"
#include "lib/campaign/batch_list.h"

namespace pbf::app_module {

struct BatchOptions : SceneOptions {
  std::string input;              ///< folder, scene or list
  std::string out;                ///< folder of the runs; empty: out/batch_<name>
  std::vector<std::string> grid;  ///< key=v1,v2
  int jobs = 0;                   ///< at a time; 0: as the help says
  int threads = 0;                ///< CPU threads per run, 0: all / jobs
  std::string share = "auto";     ///< which runs share a process
  int ranks = 1;                  ///< per run of the Slurm script
  std::int64_t only = -1;         ///< index of the only run, from 0; -1: all
  double max_walltime = 0;        ///< s, 0: none
  std::string time = "1:00:00";   ///< per task of the Slurm script
  bool list = false, slurm = false, collect = false, quiet = false;
  bool strict = false;  ///< for every run
};

/// The options that a batch hands on to each run.
std::vector<std::string> options_of_runs(const BatchOptions& options);
JobLimits limits(const BatchOptions& options);
/// CPU threads of each run; 0: as its scene says. sharing: runs that may share a process with it.
int threads_of_run(const BatchOptions& options, std::int64_t sharing = 0);
/// The Slurm script. Throws as check_members() and slurm_seconds() do.
std::string slurm_text(const BatchOptions& options, const std::string& out,
                       const std::vector<BatchMember>& members);

}  // namespace pbf::app_module
