// Ranks that are processes started by mpirun or srun, on MPI. MPI is opened at run time through the
// module pbf_mpi.c; a program that runs alone does not open it.
#pragma once

#include <memory>

#include "lib/exec/ranks/communicator.h"

namespace pbf::exec_module {

/// The number of ranks with which a launcher of MPI or Slurm has started this process; 1: none.
int launched_ranks();
/// The rank of this process among them, as far as the environment says.
int launched_rank();
/// Its number among those on this machine.
int launched_local_rank();

class MpiRanks : public Communicator {
 public:
  /// Whether fail() was called: the other ranks may wait for this one.
  virtual bool failed() const = 0;
  /// The last call of every rank. After fail() it ends all processes with this code.
  virtual void end(int code) = 0;
};
/// Throws Error(unavailable), with the command that makes the module, if it is not found.
std::unique_ptr<MpiRanks> open_mpi_ranks();

}  // namespace pbf::exec_module
