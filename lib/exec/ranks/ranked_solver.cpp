#include "lib/exec/ranks/ranked_solver.h"

#include <fmt/core.h>
#include <numeric>
#include <utility>

#include "lib/exec/make_solver.h"
#include "lib/exec/ranks/rank_states.h"
#include "lib/exec/ranks/slabs.h"
#include "lib/program/exchanges.h"
#include "lib/program/rank_plan.h"
#include "lib/solver/step_solver.h"

namespace pbf::exec_module {
namespace {

/// Why a scene cannot run on several ranks; null: it can.
const char* why_one_rank(const Scene& s) {
  if (!s.emitters.empty()) return "its emitters change the number of particles";
  if (!s.sinks.empty()) return "its sinks change the number of particles";
  if (changes_rows(s)) return "the number of its particles changes";
  if (has_free_bodies(s)) return "the fluid moves some of its obstacles (obstacles[].free)";
  if (!s.domain.periodic.empty()) return "it has periodic axes (domain.periodic)";
  for (const Gauge& g : s.gauges)
    if (std::holds_alternative<gauge_keys::Flow>(g.kind))
      return "flow gauges count on one rank; leave them out";
  return nullptr;
}

}  // namespace

void require_ranks(const Scene& scene, const Plan& plan, int ranks) {
  if (const char* why = why_one_rank(scene))
    throw Error(ExitCode::bad_input,
                "scene " + scene.name + " cannot run on several ranks: " + why);
  Slabs(std::vector<std::int64_t>(std::size_t(plan.cells[2])), ranks, layers_per_unit(plan));
}

RankedSolver::RankedSolver(Communicator& ranks, const Scene& scene, const Plan& plan,
                           Particles particles)
    : ranks_(ranks),
      whole_scene_(scene),
      scene_(scene_of_rank(plan, scene, ranks.size())),
      whole_plan_(plan),
      plan_(plan_of_rank(plan, scene_)),
      frame_(ranks, plan.particles) {
  require_ranks(scene, plan, ranks.size());
  on_all([&] { local_ = make_solver(scene_, plan_, std::move(particles), &ranks_); });
}
RankedSolver::~RankedSolver() {
  if (left_) *left_ = std::move(before_);
  if (ranks_.rank() == 0 && !ended_) try {
      say(What::end);
    } catch (const std::exception&) {  // the others have failed
    }
}

void RankedSolver::say(What what, const Packer& arguments) {
  Packer all;
  all.add(what);
  all.bytes.insert(all.bytes.end(), arguments.bytes.begin(), arguments.bytes.end());
  ranks_.broadcast(all.bytes);
}
void RankedSolver::serve() {
  on_all([&] {
    for (;;) {
      std::vector<char> bytes;
      ranks_.broadcast(bytes);
      Unpacker from(bytes);
      const auto what = from.take<What>();
      if (what == What::end) return;
      obey(what, from);
    }
  });
}
void RankedSolver::obey(What what, Unpacker& from) {
  switch (what) {
    case What::step: {
      const int updates = from.take<int>();
      return step_here(updates, from.take<StepOptions>());
    }
    case What::diagnose:
      return void(local_->diagnose());
    case What::readings: {
      const auto series = from.take<Series>();
      return void(local_->readings(series, from.take<Interval>()));
    }
    case What::keep:
      return local_->keep();
    case What::hold: {
      const auto fields = from.take<std::vector<std::string>>();
      const auto type = from.take<ScalarType>();
      return void(frame_.hold([&] { return local_->download(fields, type).get(); }));
    }
    case What::held: {
      const auto field = from.take<std::size_t>();
      return frame_.held(field, from.take<std::int64_t>(), {});
    }
    case What::share_file: {
      const auto path = from.take<std::string>();
      return void(frame_.share_file(path, from.take<std::uint64_t>()));
    }
    case What::write_held: {
      FramePlaces places{from.take<std::int64_t>(), {}};
      places.chunks.resize(from.take<std::size_t>());
      for (auto& chunks : places.chunks) from.take(chunks);
      return frame_.write(places);
    }
    case What::written:
      return void(frame_.written(from.take<bool>()));
    case What::state: {
      const auto which = from.take<StateOf>();
      return give_state(which, from.take<std::int64_t>(), {});
    }
    case What::set_state:
      return take_state(nullptr);
    case What::go_back:
      return local_->set_state(local_->state(StateOf::kept));
    case What::moves:
      return void(add_moves());
    case What::end:
      return;
  }
}

void RankedSolver::step(int updates, const StepOptions& options) {
  say(What::step, Packer().add(updates).add(options));
  on_all([&] { step_here(updates, options); });
}
void RankedSolver::step_here(int updates, const StepOptions& options) {
  if (!options.without_time) std::vector<double>().swap(before_);  // moves() is not for updates
  local_->step(updates, options);
}

/// On rank 0 the particles of all ranks, in the order of ids.
std::future<Snapshot> RankedSolver::download(const std::vector<std::string>& fields,
                                             ScalarType type) {
  Snapshot all = hold(fields, type);
  for (std::size_t k = 0; k < all.fields.size(); ++k) {
    std::vector<std::byte>& bytes = all.fields[k].bytes;
    if (all.fields[k].name != "id")
      held(k, kPieceRows, [&](std::int64_t, FieldArray&& rows) {
        bytes.insert(bytes.end(), rows.bytes.begin(), rows.bytes.end());
      });
    else
      bytes = std::move(empty_snapshot({}, type, all.count, 0, 0).fields.back().bytes);
  }
  std::promise<Snapshot> done;
  done.set_value(std::move(all));
  return done.get_future();
}

Diagnostics RankedSolver::diagnose() {
  say(What::diagnose);
  return on_all([&] { return local_->diagnose(); });
}
std::vector<double> RankedSolver::readings(Series series, Interval interval) {
  say(What::readings, Packer().add(series).add(interval));
  return on_all([&] { return local_->readings(series, interval); });
}

SolverState RankedSolver::state(StateOf which) {
  SolverState all;
  state_in_pieces(which, kPieceRows,
                  {[&](SolverState&& head) { all = std::move(head); },
                   [&](std::int64_t, SolverState&& rows) { append(rows, all); }});
  return all;
}
void RankedSolver::set_state(const SolverState& s) {
  check_state(s, plan_.particles);
  set_state_in_pieces({head_of(s, plan_), plan_.particles, [&](std::int64_t first, std::int64_t n) {
                         std::vector<int> rows(static_cast<std::size_t>(n));
                         std::iota(rows.begin(), rows.end(), int(first));
                         return picked(s, rows, plan_);
                       }});
}
void RankedSolver::keep() {
  say(What::keep);
  on_all([&] { local_->keep(); });
}
/// A solver of all particles, in the present state.
Inspection& RankedSolver::alone() {
  const SolverState now = state(StateOf::present);
  if (!alone_) {
    Particles all;
    const Double3 o = scene_.origin();
    const double h = scene_.h();
    for (std::size_t k = 0; k < now.id.size(); ++k) {
      const double* x = now.position.data() + 3 * k;
      all.position.push_back({o[0] + h * x[0], o[1] + h * x[1], o[2] + h * x[2]});
    }
    all.velocity.resize(now.id.size());
    alone_ = make_solver(whole_scene_, whole_plan_, std::move(all));
  }
  alone_->set_state(now);
  return *alone_->inspection();
}
StepTrace RankedSolver::trace(const TraceOptions& options) {
  StepTrace t = alone().trace(options);
  set_state(alone_->state());
  return t;
}
std::optional<StageEvent> RankedSolver::step_checked(const StageLimits& limits,
                                                     const StepOptions& options) {
  std::optional<StageEvent> event = alone().step_checked(limits, options);
  set_state(alone_->state());
  return event;
}
void RankedSolver::inject(const Fault&) {
  throw Error(ExitCode::internal, "no faults on several ranks");
}

SolverInfo RankedSolver::info() const {
  SolverInfo i = local_->info();
  i.driver += fmt::format(", {} ranks on {}", ranks_.size(), ranks_.describe());
  return i;
}

}  // namespace pbf::exec_module
