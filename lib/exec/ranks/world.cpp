#include "lib/exec/ranks/world.h"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "lib/base/error.h"
#include "lib/exec/ranks/id_ranges.h"
#include "lib/exec/ranks/mpi_ranks.h"
#include "lib/exec/ranks/packing.h"
#include "lib/exec/ranks/rank_states.h"
#include "lib/exec/ranks/ranked_solver.h"
#include "lib/scene/load.h"

namespace pbf::exec_module {
namespace {

std::unique_ptr<MpiRanks> ranks;

enum class Order { positions, rows, solver, end };

/// Of this rank, until the next solver is made: its particles, and the positions that the last
/// solver has left.
Particles rows;
std::vector<double> left;

/// Calls f(motion) for what a scene's text does not hold.
template <class AnyScene, class F>
void each_motion(AnyScene& s, const F& f) {
  for (auto& o : s.obstacles)
    if (o.motion) f(*o.motion);
  if (s.tank_motion) f(*s.tank_motion);
}

void add(Packer& p, const Scene& s) {
  p.add(resolved_yaml(s));
  // Surfaces that obstacles share are sent once, and remain shared.
  std::vector<const SolidMesh*> sent;
  for (const Obstacle& o : s.obstacles)
    if (const auto* f = o.surface_file()) {
      const SolidMesh& mesh = *f->surface;
      const auto number = std::size_t(std::ranges::find(sent, &mesh) - sent.begin());
      p.add(number);
      if (number < sent.size()) continue;
      sent.push_back(&mesh);
      p.add(mesh.file()).add(mesh.sha256()).add(mesh.mesh().vertex).add(mesh.mesh().triangle);
    }
  each_motion(s, [&](const auto& m) {
    const MotionTable& t = m.table;
    p.add(t.file).add(t.sha256).add(t.columns).add(t.time).add(t.values).add(t.line);
    if constexpr (requires { m.waits; }) p.add(m.waits);
  });
}
Scene take_scene(Unpacker& from) {
  Scene s = parse_stored_scene(from.take<std::string>(), "rank 0", {});
  std::vector<std::shared_ptr<const SolidMesh>> taken;
  for (Obstacle& o : s.obstacles)
    if (auto* f = o.surface_file()) {
      if (const auto number = from.take<std::size_t>(); number < taken.size()) {
        f->surface = taken[number];
        continue;
      }
      auto file = from.take<std::string>(), sha256 = from.take<std::string>();
      TriangleMesh mesh;
      from.take(mesh.vertex), from.take(mesh.triangle);
      f->surface =
          std::make_shared<const SolidMesh>(std::move(file), std::move(sha256), std::move(mesh));
      taken.push_back(f->surface);
    }
  each_motion(s, [&](auto& m) {
    MotionTable& t = m.table;
    from.take(t.file), from.take(t.sha256), from.take(t.columns);
    from.take(t.time), from.take(t.values), from.take(t.line);
    if constexpr (requires { m.waits; }) from.take(m.waits);
  });
  return s;
}

/// Other ranks are told what to do in serve_world().
void order(Order what, const Packer& arguments) {
  Packer all;
  all.add(what);
  all.bytes.insert(all.bytes.end(), arguments.bytes.begin(), arguments.bytes.end());
  ranks->broadcast(all.bytes);
}
/// Each rank gets more rows, of so many that it will have.
void take_rows(const std::function<std::vector<char>(int)>& part) {
  const std::vector<char> bytes = scatter(*ranks, part);
  Unpacker from(bytes);
  const auto own = std::size_t(from.take<std::int64_t>());
  const auto add = [&](auto& to) {
    const auto more = from.take<std::remove_cvref_t<decltype(to)>>();
    to.reserve(own);
    to.insert(to.end(), more.begin(), more.end());
  };
  add(rows.position), add(rows.velocity), add(rows.ids);
}
/// On rank 0 the positions that the ranks have of particles with these ids.
std::vector<double> give_positions(std::int64_t particles, std::int64_t first, std::int64_t last) {
  const IdRanges ranges(particles, ranks->size());
  const std::int64_t low = ranges.first(ranks->rank()), high = ranges.first(ranks->rank() + 1);
  const auto at = [&](std::int64_t id) {
    return reinterpret_cast<const char*>(left.data() + 3 * (std::clamp(id, low, high) - low));
  };
  if (std::int64_t(left.size()) != 3 * (high - low))
    throw Error(ExitCode::internal, "no solver has left positions");
  std::vector<double> all;
  ranks->gather({at(first), at(last)}, [&](const std::vector<char>& part) {
    const auto* x = reinterpret_cast<const double*>(part.data());
    all.insert(all.end(), x, x + part.size() / sizeof *x);
  });
  return all;
}
std::unique_ptr<RankedSolver> solver_of_rows(const Scene& scene, const Plan& plan) {
  std::vector<double>().swap(left);
  auto solver = std::make_unique<RankedSolver>(*ranks, scene, plan, std::exchange(rows, {}));
  solver->leave_positions_to(left);
  return solver;
}

}  // namespace

Communicator* world() { return ranks.get(); }
void open_world() {
  if (launched_ranks() > 1) ranks = open_mpi_ranks();
}

std::unique_ptr<Solver> make_ranked_solver(const Scene& scene, const Plan& plan,
                                           const ParticlePieces& particles) {
  require_ranks(scene, plan, ranks->size());
  Packer p;
  add(p, scene);
  p.add(plan.particles).add(plan.start.count).add(plan.start.scatter).add(plan.start.of_files);
  Unpacker back(p.bytes);
  if (!(take_scene(back) == scene))
    throw Error(ExitCode::internal, "the scene for the other ranks is not that of rank 0");
  FirstRanks first(scene, plan, ranks->size());
  particles([&](std::int64_t, Particles&& piece) { first.count(piece); });
  first.cut();
  particles([&](std::int64_t id, Particles&& piece) {
    const auto of_ranks = first.rows_of_ranks(piece);
    order(Order::rows, {});
    take_rows([&](int rank) {
      const Particles part = part_of(piece, of_ranks[std::size_t(rank)], id);
      return std::move(Packer()
                           .add(first.particles(rank))
                           .add(part.position)
                           .add(part.velocity)
                           .add(part.ids)
                           .bytes);
    });
  });
  order(Order::solver, p);
  return solver_of_rows(scene, plan);
}

std::vector<double> left_positions(std::int64_t particles, std::int64_t first, std::int64_t last) {
  order(Order::positions, Packer().add(particles).add(first).add(last));
  return give_positions(particles, first, last);
}

int serve_world() {
  for (;;) {
    std::vector<char> bytes;
    ranks->broadcast(bytes);
    Unpacker from(bytes);
    switch (from.take<Order>()) {
      case Order::positions: {
        const auto particles = from.take<std::int64_t>(), first = from.take<std::int64_t>();
        give_positions(particles, first, from.take<std::int64_t>());
        break;
      }
      case Order::rows:
        take_rows({});
        break;
      case Order::solver: {
        const Scene scene = take_scene(from);
        const auto n = from.take<std::int64_t>();
        StartNeighbors start;
        from.take(start.count), from.take(start.scatter), from.take(start.of_files);
        solver_of_rows(scene, make_plan(scene, n, std::move(start)))->serve();
        break;
      }
      case Order::end: {
        const int code = from.take<int>();
        ranks->end(code);
        return code;
      }
    }
  }
}

void end_world(int code) {
  if (!ranks) return;
  if (!ranks->failed()) order(Order::end, Packer().add(code));
  ranks->end(code);
}

}  // namespace pbf::exec_module
