// The script of `pbf batch --slurm`.
#pragma once

#include <cstddef>
#include <string>

#include "lib/campaign/batch_check.h"

namespace pbf::inline app_module {

/// What a job array is asked for.
struct SlurmWishes {
  std::string command;   ///< the batch on one line, quoted, without --only and --collect
  std::size_t runs = 1;  ///< tasks
  int threads = 4;       ///< CPUs of a task
  std::string time;      ///< of a task, in one of Slurm's forms
  BatchNeeds needs;      ///< of the most demanding run
};

/// Seconds of a time in Slurm's forms: M, M:S, H:M:S, D-H, D-H:M, D-H:M:S. Throws Error(bad_input)
/// for anything else and for less than a minute.
long slurm_seconds(const std::string& text);

/// A script for bash, which hands itself to sbatch as an array and as the job that collects the
/// summary after it, and for sbatch. A task that stops in time goes back into the queue.
std::string slurm_script(const SlurmWishes& wishes);

}  // namespace pbf::inline app_module
