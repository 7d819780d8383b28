// One simulation on several ranks, behind the interface of a solver. Rank 0 decides; the others do
// what it says.
#pragma once

#include <memory>

#include "lib/base/error.h"
#include "lib/exec/ranks/communicator.h"
#include "lib/exec/ranks/held_frame.h"
#include "lib/exec/ranks/packing.h"
#include "lib/program/plan.h"
#include "lib/solver/solver.h"
#include "lib/solver/split_rows.h"

namespace pbf::exec_module {

/// Throws Error(bad_input) if a scene cannot run on so many ranks: for what is in it, or because
/// the grid has too few layers.
void require_ranks(const Scene& scene, const Plan& plan, int ranks);

/// Made on every rank at the same time, with the same scene and plan. The
/// results have the bits of a solver on one rank. Rank 0 calls the functions of Solver, the others
/// serve(). An error on any rank is thrown on all of them.
class RankedSolver final : public Solver, public Inspection, public SplitRows {
 public:
  /// particles: those of FirstRanks (rank_states.h). Throws Error(bad_input) as
  /// require_ranks().
  RankedSolver(Communicator& ranks, const Scene& scene, const Plan& plan, Particles particles);
  ~RankedSolver() override;
  /// Not on rank 0: does what rank 0 calls, until the solver of rank 0 ends.
  void serve();
  /// At its end it moves the positions of the last moves() there, those of this rank's range of
  /// ids.
  void leave_positions_to(std::vector<double>& place) { left_ = &place; }

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

  SplitRows* split() override { return this; }
  Snapshot hold(const std::vector<std::string>& fields, ScalarType type) override;
  void held(std::size_t field, std::int64_t most, const TakeRows& take) override;
  bool share_file(const std::string& path, std::uint64_t inode) override;
  void write_held(const FramePlaces& places) override;
  bool written(bool wait) override;
  void state_in_pieces(StateOf which, std::int64_t most, const StateSink& to) override;
  void set_state_in_pieces(const StateSource& from) override;
  void go_back() override;
  Moves moves() override;

 private:
  enum class What {
    step,
    diagnose,
    readings,
    keep,
    hold,
    held,
    share_file,
    write_held,
    written,
    state,
    set_state,
    go_back,
    moves,
    end
  };
  void say(What what, const Packer& arguments = {});
  /// f() takes part in the same exchanges on all ranks.
  template <class F>
  auto on_all(const F& f) -> decltype(f()) {
    try {
      return f();
    } catch (const Error& e) {
      ended_ = true;
      ranks_.fail(e.what(), int(e.code()));
      throw;
    } catch (const std::exception& e) {
      ended_ = true;
      ranks_.fail(e.what(), int(ExitCode::internal));
      throw;
    }
  }
  void obey(What what, Unpacker& from);
  void step_here(int updates, const StepOptions& options);
  /// What each rank does for the functions of SplitRows; `from` is null on the others.
  void give_state(StateOf which, std::int64_t most, const StateSink& to);
  void take_state(const StateSource* from);
  Moves add_moves();

  Inspection& alone();

  Communicator& ranks_;
  const Scene whole_scene_, scene_;  ///< that of all particles, and that of a rank
  const Plan whole_plan_, plan_;
  std::unique_ptr<Solver> local_, alone_;
  HeldFrame frame_;
  std::vector<double>* left_ = nullptr;
  std::vector<double> before_;  ///< positions of this rank's range of ids at the last moves(), h
  bool ended_ = false;
};

}  // namespace pbf::exec_module
