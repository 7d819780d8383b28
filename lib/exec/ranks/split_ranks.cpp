// RankedSolver: rows that stay on their ranks, or go to and from rank 0 in pieces.
#include <algorithm>
#include <array>
#include <cstring>

#include "lib/exec/ranks/rank_states.h"
#include "lib/exec/ranks/ranked_solver.h"
#include "lib/program/field.h"

namespace pbf::exec_module {

Snapshot RankedSolver::hold(const std::vector<std::string>& fields, ScalarType type) {
  say(What::hold, Packer().add(fields).add(type));
  return on_all([&] { return frame_.hold([&] { return local_->download(fields, type).get(); }); });
}
void RankedSolver::held(std::size_t field, std::int64_t most, const TakeRows& take) {
  say(What::held, Packer().add(field).add(most));
  on_all([&] { frame_.held(field, most, take); });
}
bool RankedSolver::share_file(const std::string& path, std::uint64_t inode) {
  say(What::share_file, Packer().add(path).add(inode));
  return on_all([&] { return frame_.share_file(path, inode); });
}
void RankedSolver::write_held(const FramePlaces& places) {
  Packer p;
  p.add(places.chunk_rows).add(places.chunks.size());
  for (const auto& chunks : places.chunks) p.add(chunks);
  say(What::write_held, p);
  on_all([&] { frame_.write(places); });
}
bool RankedSolver::written(bool wait) {
  say(What::written, Packer().add(wait));
  return on_all([&] { return frame_.written(wait); });
}

void RankedSolver::state_in_pieces(StateOf which, std::int64_t most, const StateSink& to) {
  say(What::state, Packer().add(which).add(most));
  on_all([&] { give_state(which, most, to); });
}
void RankedSolver::give_state(StateOf which, std::int64_t most, const StateSink& to) {
  const bool first_rank = ranks_.rank() == 0;
  const std::int64_t n = plan_.particles;
  const SolverState mine = local_->state(which);
  WholeHead all(scene_, plan_);
  ranks_.gather(packed(head_of(mine, plan_)),
                [&](const std::vector<char>& part) { all.add(state_of(part)); });
  SolverState head;
  if (first_rank) {
    head = std::move(all).result();
    to.head(SolverState(head));
  }
  for (std::int64_t at = 0; at < n; at += most) {
    const std::int64_t rows = std::min(most, n - at);
    SolverState piece;
    if (first_rank) piece = piece_of(head, which, at, rows, plan_);
    ranks_.gather(packed(rows_between(mine, at, at + rows, plan_)),
                  [&](const std::vector<char>& part) { place_rows(state_of(part), at, piece); });
    if (first_rank) to.rows(at, std::move(piece));
  }
}

void RankedSolver::set_state_in_pieces(const StateSource& from) {
  if (from.count != plan_.particles)
    throw Error(ExitCode::internal, "a state of other particles than the solver has");
  say(What::set_state);
  on_all([&] { take_state(&from); });
}
void RankedSolver::take_state(const StateSource* from) {
  const std::int64_t n = plan_.particles;
  const auto each_piece = [n](const auto& f) {
    for (std::int64_t at = 0; at < n; at += kPieceRows) f(at, std::min(kPieceRows, n - at));
  };
  FirstRanks first(scene_, plan_, ranks_.size());
  if (from) {
    each_piece([&](std::int64_t at, std::int64_t rows) { first.count(from->read(at, rows)); });
    first.cut();
  }
  SolverState mine = state_of(scatter(ranks_, [&](int rank) {
    return packed(head_of_rank(from->head, scene_, plan_, rank, first.particles(rank)));
  }));
  const auto own = std::size_t(mine.find(field::row_state.name)->values.at(0));
  mine.position.reserve(3 * own), mine.velocity.reserve(3 * own), mine.id.reserve(own);
  each_piece([&](std::int64_t at, std::int64_t rows) {
    SolverState piece;
    std::vector<std::vector<int>> of_ranks;
    if (from) piece = from->read(at, rows), of_ranks = first.rows_of_ranks(piece);
    append(state_of(scatter(ranks_,
                            [&](int rank) {
                              return packed(picked(piece, of_ranks[std::size_t(rank)], plan_));
                            })),
           mine);
  });
  local_->set_state(mine);
}

void RankedSolver::go_back() {
  say(What::go_back);
  on_all([&] { local_->set_state(local_->state(StateOf::kept)); });
}

Moves RankedSolver::moves() {
  say(What::moves);
  return on_all([&] { return add_moves(); });
}
/// Each rank adds those of its range of ids to the sum of the ranks before it, so that the sum has
/// the order, and the bits, that it has on one rank.
Moves RankedSolver::add_moves() {
  const SolverState mine = local_->state(StateOf::positions);
  ToRanges to(ranks_, frame_.ranges(), mine.id);
  const std::vector<std::byte> bytes = to.move(std::as_bytes(std::span(mine.position)), 24);
  std::vector<double> now(bytes.size() / sizeof(double));
  if (!bytes.empty()) std::memcpy(now.data(), bytes.data(), bytes.size());
  Moves sum;
  const int me = ranks_.rank(), last = ranks_.size() - 1;
  const auto receive = [&](int from) {
    ranks_.exchange({}, std::array{Incoming{from, &sum, sizeof sum}});
  };
  const auto send = [&](int to_rank) {
    ranks_.exchange(std::array{Outgoing{to_rank, &sum, sizeof sum}}, {});
  };
  if (me > 0) receive(me - 1);
  if (before_.size() == now.size()) sum.add(before_, now);
  before_ = std::move(now);
  if (last > 0) send(me == last ? 0 : me + 1);
  if (last > 0 && me == 0) receive(last);
  return sum;
}

}  // namespace pbf::exec_module
