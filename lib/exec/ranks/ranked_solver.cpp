#include "lib/exec/ranks/ranked_solver.h"

#include <fmt/core.h>
#include <algorithm>
#include <utility>

#include "lib/base/error.h"
#include "lib/exec/make_solver.h"
#include "lib/exec/ranks/rank_states.h"
#include "lib/exec/ranks/slabs.h"
#include "lib/program/exchanges.h"
#include "lib/program/rank_plan.h"
#include "lib/solver/step_solver.h"

namespace pbf::exec_module {
namespace {

/// A rank's own rows are known to its passes as rows of a number that changes.
Scene of_rank(Scene scene, const Plan& plan, int ranks) {
  scene.capacity = plan_ranks(plan, scene, ranks).capacity;
  return scene;
}

/// Why a scene cannot run on several ranks; null: it can.
const char* why_one_rank(const Scene& s) {
  if (changes_rows(s)) return "the number of its particles changes";
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
      scene_(of_rank(scene, plan, ranks.size())),
      whole_plan_(plan),
      plan_(make_plan(scene_, plan.particles, plan.start)) {
  require_ranks(scene, plan, ranks.size());
  on_all([&] { local_ = make_local_solver(scene_, plan_, std::move(particles), &ranks_); });
}
RankedSolver::~RankedSolver() {
  if (ranks_.rank() == 0 && !ended_) try {
      say(What::end, {});
    } catch (const std::exception&) {  // the others have failed
    }
}

void RankedSolver::say(What what, const Packer& arguments) {
  Packer all;
  all.add(what);
  all.bytes.insert(all.bytes.end(), arguments.bytes.begin(), arguments.bytes.end());
  ranks_.broadcast(all.bytes);
}
template <class F>
auto RankedSolver::on_all(const F& f) -> decltype(f()) {
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

void RankedSolver::serve() {
  on_all([&] {
    for (;;) {
      std::vector<char> bytes;
      ranks_.broadcast(bytes);
      Unpacker from(bytes);
      switch (from.take<What>()) {
        case What::step: {
          const int updates = from.take<int>();
          local_->step(updates, from.take<StepOptions>());
          break;
        }
        case What::download: {
          const auto fields = from.take<std::vector<std::string>>();
          const auto type = from.take<ScalarType>();
          whole(local_->download(fields, type).get(), fields, type);
          break;
        }
        case What::diagnose:
          local_->diagnose();
          break;
        case What::readings: {
          const auto series = from.take<Series>();
          local_->readings(series, from.take<Interval>());
          break;
        }
        case What::state: {
          const auto which = from.take<StateOf>();
          whole(local_->state(which), which);
          break;
        }
        case What::set_state:
          local_->set_state(state_of(scatter(ranks_, {})));
          break;
        case What::keep:
          local_->keep();
          break;
        case What::end:
          return;
      }
    }
  });
}

void RankedSolver::step(int updates, const StepOptions& options) {
  say(What::step, Packer().add(updates).add(options));
  on_all([&] { local_->step(updates, options); });
}

std::future<Snapshot> RankedSolver::download(const std::vector<std::string>& fields,
                                             ScalarType type) {
  say(What::download, Packer().add(fields).add(type));
  Snapshot all = on_all([&] { return whole(local_->download(fields, type).get(), fields, type); });
  std::promise<Snapshot> done;
  done.set_value(std::move(all));
  return done.get_future();
}
/// On rank 0 the particles of all ranks, in the order of ids; nothing on the others.
Snapshot RankedSolver::whole(const Snapshot& mine, const std::vector<std::string>& fields,
                             ScalarType type) {
  Packer p;
  p.add(ids_of(mine)).add(mine.fields.size());
  for (const FieldArray& f : mine.fields) p.add(f.bytes);
  Snapshot all = empty_snapshot(fields, type, ranks_.rank() == 0 ? std::size_t(plan_.particles) : 0,
                                mine.update, mine.time);
  ranks_.gather(std::move(p.bytes), [&](const std::vector<char>& part) {
    Unpacker from(part);
    const auto ids = from.take<std::vector<std::int64_t>>();
    const auto arrays = from.take<std::size_t>();
    for (std::size_t k = 0; k < arrays; ++k) {
      const auto rows = from.take<std::vector<std::byte>>();
      FieldArray& f = all.fields[k];
      if (f.name != "id")
        place_rows(rows, ids, std::size_t(f.components) * size_of(f.type), f.bytes);
    }
  });
  return all;
}

Diagnostics RankedSolver::diagnose() {
  say(What::diagnose, {});
  return on_all([&] { return local_->diagnose(); });
}
std::vector<double> RankedSolver::readings(Series series, Interval interval) {
  say(What::readings, Packer().add(series).add(interval));
  return on_all([&] { return local_->readings(series, interval); });
}

/// On rank 0 that of all particles; nothing on the others.
SolverState RankedSolver::whole(const SolverState& mine, StateOf which) {
  WholeState all(which, scene_, plan_);
  ranks_.gather(packed(mine), [&](const std::vector<char>& part) { all.add(state_of(part)); });
  return ranks_.rank() == 0 ? std::move(all).result() : SolverState();
}

SolverState RankedSolver::state(StateOf which) {
  say(What::state, Packer().add(which));
  return on_all([&] { return whole(local_->state(which), which); });
}
void RankedSolver::set_state(const SolverState& s) {
  check_state(s, plan_.particles);
  say(What::set_state, {});
  on_all([&] {
    const IdsOfRanks ids = ids_of_ranks(s, plan_, ranks_.size());
    local_->set_state(state_of(scatter(ranks_, [&](int rank) {
      return packed(part_of(s, ids[std::size_t(rank)], scene_, plan_, rank));
    })));
  });
}
void RankedSolver::keep() {
  say(What::keep, {});
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
    alone_ = make_local_solver(whole_scene_, whole_plan_, std::move(all), nullptr);
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
