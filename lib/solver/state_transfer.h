// Copies a state: between the fields of a step and the host, with the particles in the order of
// ids, since the order of rows is not part of a state; and within the memory of an executor.
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "kernels/axes.h"
#include "kernels/pass_copy.h"
#include "lib/solver/solver_state.h"
#include "lib/solver/step_context.h"

namespace pbf::PBF_VARIANT {

/// Moves the rows of one field between numbers on the host and a row in the field's own form.
/// Vectors are along the scene's axes on the host.
template <class Real>
class RowForm {
 public:
  RowForm(const FieldInfo& f, const Axes& axes)
      : f_(f), axes_(axes), sign_(f.shown.axial ? axes.handedness() : 1) {}

  void to_numbers(const char* row, double* to) const {
    if (f_.to_numbers) return f_.to_numbers(row, to);
    const Real* from = reinterpret_cast<const Real*>(row);
    if (f_.numbers == 1) return void(to[0] = double(from[0]));
    for (int k = 0; k < 3; ++k) to[axes_.of[k]] = sign_ * double(from[k]);
  }
  /// w of vectors: 1 for positions, else 0.
  void from_numbers(const double* from, char* row) const {
    if (f_.from_numbers) return f_.from_numbers(from, row);
    Real* to = reinterpret_cast<Real*>(row);
    if (f_.numbers == 1) return void(to[0] = Real(from[0]));
    for (int k = 0; k < 3; ++k) to[k] = Real(sign_ * from[axes_.of[k]]);
    to[3] = Real(&f_ == &field::position ? 1 : 0);
  }

 private:
  const FieldInfo& f_;
  const Axes& axes_;
  int sign_;
};

constexpr std::size_t kTransferRows = 1 << 16;  ///< copied at a time, to save memory

/// The numbers of the first n rows of a field. place: null, or where each row is in the result.
template <class C>
std::vector<double> downloaded(C& c, const FieldInfo& f, const char* from, std::size_t n,
                               const int* place) {
  const RowForm<typename C::Real> form(f, c.plan.axes);
  const std::size_t part = std::min(n, kTransferRows), row = std::size_t(f.bytes(C::precision));
  const std::size_t numbers = std::size_t(f.numbers);
  std::vector<int> places(place ? part : 0);
  std::vector<char> rows(part * row);
  std::vector<double> out(numbers * n);
  for (std::size_t first = 0; first < n; first += part) {
    const std::size_t count = std::min(part, n - first);
    if (place) c.exec.to_host(place + first, count, places.data());
    c.exec.to_host(from + first * row, count * row, rows.data());
    for (std::size_t k = 0; k < count; ++k)
      form.to_numbers(rows.data() + k * row,
                      out.data() + numbers * (place ? std::size_t(places[k]) : first + k));
  }
  return out;
}

/// The inverse: `values` become the first rows of the field.
template <class C>
void upload(C& c, const FieldInfo& f, const std::vector<double>& values) {
  const RowForm<typename C::Real> form(f, c.plan.axes);
  const std::size_t numbers = std::size_t(f.numbers), n = values.size() / numbers;
  const std::size_t part = std::min(n, kTransferRows), row = std::size_t(f.bytes(C::precision));
  std::vector<char> rows(part * row);
  for (std::size_t first = 0; first < n; first += part) {
    const std::size_t count = std::min(part, n - first);
    for (std::size_t k = 0; k < count; ++k)
      form.from_numbers(values.data() + numbers * (first + k), rows.data() + k * row);
    c.exec.to_device(rows.data(), count * row, c.bytes_of(f) + first * row);
  }
}

/// from: the arrays of Program::state, the present ones or a copy.
template <class C>
SolverState download_state(C& c, const std::vector<const char*>& from) {
  const auto& state = c.plan.program.state;
  const auto at = [&](const FieldInfo& f) {
    return from[std::size_t(std::find(state.begin(), state.end(), &f) - state.begin())];
  };
  const int* id = reinterpret_cast<const int*>(at(field::id));
  const int n = c.host_particles(
      reinterpret_cast<const RowState*>(changes_rows(c.scene) ? at(field::row_state) : nullptr));
  const int* place = c.order_of_ids(id, n);
  const auto values = [&](const FieldInfo& f) {
    const bool sorted = f.is_per_particle();
    return downloaded(c, f, at(f), sorted ? std::size_t(n) : c.kept_rows(f),
                      sorted ? place : nullptr);
  };
  SolverState s;
  s.precision = C::precision;
  s.position = values(field::position);
  s.velocity = values(field::velocity);
  const std::vector<int> ids = c.ids_in_order(id, n);
  s.id.assign(ids.begin(), ids.end());
  for (const FieldInfo* f : state)
    if (!field::is_basic(*f))
      s.fields.push_back({f->name, f->type == Type::real, f->numbers, values(*f)});
  return s;
}

/// The values of a field in a state, for so many rows. Zeros if the state has none, or other rows
/// than one per particle (of another scene); and for the last numbers of a row that an older state
/// lacks. Throws Error(io) for rows of particles in another number, and for more numbers.
inline std::vector<double> values_of(const SolverState& s, const FieldInfo& f, std::size_t rows) {
  const std::size_t numbers = std::size_t(f.numbers);
  std::vector<double> values(rows * numbers);
  const StoredField* stored = s.find(f.name);
  if (!stored) return values;
  const std::size_t width = std::size_t(stored->numbers);
  const bool fits = stored->values.size() == rows * width;
  if (!fits && !f.is_per_particle()) return values;
  if (!fits || width > numbers)
    throw Error(ExitCode::io, std::string("the field '") + f.name +
                                  "' of the state does not fit this scene and version");
  for (std::size_t k = 0; k < rows; ++k)
    std::copy_n(stored->values.begin() + std::ptrdiff_t(k * width), width,
                values.begin() + std::ptrdiff_t(k * numbers));
  return values;
}

/// Throws as values_of(), before anything is uploaded.
template <class C>
void upload_state(C& c, const SolverState& s) {
  std::vector<std::vector<double>> values;
  for (const FieldInfo* f : c.plan.program.state)
    values.push_back(field::is_basic(*f)
                         ? std::vector<double>{}
                         : values_of(s, *f, f->is_per_particle() ? s.id.size() : c.kept_rows(*f)));
  for (std::size_t k = 0; k < values.size(); ++k) upload(c, *c.plan.program.state[k], values[k]);
  upload(c, field::position, s.position);
  upload(c, field::velocity, s.velocity);
  c.put(field::id, std::vector<int>(s.id.begin(), s.id.end()));
}

/// A copy of the state in the memory of an executor, from which later updates can be repeated.
template <class Exec>
class SavedState {
 public:
  bool empty() const { return copies_.empty(); }
  std::size_t bytes() const {
    std::size_t sum = 0;
    for (const auto& copy : copies_) sum += copy.bytes();
    return sum;
  }
  /// The copies, in the order of Program::state.
  std::vector<const char*> arrays() const {
    std::vector<const char*> all;
    for (const auto& copy : copies_) all.push_back(copy.data());
    return all;
  }
  template <class C>
  void save(C& c) {
    make_room(c, std::size_t(c.capacity()));
    copy(c, [&](std::size_t k) -> CopyPass::Part {
      return {c.bytes_of(*c.plan.program.state[k]), copies_[k].data(), used_[k]};
    });
  }
  /// The rows of a rank become the first of the copy. now: what it has then, for field::row_state.
  template <class C>
  void save_rows(C& c, const RowRange& own, const RowState& now) {
    make_room(c, std::size_t(own.last - own.first));
    for (std::size_t k = 0; k < copies_.size(); ++k) {
      const FieldInfo& f = *c.plan.program.state[k];
      const std::size_t first =
          f.is_per_particle() ? std::size_t(own.first) * std::size_t(f.bytes(C::precision)) : 0;
      if (&f == &field::row_state)
        c.exec.to_device(&now, 1, reinterpret_cast<RowState*>(copies_[k].data()));
      else
        c.exec.copy(c.bytes_of(f) + first, copies_[k].data(), std::size_t(used_[k]));
    }
  }
  template <class C>
  void restore(C& c) {
    copy(c, [&](std::size_t k) -> CopyPass::Part {
      return {copies_[k].data(), c.bytes_of(*c.plan.program.state[k]), used_[k]};
    });
  }

 private:
  /// rows: so many are copied of the fields of particles. Arrays have room for many more, which
  /// takes no memory on the host until it is written.
  template <class C>
  void make_room(C& c, std::size_t rows) {
    const auto& state = c.plan.program.state;
    copies_.resize(state.size());
    used_.resize(state.size());
    for (std::size_t k = 0; k < state.size(); ++k) {
      const auto row = std::size_t(state[k]->bytes(C::precision)), all = c.kept_rows(*state[k]);
      copies_[k].resize(all * row);
      used_[k] = std::int64_t((state[k]->is_per_particle() ? rows : all) * row);
    }
  }
  /// Copies all fields in one launch, because a run with a guard does so at every measurement.
  template <class C, class PartOf>
  void copy(C& c, const PartOf& part_of) {
    CopyPass pass;
    std::int64_t longest = 0;
    const auto launch = [&] {
      c.exec.items(int((longest + CopyPass::unit - 1) / CopyPass::unit), pass);
      pass.parts = 0;
      longest = 0;
    };
    for (std::size_t k = 0; k < copies_.size(); ++k) {
      pass.part[pass.parts++] = part_of(k);
      longest = std::max(longest, used_[k]);
      if (pass.parts == CopyPass::most) launch();
    }
    if (pass.parts > 0) launch();
  }

  std::vector<typename Exec::template Buffer<char>> copies_;
  std::vector<std::int64_t> used_;  ///< bytes of each copy that hold something
};

/// s, by how much the velocities are earlier than the positions, as far as the scheme knows: half
/// of the last step in second order.
template <class Context>
double velocity_lag(Context& c) {
  if (!is_second_order(c.scene)) return 0;
  StepLength last;
  c.exec.to_host(c.data(field::step_length), 1, &last);
  return last.dt / 2;
}

}  // namespace pbf::PBF_VARIANT
