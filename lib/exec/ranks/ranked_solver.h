// One simulation on several ranks, behind the interface of a solver. Rank 0 decides; the others do
// what it says.
#pragma once

#include <memory>

#include "lib/exec/ranks/communicator.h"
#include "lib/exec/ranks/packing.h"
#include "lib/program/plan.h"
#include "lib/solver/solver.h"

namespace pbf::exec_module {

/// Throws Error(bad_input) if a scene cannot run on so many ranks: for what is in it, or because
/// the grid has too few layers.
void require_ranks(const Scene& scene, const Plan& plan, int ranks);

/// Made on every rank at the same time, with the same scene and plan. The
/// results have the bits of a solver on one rank. Rank 0 calls the functions of Solver, the others
/// serve(). An error on any rank is thrown on all of them.
class RankedSolver final : public Solver, public Inspection {
 public:
  /// particles: those of ids_of_ranks() (rank_states.h). Throws Error(bad_input) as
  /// require_ranks().
  RankedSolver(Communicator& ranks, const Scene& scene, const Plan& plan, Particles particles);
  ~RankedSolver() override;
  /// Not on rank 0: does what rank 0 calls, until the solver of rank 0 ends.
  void serve();

  void step(int updates, const StepOptions& options = {}) override;
  std::future<Snapshot> download(const std::vector<std::string>& fields, ScalarType type) override;
  Diagnostics diagnose() override;
  std::vector<double> readings(Series series, Interval interval) override;
  SolverState state(StateOf which) override;
  void set_state(const SolverState& state) override;
  void keep() override;
  SolverInfo info() const override;
  std::int64_t updates() const override { return local_->updates(); }

  /// Rank 0 examines updates of all particles on its own.
  Inspection* inspection() override { return this; }
  StepTrace trace(const TraceOptions& options) override;
  std::optional<StageEvent> step_checked(const StageLimits& limits,
                                         const StepOptions& options) override;
  /// Throws Error(internal): no command that runs on several ranks needs it.
  void inject(const Fault& fault) override;

 private:
  enum class What { step, download, diagnose, readings, state, set_state, keep, end };
  void say(What what, const Packer& arguments);
  /// f() takes part in the same exchanges on all ranks.
  template <class F>
  auto on_all(const F& f) -> decltype(f());
  Snapshot whole(const Snapshot& mine, const std::vector<std::string>& fields, ScalarType type);
  SolverState whole(const SolverState& mine, StateOf which);

  Inspection& alone();

  Communicator& ranks_;
  const Scene whole_scene_, scene_;  ///< that of all particles, and that of a rank
  const Plan whole_plan_, plan_;
  std::unique_ptr<Solver> local_, alone_;
  bool ended_ = false;
};

}  // namespace pbf::exec_module
