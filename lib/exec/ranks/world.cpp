#include "lib/exec/ranks/world.h"

#include <utility>

#include "lib/base/error.h"
#include "lib/exec/ranks/mpi_ranks.h"
#include "lib/exec/ranks/packing.h"
#include "lib/exec/ranks/rank_states.h"
#include "lib/exec/ranks/ranked_solver.h"
#include "lib/scene/load.h"

namespace pbf::exec_module {
namespace {

std::unique_ptr<MpiRanks> ranks;

enum class Order { solver, end };

/// Calls f(motion) for what a scene's text does not hold.
template <class AnyScene, class F>
void each_motion(AnyScene& s, const F& f) {
  for (auto& o : s.obstacles)
    if (o.motion) f(*o.motion);
  if (s.tank_motion) f(*s.tank_motion);
}

void add(Packer& p, const Scene& s) {
  p.add(resolved_yaml(s));
  each_motion(s, [&](const auto& m) {
    const MotionTable& t = m.table;
    p.add(t.file).add(t.sha256).add(t.columns).add(t.time).add(t.values).add(t.line);
    if constexpr (requires { m.waits; }) p.add(m.waits);
  });
}
Scene take_scene(Unpacker& from) {
  Scene s = parse_stored_scene(from.take<std::string>(), "rank 0", {});
  each_motion(s, [&](auto& m) {
    MotionTable& t = m.table;
    from.take(t.file), from.take(t.sha256), from.take(t.columns);
    from.take(t.time), from.take(t.values), from.take(t.line);
    if constexpr (requires { m.waits; }) from.take(m.waits);
  });
  return s;
}

/// What this rank gets of the particles, which rank 0 has.
Particles part_of_start(Particles all, const IdsOfRanks& ids) {
  const std::vector<char> bytes = scatter(*ranks, [&](int rank) {
    const Particles part = part_of(all, ids[std::size_t(rank)]);
    return std::move(Packer().add(part.position).add(part.velocity).add(part.ids).bytes);
  });
  all = {};
  Unpacker from(bytes);
  from.take(all.position), from.take(all.velocity), from.take(all.ids);
  return all;
}

}  // namespace

Communicator* world() { return ranks.get(); }
void open_world() {
  if (launched_ranks() > 1) ranks = open_mpi_ranks();
}

std::unique_ptr<Solver> make_ranked_solver(const Scene& scene, const Plan& plan,
                                           Particles particles) {
  require_ranks(scene, plan, ranks->size());
  Packer p;
  p.add(Order::solver);
  add(p, scene);
  p.add(plan.particles).add(plan.start.count).add(plan.start.scatter).add(plan.start.of_files);
  Unpacker back(p.bytes);
  back.take<Order>();
  if (!(take_scene(back) == scene))
    throw Error(ExitCode::internal, "the scene for the other ranks is not that of rank 0");
  ranks->broadcast(p.bytes);
  const IdsOfRanks ids = ids_of_ranks(particles, scene, plan, ranks->size());
  return std::make_unique<RankedSolver>(*ranks, scene, plan,
                                        part_of_start(std::move(particles), ids));
}

int serve_world() {
  for (;;) {
    std::vector<char> bytes;
    ranks->broadcast(bytes);
    Unpacker from(bytes);
    if (from.take<Order>() == Order::end) {
      const int code = from.take<int>();
      ranks->end(code);
      return code;
    }
    const Scene scene = take_scene(from);
    const auto n = from.take<std::int64_t>();
    StartNeighbors start;
    from.take(start.count), from.take(start.scatter), from.take(start.of_files);
    RankedSolver(*ranks, scene, make_plan(scene, n, std::move(start)), part_of_start({}, {}))
        .serve();
  }
}

void end_world(int code) {
  if (!ranks) return;
  Packer p;
  p.add(Order::end).add(code);
  if (!ranks->failed()) ranks->broadcast(p.bytes);
  ranks->end(code);
}

}  // namespace pbf::exec_module
