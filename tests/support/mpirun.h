// Runs of the program on several ranks, as processes of mpirun.
#pragma once

#include <csignal>
#include <cstdlib>
#include <string>

#include "tests/support/process.h"

namespace pbf::test {

inline bool has_mpi() {
  return std::filesystem::exists(std::filesystem::path(PBF_BINARY).parent_path() /
                                 "libpbf_mpi.so") &&
         std::system("mpirun --version > /dev/null 2>&1") == 0;
}
/// Open MPI, also for root in a container, with more ranks than cores, of which none waits on a
/// core.
inline Process start_mpirun(const Args& args, const Scratch& folder,
                            const Args& more_environment = {}) {
  Args environment = {"OMPI_ALLOW_RUN_AS_ROOT=1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1",
                      "OMPI_MCA_mpi_yield_when_idle=1", "OMPI_MCA_rmaps_base_oversubscribe=1",
                      "OMPI_MCA_btl_vader_single_copy_mechanism=none"};
  environment.insert(environment.end(), more_environment.begin(), more_environment.end());
  Args words = {"/usr/bin/env", "mpirun"};
  words.insert(words.end(), args.begin(), args.end());
  return Process::program(words, folder.path(), environment);
}
inline Process start_ranks(int ranks, const Args& args, const Scratch& folder,
                           const Args& more_environment = {}) {
  Args words = {"-n", std::to_string(ranks), PBF_BINARY};
  words.insert(words.end(), args.begin(), args.end());
  return start_mpirun(words, folder, more_environment);
}
inline Outcome on_ranks(int ranks, const Args& args, const Scratch& folder) {
  return start_ranks(ranks, args, folder).wait();
}
/// The process of a rank that works in the folder; -1: there is none (yet).
inline pid_t process_of_rank(int rank, const Scratch& folder) {
  const std::string word = "OMPI_COMM_WORLD_RANK=" + std::to_string(rank);
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/proc", error)) {
    const std::string name = entry.path().filename().string();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    if (std::filesystem::read_symlink(entry.path() / "cwd", error) != folder.path() || error)
      continue;
    const std::string environment = '\0' + read_text(entry.path() / "environ");
    if (has(environment, '\0' + word + '\0')) return pid_t(std::stol(name));
  }
  return -1;
}

}  // namespace pbf::test
