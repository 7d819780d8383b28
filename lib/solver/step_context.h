// The memory of a solver: the fields of a program, the parameters, and the memory of the features.
#pragma once

#include <algorithm>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "kernels/cell_index.h"
#include "lib/base/error.h"
#include "lib/program/features.h"
#include "lib/solver/internal_state.h"
#include "lib/solver/launched_rows.h"
#include "lib/solver/params.h"

namespace pbf::PBF_VARIANT {

/// The type of a row of a field in a precision. For Objects, row_of() stands beside the field.
template <class Real>
Vec4<Real> row_of(const Vectors&);
template <class Real>
Real row_of(const Numbers&);
template <class Real, class T, int count, class Word>
T row_of(const Plain<T, count, Word>&);
template <class Field, class Real>
using RowOf = decltype(row_of<Real>(std::declval<const Field&>()));

/// An array of a field; second: the second one of a pair.
struct FieldMemory {
  const FieldInfo* field;
  bool second;
  char* begin;
  std::size_t bytes;
};

/// The images of an executor that has none (lib/exec/periodic/periodic_rows.h).
struct NoImages {
  static int all() { return 0; }
  static int before_sort() { return 0; }
  static int particles() { return 0; }
  static void begin(int) {}
  static void all_own(auto&, int) {}
  static void wrap(auto&) {}
  static bool leave(auto&) { return false; }
};

template <class C, class P>
class Granted;

template <class RealType, class Exec, class FeatureSet>
struct StepContext {
  using Real = RealType;
  using Passes = typename FeatureSet::Passes;
  using Lists = typename Exec::Lists;
  template <class T>
  using Buffer = typename Exec::template Buffer<T>;
  static constexpr std::size_t padding = std::size_t(about(Exec::backend).padding);
  static constexpr Precision precision = precision_of<Real>;
  static constexpr bool changes_rows = FeatureSet::changes_rows;

  StepContext(Exec& executor, const Scene& of, const Plan& planned)
      : exec(executor), plan(planned), scene(of), p(make_params<Real>(of, planned)) {
    for (int k = 0; k < of.solver.iterations; ++k)
      factors.push_back(
          Real(plan.sor * (plan.sor_factors.empty() ? 1 : plan.sor_factors[std::size_t(k)])));
  }

  Exec& exec;
  const Plan& plan;
  Scene scene;  ///< with the present step
  Params<Real> p;
  Lists lists{};
  bool lists_are_current = false;
  const char* booked_as = nullptr;  ///< stage for the times of passes; null: their own stages
  int iteration = 0;                ///< of the substep
  int iterations = 0;               ///< since the lists were made
  int launched = 0;                 ///< most particles until the host looks again
  bool iterating = false;
  std::vector<Real> factors{};  ///< omega of each iteration

  int capacity() const { return int(plan.capacity); }  ///< rows of the arrays of particles
  /// The number of particles, for launches. Only some solvers have it in the executor's memory.
  auto rows() {
    if constexpr (changes_rows)
      return exec.counted(data(field::row_state), launched);
    else
      return capacity();
  }
  /// What is known of images beyond periodic faces; null if there are none.
  auto* images() {
    if constexpr (requires { exec.images(); })
      return exec.images();
    else
      return static_cast<NoImages*>(nullptr);
  }
  /// The number of rows for the host, which waits. Throws Error(guard) if there were too many.
  int host_rows() {
    if (auto* all = images()) return all->all();
    return host_particles(data(field::row_state));
  }
  /// The number of rows before the last sort.
  int rows_of_sort() {
    if (auto* all = images()) return all->before_sort();
    return host_rows();
  }
  /// The same as host_rows() without images.
  int host_particles(const RowState* state) {
    if (auto* all = images()) return all->particles();
    if (!pbf::changes_rows(scene)) return capacity();
    RowState now;
    exec.to_host(state, 1, &now);
    std::string who;
    if (now.refused > 0) for_features([&](auto& memory) { who += memory.no_row_text(*this); });
    if (now.refused > 0) throw Error(ExitCode::guard, who + no_room_text(now.refused, capacity()));
    return int(now.rows);
  }
  /// Integers that passes have added up, over all ranks.
  template <class Sums>
  void sums_to_host(const Sums* from, std::vector<Sums>& to) {
    exec.to_host(from, to.size(), to.data());
    if constexpr (requires { exec.add_up(to); }) exec.add_up(to);
  }
  /// The place of each of n rows in the order of ids, in the memory of the executor.
  const int* order_of_ids(const int* id, int n) {
    if (!pbf::changes_rows(scene)) return id;  // they are 0 ... n - 1
    place_.resize(std::size_t(capacity()));
    exec.rank(n, id, place_.data());
    return place_.data();
  }
  /// The ids of n rows, ascending.
  std::vector<int> ids_in_order(const int* id, int n) {
    std::vector<int> all(static_cast<std::size_t>(n));
    if (pbf::changes_rows(scene)) {
      exec.to_host(id, all.size(), all.data());
      std::sort(all.begin(), all.end());
    } else {
      std::iota(all.begin(), all.end(), 0);
    }
    return all;
  }
  const char* booked(const char* stage) const { return booked_as ? booked_as : stage; }
  void take_lists(const Lists& l) { lists = l, lists_are_current = true, iterations = 0; }
  void make_lists() {
    take_lists(lists);
    const auto make = [this](const auto& of) {
      lists = exec.build_lists(of, capacity(), position(), data(field::bin_start), p);
    };
    if constexpr (requires { exec.before_known(make); })
      if (exec.before_known(make)) return;
    make(rows());
  }

  /// The present rows of a field; null if the program does not use it.
  template <class Field>
  RowOf<Field, Real>* data(const Field& f) {
    return data<RowOf<Field, Real>>(f);
  }
  template <class T>
  T* data(const FieldInfo& f) {
    return reinterpret_cast<T*>(bytes_of(f));
  }
  char* bytes_of(const FieldInfo& f) {
    Slot* s = slot(f);
    return s ? s->rows[s->now ^ (f.first ? 1 : 0)].data() : nullptr;
  }
  std::int64_t rows_of(const FieldInfo& f) const { return f.rows(sizes()); }
  std::size_t kept_rows(const FieldInfo& f) const { return std::size_t(f.kept_rows(sizes())); }
  /// Copies the first rows of a field to the memory of the executor. Without the field, there must
  /// be none.
  template <class Field>
  void put(const Field& f, const std::vector<RowOf<Field, Real>>& rows) {
    if (rows.empty()) return;
    if (!slot(f) || std::int64_t(rows.size()) > rows_of(f))
      throw Error(ExitCode::internal, std::string("too many rows for the field ") + f.name);
    exec.to_device(rows.data(), rows.size(), data(f));
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
  void flip(const FieldInfo& f) {
    if (Slot* s = slot(f)) s->now ^= 1;  // a scene may lack the field
  }
  void flip_carried() {
    for (const CarriedField& c : plan.program.carried_fields) flip(*c.first);
  }
  Vec4<Real>* position() { return data(field::position); }
  Vec4<Real>* velocity() { return data(field::velocity); }
  Real* density() { return data(field::density); }
  int* ids() { return data(field::id); }
  /// Memory for the order of a sort (capacity() integers), in a pass that flips the ids.
  int* sort_order() { return order_in_place ? data(field::id) : data(field::order); }
  /// What a sort copies besides position, velocity and id, after the flips.
  CarriedRows carried() {
    CarriedRows all;
    for (const CarriedField& c : plan.program.carried_fields)
      all.part[all.parts++] = {data<std::uint32_t>(*c.second), data<std::uint32_t>(*c.first),
                               c.first->bytes(precision) / 4};
    return all;
  }

  /// Calls launch(c) with the fields as pass P declares them. The hooks of features
  /// (lib/program/feature.h) launch their passes so.
  template <class P>
  void as_pass(const auto& launch);
  template <class F>
  auto& memory() {
    return std::get<MemoryOf<F, Real>>(features_);
  }
  /// Calls f(memory) for every feature.
  template <class F>
  void for_features(F&& f) {
    std::apply([&](auto&... memory) { (f(memory), ...); }, features_);
  }

  /// Bits that tell which of its two arrays is the first for each pair. Recorded updates are valid
  /// for one such placement.
  int placement() const {
    int bits = 0, bit = 1;
    for (const Slot& s : slots_)
      if (s.info->pair) bits |= s.now ? bit : 0, bit *= 2;
    return bits;
  }

  /// Creates the arrays and uploads the state of the first particles. Frees its vectors.
  void make(InternalState<Real>& first) {
    const auto n = std::int64_t(first.id.size());
    for (const FieldInfo* f : plan.program.fields)
      if (f != &field::order || !order_in_place) add(*f, n);
    const auto upload = [&](const auto& f, auto& rows) {
      put(f, rows);
      release(rows);  // before lists are made, which need memory
    };
    upload(field::position, first.position);
    upload(field::velocity, first.velocity);
    upload(field::id, first.id);
    if (slot(field::row_state)) put(field::row_state, {RowState{n, n}});
    for_features([&](auto& memory) { memory.make(*this); });
    for_features([&](auto& memory) { memory.stand(*this, 0); });
    for_features([&](auto& memory) { memory.forget(*this); });
  }

  std::size_t bytes() const {
    std::size_t sum = 0;
    for (const Slot& s : slots_) sum += s.rows[0].bytes() + s.rows[1].bytes();
    return sum;
  }

 private:
  static constexpr bool order_in_place = about(Exec::backend).order_in_place;
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
  Sizes sizes() const { return {scene, plan, capacity(), std::int64_t(padding), bin_count(p)}; }
  /// n: rows that are set soon.
  void add(const FieldInfo& f, std::int64_t n) {
    slots_.push_back({&f, {}, 0});
    const std::size_t row = std::size_t(f.bytes(precision)), bytes = std::size_t(rows_of(f)) * row;
    const bool padded = f.rows == per_padded_row;
    const std::size_t used = std::size_t(n) * row;
    for (int k = 0; k < (f.pair ? 2 : 1); ++k) {
      slots_.back().rows[k].resize(bytes);
      char* begin = slots_.back().rows[k].data();
      const bool whole = f.life > Life::run && !field::is_basic(f);
      if (whole || padded) clear(begin + (whole ? 0 : used), bytes - (whole ? 0 : used));
      if (&f != &field::position) continue;
      // Padding after the last row: outside of the range of any kernel.
      const Real far = Real(1e9);
      const std::vector<Vec4<Real>> rows(padding, {far, far, far, Real(1)});
      exec.to_device(rows.data(), padding, reinterpret_cast<Vec4<Real>*>(begin) + capacity());
    }
  }
  void clear(char* begin, std::size_t bytes) {
    if constexpr (requires { exec.clear_pages(begin, bytes); })
      return exec.clear_pages(begin, bytes);
    const std::vector<char> zeros(std::min<std::size_t>(bytes, 1 << 20));
    for (std::size_t done = 0; done < bytes; done += zeros.size())
      exec.to_device(zeros.data(), std::min(zeros.size(), bytes - done), begin + done);
  }

  Buffer<int> place_;
  std::vector<Slot> slots_;  ///< few: a linear search is faster than a map
  typename FeatureSet::template Memory<Real> features_;
};

}  // namespace pbf::PBF_VARIANT
