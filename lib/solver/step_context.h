// The context of launches: the arrays of a step by name, the parameters, the executor.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "kernels/cell_index.h"
#include "kernels/params.h"
#include "kernels/step_counts.h"
#include "lib/base/release.h"
#include "lib/program/as_types.h"
#include "lib/program/features/solids.h"
#include "lib/program/field.h"
#include "lib/program/loads.h"
#include "lib/scene/scene.h"
#include "lib/solver/gauge_arrays.h"
#include "lib/solver/moving_parts.h"
#include "lib/solver/placed_solids.h"
#include "lib/solver/state_transfer.h"

namespace pbf::inline PBF_VARIANT {

/// An array of a field; second: the second one of a pair.
struct FieldMemory {
  const FieldInfo* field;
  bool second;
  char* begin;
  std::size_t bytes;
};

/// The fields of a program in the memory of an executor, and the parts of a step around them.
template <class RealType, class Exec>
struct StepContext {
  using Real = RealType;
  using Lists = typename Exec::Lists;
  template <class T>
  using Buffer = typename Exec::template Buffer<T>;

  StepContext(Exec& executor, Scene along_axes, const Params<Real>& parameters,
              const LevelPlan& grids)
      : exec(executor), scene(std::move(along_axes)), p(parameters), levels(grids) {}

  Exec& exec;
  Scene scene;  ///< along the internal axes, with the present step
  Params<Real> p;
  const LevelPlan& levels;
  Lists lists{};
  bool lists_are_current = false;
  const char* booked_as = nullptr;  ///< stage for the times of passes; null: their own stages
  int iteration = 0;                ///< of the substep
  int iterations = 0;               ///< since the lists were made
  bool iterating = false;
  std::vector<Real> factors{};  ///< omega of each iteration
  GaugeArrays<Exec> gauges{};   ///< to be created before make()

  // For passes.
  int rows() const { return rows_; }  ///< number of particles
  // Launches by the shape of a pass (kernels/pass_shapes.h), over all rows or n items.
  template <class Pass>
  void items(const Pass& pass) {
    exec.items(rows_, pass);
  }
  template <class Pass>
  void items(int n, const Pass& pass) {
    exec.items(n, pass);
  }
  template <class Pass>
  void pairs(const Pass& pass) {
    exec.pairs(rows_, pass);
  }
  template <class Pass>
  void shared(int n, const Pass& pass) {
    exec.shared(n, pass);
  }
  template <class Pass>
  void teams(const Pass& pass) {
    exec.teams(pass);
  }
  template <class Pass>
  void bricks(const Pass& pass) {
    exec.bricks(pass);
  }
  template <class Pass>
  void listed(const int* count, const Pass& pass) {
    exec.listed(count, rows_, pass);
  }
  template <class Pass>
  MeasureSums reduce(const Pass& pass) {
    return exec.reduce(rows_, pass);
  }
  template <class F>
  void with_smoothing(F&& f) const {
    pbf::with_smoothing(scene.solver.kernels, scene.dimensions, f);
  }
  Real sor() const { return factors[std::size_t(iteration)]; }
  const char* booked(const char* stage) const { return booked_as ? booked_as : stage; }
  void make_lists() {
    lists = exec.build_lists(rows_, capacity_, position(), data<int>(field::bin_start), p);
    lists_are_current = true;
    iterations = 0;
  }

  /// Rows of a field; null if the program does not use it.
  template <class T>
  T* data(const FieldInfo& f) {
    Slot* s = slot(f);
    return s ? reinterpret_cast<T*>(s->rows[s->now ^ (f.first ? 1 : 0)].data()) : nullptr;
  }
  /// The present memory of all fields.
  std::vector<FieldMemory> arrays() {
    std::vector<FieldMemory> all;
    for (Slot& s : slots_)
      for (int k = 0; k < (s.info->pair ? 2 : 1); ++k)
        all.push_back({s.info, k == 1, s.rows[s.now ^ k].data(), s.rows[s.now ^ k].bytes()});
    return all;
  }
  /// Swaps the two arrays of a field.
  void flip(const FieldInfo& f) { slot(f)->now ^= 1; }
  Vec4<Real>* position() { return data<Vec4<Real>>(field::position); }
  Vec4<Real>* velocity() { return data<Vec4<Real>>(field::velocity); }
  Real* density() { return data<Real>(field::density); }
  int* ids() { return data<int>(field::id); }
  /// Memory for the order of a sort (rows() integers), in a pass that flips the ids.
  int* sort_order() {
    return Exec::order_in_place ? data<int>(field::id) : data<int>(field::order);
  }
  StepCounts* counts() { return counts_.data(); }
  /// For with_boundary() (features/solids.h), which sets its walls.
  const Solids<Real>& solids() const { return solids_; }
  /// The half cells in which particles can be near solids, in the order of bins; empty: all.
  Buffer<int>& near_half_cells() { return near_half_cells_; }
  MovingParts<Real, Exec>& moving() { return moving_; }
  PlacedSolid<Real>* placed() { return placed_.data(); }
  /// Sets the positions of all solids. They stay there until a step moves them.
  void place(const std::vector<PlacedSolid<Real>>& all) {
    exec.to_device(all.data(), all.size(), placed_.data());
    moving_.stand(exec, all);
  }
  /// One load per row of sums (program/loads.h).
  Load* loads() { return loads_.data(); }
  StateArrays<Real> state() {
    return {position(),
            velocity(),
            ids(),
            counts(),
            loads(),
            int(loads_.size()),
            gauges.flow.data(),
            int(gauges.flow.size())};
  }

  /// To be called after positions were set: all rows count as near solids until lists are made.
  void forget_near() {
    if (solids_.near.way_left_squared) items(AllNearPass<Real>{solids_.near, rows_});
  }

  /// Bits that tell which of its two arrays is the first for each pair. Recorded updates are valid
  /// for one such placement.
  int placement() const {
    int bits = 0, bit = 1;
    for (const Slot& s : slots_)
      if (s.info->pair) bits |= s.now ? bit : 0, bit *= 2;
    return bits;
  }

  /// Creates the arrays of n particles and uploads their state. Frees the vectors of the state.
  /// moves: largest number of displacements of a particle in the iterations of a substep.
  void make(const std::vector<const FieldInfo*>& fields, std::vector<Vec4<Real>>& first_position,
            std::vector<Vec4<Real>>& first_velocity, std::vector<int>& first_id,
            const Scene& in_its_axes, const Plan& plan, int moves);

  std::size_t bytes() const {
    std::size_t sum = 0;
    for (const Slot& s : slots_) sum += s.rows[0].bytes() + s.rows[1].bytes();
    return sum + placed_.bytes() + around_.bytes() + near_half_cells_.bytes() + moving_.bytes();
  }

 private:
  struct Slot {
    const FieldInfo* info;
    Buffer<char> rows[2];
    int now = 0;
  };
  Slot* slot(const FieldInfo& f) {
    for (Slot& s : slots_)
      if (s.info == &f.primary()) return &s;
    return nullptr;
  }

  int rows_ = 0, capacity_ = 0;
  std::vector<Slot> slots_;  ///< about a dozen: a linear search is faster than a map
  Buffer<StepCounts> counts_;
  Buffer<Load> loads_;
  Buffer<PlacedSolid<Real>> placed_;
  Buffer<Surroundings<Real>> around_;
  Buffer<int> near_count_, near_half_cells_;
  Solids<Real> solids_;
  MovingParts<Real, Exec> moving_;

  /// Creates the boundary of scenes with more than plain walls. Needs the fields (load sums).
  void make_solids(const Scene& in_its_axes, const Plan& plan, int moves);
};

template <class Real, class Exec>
void StepContext<Real, Exec>::make(const std::vector<const FieldInfo*>& fields,
                                   std::vector<Vec4<Real>>& first_position,
                                   std::vector<Vec4<Real>>& first_velocity,
                                   std::vector<int>& first_id, const Scene& in_its_axes,
                                   const Plan& plan, int moves) {
  const std::size_t n = first_position.size();
  rows_ = capacity_ = int(n);
  const Sizes sizes{rows_,
                    std::int64_t(Exec::padding),
                    bin_count(p),
                    levels.cells(),
                    levels.runs(p.dimensions),
                    levels.bricks(),
                    levels.nodes(),
                    load_walls(scene)};
  for (const FieldInfo* f : fields) {
    if (f == &field::order && Exec::order_in_place) continue;
    const auto count = std::size_t(f->rows(sizes));
    const auto row = std::size_t(f->row_bytes(sizeof(Real)));
    slots_.push_back({f, {}, 0});
    for (int k = 0; k < (f->pair ? 2 : 1); ++k) {
      slots_.back().rows[k].resize(count * row);
      if (f->rows != per_padded_row || f->components != 4) continue;
      // Padding after the last row: outside of the range of any kernel, and at rest.
      const Real far = f == &field::position ? Real(1e9) : Real(0);
      const std::vector<Vec4<Real>> rows(Exec::padding,
                                         {far, far, far, Real(f == &field::position ? 1 : 0)});
      auto* to = reinterpret_cast<Vec4<Real>*>(slots_.back().rows[k].data());
      exec.to_device(rows.data(), rows.size(), to + n);
    }
  }
  counts_.resize(1);
  const StepCounts none;
  exec.to_device(&none, 1, counts());
  const std::vector<Load> unloaded(std::size_t(load_walls(scene)));
  loads_.resize(unloaded.size());
  exec.to_device(unloaded.data(), unloaded.size(), loads());
  if (!unloaded.empty()) {
    const std::vector<LoadSums> nothing(unloaded.size() * kLoadParts);
    exec.to_device(nothing.data(), nothing.size(), data<LoadSums>(field::load_sums));
  }
  make_solids(in_its_axes, plan, moves);
  forget_near();
  exec.to_device(first_position.data(), n, position());
  exec.to_device(first_velocity.data(), n, velocity());
  exec.to_device(first_id.data(), n, ids());
  release(first_position);  // before lists are made, which need memory
  release(first_velocity);
  release(first_id);
}

template <class Real, class Exec>
void StepContext<Real, Exec>::make_solids(const Scene& in_its_axes, const Plan& plan, int moves) {
  if (!has_solids(scene) && !has_motion(scene)) return;
  placed_.resize(plan.solids.size());
  moving_.make(exec, scene, plan.substeps);
  place(placed_at(in_its_axes, plan, p.boundary, 0));
  Surroundings<Real> around;
  around.walls = p.boundary;
  around.solid = placed_.data();
  around.before = moving_.before();
  around.solids = int(plan.solids.size());
  around.flat = p.dimensions == 2;
  if (has_loads(scene)) around.loads = load_book(*this, data<LoadSums>(field::load_sums));
  around_.resize(1);
  exec.to_device(&around, 1, around_.data());
  solids_.around = around_.data();
  solids_.frame = moving_.frame();
  if (!has_solids(scene)) return;
  const RunBounds<Real> run = bounds_of_run(in_its_axes, plan, p.boundary);
  solids_.obstacles = !plan.solids.empty();
  solids_.bounds = run.all;
  solids_.clear = clear_of(p.boundary);
  near_count_.resize(1);
  const double move = 0.8 * kNearRoom / moves;
  solids_.near = {data<Real>(field::near_room), data<int>(field::near_row), near_count_.data(),
                  nullptr, Real(move * move)};
  const std::vector<Real> behind(Exec::padding, solids_.near.far_way_squared);
  exec.to_device(behind.data(), behind.size(), data<Real>(field::near_room) + rows_);
  const std::vector<int> cells = half_cells_near_solids(scene, run.standing, run.moving, p,
                                                        solids_.clear, has_wall_loads(scene));
  near_half_cells_.resize(cells.size());
  exec.to_device(cells.data(), cells.size(), near_half_cells_.data());
}

/// A copy of the state, from which later updates can be repeated.
template <class Real, class Exec>
struct SavedState {
  template <class T>
  using Buffer = typename Exec::template Buffer<T>;
  Buffer<Vec4<Real>> position, velocity;
  Buffer<int> id;
  Buffer<StepCounts> counts;
  Buffer<Load> loads;
  Buffer<FlowCount> flows;

  bool empty() const { return counts.size() == 0; }
  StateArrays<Real> state() {
    return {position.data(), velocity.data(),   id.data(),    counts.data(),
            loads.data(),    int(loads.size()), flows.data(), int(flows.size())};
  }
  std::size_t bytes() const { return position.bytes() + velocity.bytes() + id.bytes(); }

  void save(StepContext<Real, Exec>& c) {
    const auto n = std::size_t(c.rows());
    position.resize(n);
    velocity.resize(n);
    id.resize(n);
    counts.resize(1);
    loads.resize(std::size_t(c.state().walls));
    flows.resize(std::size_t(c.state().flows));
    c.items(CopyStatePass<Real>{c.state(), state()});
  }
  void restore(StepContext<Real, Exec>& c) { c.items(CopyStatePass<Real>{state(), c.state()}); }
};

}  // namespace pbf::inline PBF_VARIANT
