// The script of `pbf batch --slurm`.
#pragma once

#include <cstddef>
#include <string>

#include "lib/campaign/batch_list.h"

namespace pbf::app_module {

/// Requests of a job array.
struct SlurmWishes {
  std::string command;   ///< the batch on one line, quoted, without --only and --collect
  std::size_t runs = 1;  ///< tasks
  int ranks = 1;         ///< of each run
  int threads = 4;       ///< CPUs per rank
  std::string time;      ///< time limit per task, in one of Slurm's forms
  JobNeeds needs;        ///< most memory, and whether any run needs a GPU
};

/// Seconds of a time in Slurm's forms: M, M:S, H:M:S, D-H, D-H:M, D-H:M:S. Throws Error(bad_input)
/// for other texts and for less than a minute.
long slurm_seconds(const std::string& text);

/// `text` as one word of bash on one line: unquoted if that is safe, else in single quotes or, with
/// control characters (a line break would end a comment), in $'...' with escapes.
std::string shell_quoted(const std::string& text);

/// A script for bash and sbatch: run by bash, it submits itself as an array, and as a job that
/// collects the summary afterwards. A task that reaches its time limit returns to the queue.
std::string slurm_script(const SlurmWishes& wishes);

}  // namespace pbf::app_module
