// The interface of a backend to the step. A step is a list of passes (lib/program). An executor
// launches passes, sorts particles, makes lists, reduces sums, repeats updates and copies results.
// It contains no physics.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "kernels/boundary/near_rows.h"
#include "kernels/measure.h"
#include "kernels/params.h"
#include "kernels/pass_shapes.h"
#include "kernels/row_state.h"
#include "lib/solver/solver.h"

namespace pbf::PBF_VARIANT {

/// Host memory for the rows of a download, and its size.
struct CopyTarget {
  void* host;
  std::size_t bytes;
};

/// Minimal arguments, with which the concept calls an executor.
namespace archetype {
struct Item {
  PBF_HD void operator()(int) const {}
};
struct Pair {
  struct Own {};
  struct Sum {};
  static constexpr int D = 3;
  int lists = 0;
  PBF_HD Own own(int) const { return {}; }
  PBF_HD int other(Neighbor) const { return 0; }
  PBF_HD void add(Sum&, const Own&, int) const {}
  PBF_HD void finish(int, const Own&, const Sum&) const {}
};
template <class Of>
struct Parts {
  using Part = int;
  PBF_HD Part part(Of, int, int) const { return 0; }
  PBF_HD std::int64_t finish(Of, Part) const { return 0; }
};
struct Shared : Parts<int> {
  static constexpr int lanes = 2;
};
struct Team : Parts<int> {
  PBF_HD int items() const { return 0; }
  PBF_HD int groups() const { return 0; }
  PBF_HD int size(int) const { return 0; }
  PBF_HD int lanes(int, int) const { return 1; }
};
struct Cell {};
struct Brick : Parts<Cell> {
  static constexpr int lanes = 2, brick_cells = 16, brick_corners = 8;
  struct Grid {
    PBF_HD int bricks() const { return 0; }
    PBF_HD bool has(Cell) const { return true; }
  } grid;
  PBF_HD int brick(int) const { return 0; }
  PBF_HD Cell cell(int, int) const { return {}; }
  PBF_HD int share(int, int, std::int64_t) const { return 0; }
  PBF_HD void finish_corner(int, int, int) const {}
};
struct Residual {
  PBF_HD std::uint64_t operator()(int) const { return 0; }
};
struct Bin {
  PBF_HD int operator()(int) const { return 0; }
};
struct Sorted {
  int* bin;
  PBF_HD void operator()(int) const {}
};
struct Gather {
  PBF_HD void operator()(int, int) const {}
};
struct Reduce {
  PBF_HD MeasureCounts counts(int) const { return {}; }
  PBF_HD MeasureTerms terms(int, const MeasureUnits&) const { return {}; }
};
struct Body {
  void operator()() const {}
};
struct Write {
  void operator()(const std::vector<float*>&) const {}
};
/// Updates that can be recorded (lib/solver/batch.h).
struct Updates {
  int capacity() const { return 0; }
  void step(int) {}
  bool has_form(int) const { return true; }
  std::array<int, 4> recording(int) const { return {}; }
  void replayed(int) {}
};
}  // namespace archetype

template <class E>
concept Executor = requires(E e, const E c, int* ints, unsigned long long* count, Params<float> p,
                            const Vec4<float>* rows, std::vector<CopyTarget> targets,
                            const RowState* rows_of_run, archetype::Updates updates,
                            SolverInfo info) {
  typename E::Lists;                 // neighbor lists, as pair passes use them
  typename E::template Buffer<int>;  // memory that passes can access: resize, data, size, bytes
  { E::backend } -> std::convertible_to<Backend>;
  { E::lists_overflow } -> std::convertible_to<bool>;  // lists may overflow during an update
  // Stage times: after begin(), mark() books the time to a stage. stages(seconds): `seconds` is the
  // time of all steps, for executors that time only some of them.
  e.begin();
  e.mark("stage");
  e.forget_stages();
  { c.stages(1.0) } -> std::same_as<std::vector<StageTime>>;
  // Copies between the host and the executor's memory.
  e.to_device(ints, std::size_t(1), ints);
  e.to_host(ints, std::size_t(1), ints);
  // A download: write(pointers) fills memory of the executor for each target. finish_copy() waits
  // until the data is on the host.
  e.template start_copy<float>(targets, archetype::Write{});
  e.finish_copy(targets);
  // The number of particles where it changes, in the form of launches; a pass has written it.
  e.counted(rows_of_run, 1);
  e.rows_changed();
  // A launch for each shape of passes; the integers are numbers of items or particles.
  e.items(1, archetype::Item{});
  e.items(e.counted(rows_of_run, 1), archetype::Item{});
  e.pairs(1, archetype::Pair{});
  e.pairs(e.counted(rows_of_run, 1), archetype::Pair{});
  e.shared(1, archetype::Shared{});
  e.teams(archetype::Team{});
  e.bricks(archetype::Brick{});
  e.listed(ints, 1, archetype::Item{});  // for *ints items, at most 1
  { e.reduce(1, archetype::Reduce{}) } -> std::same_as<MeasureSums>;
  { e.count_in_bins(1, 1, archetype::Bin{}) } -> std::convertible_to<std::vector<std::int64_t>>;
  // Repeats body() while the mean of a pass is above a tolerance.
  e.repeat_while("stage", 1, 1, archetype::Residual{}, 0.5, count, archetype::Body{});
  // Sorts by bin, then id, and leaves out rows with a negative id (true) or has none (false); makes
  // lists of the pairs closer than h.
  e.template sort_by_bin<false>("stage", archetype::Sorted{ints}, NothingListed{}, 1, 1, ints, ints,
                                ints, archetype::Gather{});
  e.template sort_by_bin<true>("stage", archetype::Sorted{ints}, NothingListed{}, 1, 1, ints, ints,
                               ints, archetype::Gather{});
  { e.build_lists(1, 1, rows, ints, p) } -> std::same_as<typename E::Lists>;
  // place[i]: how many of n different numbers are smaller than id[i].
  e.rank(1, ints, ints);
  // Repeats updates, from a recording if possible; forget_recorded() after parameters have changed.
  e.repeat(1, updates);
  e.forget_recorded();
  { e.largest_batch(1) } -> std::convertible_to<int>;
  // Enlarges the memory of lists if some did not fit; false if all did. After that, if they are no
  // longer needed: more memory if they were nearly too long.
  { e.grow_lists(1) } -> std::same_as<bool>;
  e.enlarge_lists(1);
  { c.bytes() } -> std::convertible_to<std::size_t>;
  c.describe(info);  // device, driver, threads, launches
};

}  // namespace pbf::PBF_VARIANT
