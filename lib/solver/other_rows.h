// The rows of a step besides those of its own particles: copies from other ranks
// (lib/exec/ranks/rank_rows.h) or images beyond periodic faces (lib/exec/periodic/periodic_rows.h).
// Only some executors know them.
#pragma once

#include <vector>

#include "lib/program/exchanges.h"
#include "lib/solver/step_context.h"

namespace pbf::PBF_VARIANT {

template <class C>
constexpr bool has_ranks = requires(C& c) {
  c.exec.rows();
};

template <class C>
bool has_other_ranks([[maybe_unused]] C& c) {
  if constexpr (has_ranks<C>)
    return c.exec.rows() != nullptr;
  else
    return false;
}

/// Before the arrays are made.
template <class C>
void begin_rows(C& c, const InternalState<typename C::Real>& first) {
  if constexpr (has_ranks<C>)
    if (auto* rows = c.exec.rows()) rows->begin(first, c.p, c.plan, c.scene);
  if (auto* images = c.images()) images->begin(int(first.id.size()));
}
/// Whether no pass of an update may be fused with one of the next: rows come and go between them.
template <class C>
bool is_unfused(C& c, const Program& program) {
  if (has_other_ranks(c)) return unfused_on_ranks(program, c.scene);
  return c.images() != nullptr;
}
/// Whether the updates from now on are repeated if rows were lost.
template <class C>
void in_batch([[maybe_unused]] C& c, [[maybe_unused]] bool now) {
  if constexpr (has_ranks<C>)
    if (auto* rows = c.exec.rows()) rows->in_batch(now);
}
/// Whether the batch will be repeated anyway, so that its other updates need not run.
template <class C>
bool has_lost_rows([[maybe_unused]] C& c) {
  if constexpr (has_ranks<C>)
    if (auto* rows = c.exec.rows()) return rows->lost();
  return false;
}
/// Before each update, and before particles are read.
template <class C>
void wrap_rows(C& c) {
  if (auto* images = c.images()) images->wrap(c);
}
/// After rows 0 ... n - 1 were set: they are all.
template <class C>
void all_own_rows(C& c, int n) {
  if constexpr (has_ranks<C>)
    if (auto* rows = c.exec.rows()) rows->all_own(c, n);
  if (auto* images = c.images()) images->all_own(c, n);
}
/// Leaves this rank's own rows alone, without images; false if there were no others. The same on
/// all ranks, which make lists together. sort(): leaves out rows with a negative id.
template <class C, class Sort>
bool drop_other_rows(C& c, const Sort& sort) {
  if constexpr (has_ranks<C>)
    if (auto* rows = c.exec.rows()) return rows->drop_ghosts(c), true;
  wrap_rows(c);
  auto* images = c.images();
  if (!images || !images->leave(c)) return false;
  sort();
  return true;
}

}  // namespace pbf::PBF_VARIANT
