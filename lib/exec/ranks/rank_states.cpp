#include "lib/exec/ranks/rank_states.h"

#include <iterator>
#include <numeric>

#include "lib/exec/ranks/packing.h"
#include "lib/program/exchanges.h"
#include "lib/program/features/dissipation.h"

namespace pbf::exec_module {
namespace {

const FieldInfo* field_of(const Plan& plan, const std::string& name) {
  for (const FieldInfo* f : plan.program.state)
    if (f->name == name) return f;
  return nullptr;
}
/// Whether each rank has added up its own part of the field.
bool is_part(const FieldInfo& field, const Plan& plan) {
  for (const PassInfo& pass : plan.program.passes)
    for (const AccessInfo& a : pass.declared)
      if (a.field == &field && a.how == kAdds) return true;
  return false;
}
/// What two ranks have added up: the sums; of the counts, the last is a maximum.
void add_values(const FieldInfo& f, const std::vector<double>& more, std::vector<double>& sums) {
  for (std::size_t k = 0; k < sums.size(); ++k) {
    const bool largest = &f == &field::counts && k + 1 == sums.size();
    sums[k] = largest ? std::max(sums[k], more[k]) : sums[k] + more[k];
  }
}
/// Sums in the form in which a solver alone would have them, with carries done.
void normalize(const FieldInfo& f, std::vector<double>& values) {
  std::vector<char> row(std::size_t(f.bytes(Precision::dbl)));
  const auto numbers = std::size_t(f.numbers);
  for (std::size_t k = 0; f.from_numbers && k < values.size(); k += numbers) {
    f.from_numbers(values.data() + k, row.data());
    f.to_numbers(row.data(), values.data() + k);
  }
}

/// Each cause has several sums, as many as particles make useful. The total goes to the first.
void gather_sums(StoredField& f, const Scene& scene, std::int64_t particles) {
  if (f.name != field::dissipation.name) return;
  const auto numbers = std::size_t(f.numbers), causes = dissipations(scene).size();
  const std::size_t each = f.values.size() / causes, now = dissipation_sums(particles) * numbers;
  std::vector<double> all(causes * now);
  for (std::size_t k = 0; k < f.values.size(); ++k)
    all[k / each * now + k % numbers] += f.values[k];
  f.values = std::move(all);
}

}  // namespace

std::vector<char> packed(const SolverState& s) {
  Packer p;
  p.add(s.precision).add(s.updates).add(s.steps).add(s.position).add(s.velocity).add(s.id);
  p.add(s.fields.size());
  for (const StoredField& f : s.fields) p.add(f.name).add(f.real).add(f.numbers).add(f.values);
  return std::move(p.bytes);
}
SolverState state_of(const std::vector<char>& packed) {
  Unpacker from(packed);
  SolverState s;
  from.take(s.precision), from.take(s.updates), from.take(s.steps);
  from.take(s.position), from.take(s.velocity), from.take(s.id);
  s.fields.resize(from.take<std::size_t>());
  for (StoredField& f : s.fields)
    from.take(f.name), from.take(f.real), from.take(f.numbers), from.take(f.values);
  return s;
}

namespace {

bool of_particles(const StoredField& f, const Plan& plan) {
  const FieldInfo* info = field_of(plan, f.name);
  return info && info->is_per_particle();
}
StoredField without_values(const StoredField& f) { return {f.name, f.real, f.numbers, {}}; }
SolverState without_rows(const SolverState& s) {
  SolverState out;
  out.precision = s.precision, out.updates = s.updates, out.steps = s.steps;
  return out;
}
/// Numbers of the rows from `first` to `last` - 1.
template <class T>
std::vector<T> cut_out(const std::vector<T>& all, std::size_t first, std::size_t last,
                       std::size_t numbers) {
  if (all.empty()) return {};  // has none of them, as velocities of StateOf::positions
  return {all.begin() + std::ptrdiff_t(first * numbers),
          all.begin() + std::ptrdiff_t(last * numbers)};
}
template <class T>
std::vector<T> picked_rows(const std::vector<T>& all, const std::vector<int>& rows,
                           std::size_t numbers) {
  std::vector<T> part;
  part.reserve(rows.size() * numbers);
  for (const int i : rows) {
    const auto row = all.begin() + std::ptrdiff_t(std::size_t(i) * numbers);
    part.insert(part.end(), row, row + std::ptrdiff_t(numbers));
  }
  return part;
}
/// Row k of `from` becomes row ids[k] - first of `to`.
template <class T>
void place(const std::vector<T>& from, const std::vector<std::int64_t>& ids, std::int64_t first,
           std::size_t numbers, std::vector<T>& to) {
  for (std::size_t k = 0; k < ids.size() && !from.empty(); ++k)
    std::copy_n(from.begin() + std::ptrdiff_t(k * numbers), numbers,
                to.begin() + std::ptrdiff_t(std::size_t(ids[k] - first) * numbers));
}
template <class T>
void join(const std::vector<T>& from, std::vector<T>& to) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

SolverState head_of(const SolverState& s, const Plan& plan) {
  SolverState head = without_rows(s);
  for (const StoredField& f : s.fields)
    head.fields.push_back(of_particles(f, plan) ? without_values(f) : f);
  return head;
}

void WholeHead::add(const SolverState& part) {
  if (empty_) {
    all_ = part;
    std::erase_if(all_.fields,  // a solver alone has none
                  [](const StoredField& f) { return f.name == field::row_state.name; });
  }
  for (StoredField& f : all_.fields)
    if (!empty_ && is_part(*field_of(plan_, f.name), plan_))
      add_values(*field_of(plan_, f.name), part.find(f.name)->values, f.values);
  empty_ = false;
}
SolverState WholeHead::result() && {
  for (StoredField& f : all_.fields) {
    if (of_particles(f, plan_)) continue;
    gather_sums(f, scene_, plan_.particles);
    normalize(*field_of(plan_, f.name), f.values);
  }
  return std::move(all_);
}

SolverState head_of_rank(const SolverState& head, const Scene& scene, const Plan& plan, int rank,
                         std::int64_t own) {
  SolverState s = without_rows(head);
  for (const StoredField& f : head.fields) {
    const FieldInfo* info = field_of(plan, f.name);
    StoredField& part = s.fields.emplace_back(without_values(f));
    if (of_particles(f, plan)) continue;
    part.values = f.values;
    gather_sums(part, scene, plan.capacity);
    if (info && is_part(*info, plan) && rank != 0) std::ranges::fill(part.values, 0);
  }
  s.fields.push_back({field::row_state.name,
                      false,
                      field::row_state.numbers,
                      {double(own), double(plan.particles), 0, 0}});
  return s;
}

SolverState rows_between(const SolverState& s, std::int64_t first, std::int64_t last,
                         const Plan& plan) {
  const auto row_of = [&](std::int64_t id) {
    return std::size_t(std::ranges::lower_bound(s.id, id) - s.id.begin());
  };
  const std::size_t low = row_of(first), high = row_of(last);
  SolverState rows = without_rows(s);
  rows.position = cut_out(s.position, low, high, 3);
  rows.velocity = cut_out(s.velocity, low, high, 3);
  rows.id = cut_out(s.id, low, high, 1);
  for (const StoredField& f : s.fields)
    if (of_particles(f, plan))
      rows.fields.emplace_back(without_values(f)).values =
          cut_out(f.values, low, high, std::size_t(f.numbers));
  return rows;
}

SolverState piece_of(const SolverState& head, StateOf which, std::int64_t first, std::int64_t rows,
                     const Plan& plan) {
  const auto n = std::size_t(rows);
  SolverState piece = without_rows(head);
  piece.position.resize(3 * n);
  if (which == StateOf::positions) return piece;  // as a solver alone returns them
  piece.velocity.resize(3 * n);
  piece.id.resize(n);
  std::iota(piece.id.begin(), piece.id.end(), first);
  for (const StoredField& f : head.fields)
    if (of_particles(f, plan))
      piece.fields.emplace_back(without_values(f)).values.resize(n * std::size_t(f.numbers));
  return piece;
}
void place_rows(const SolverState& rows, std::int64_t first, SolverState& piece) {
  place(rows.position, rows.id, first, 3, piece.position);
  place(rows.velocity, rows.id, first, 3, piece.velocity);
  for (StoredField& f : piece.fields)
    place(rows.find(f.name)->values, rows.id, first, std::size_t(f.numbers), f.values);
}

SolverState picked(const SolverState& s, const std::vector<int>& rows, const Plan& plan) {
  SolverState part = without_rows(s);
  part.position = picked_rows(s.position, rows, 3);
  part.velocity = picked_rows(s.velocity, rows, 3);
  part.id = picked_rows(s.id, rows, 1);
  for (const StoredField& f : s.fields)
    if (of_particles(f, plan))
      part.fields.emplace_back(without_values(f)).values =
          picked_rows(f.values, rows, std::size_t(f.numbers));
  return part;
}
void append(const SolverState& rows, SolverState& to) {
  join(rows.position, to.position), join(rows.velocity, to.velocity), join(rows.id, to.id);
  for (const StoredField& f : rows.fields)
    for (StoredField& all : to.fields)
      if (all.name == f.name) join(f.values, all.values);
}

FirstRanks::FirstRanks(const Scene& scene, const Plan& plan, int ranks)
    : axis_(std::size_t(plan.axes.of[2])),
      origin_(scene.origin()[axis_]),
      h_(scene.h()),
      cell_(plan.cell_edge),
      ranks_(ranks),
      unit_(layers_per_unit(plan)),
      in_layer_(std::size_t(plan.cells[2])) {}

int FirstRanks::layer(double at, bool in_h) const {
  const double x = in_h ? at : (at - origin_) / h_;
  return int(std::clamp(x / cell_, 0.0, double(in_layer_.size()) - 1));
}
void FirstRanks::count(const SolverState& rows) {
  for (std::size_t k = axis_; k < rows.position.size(); k += 3)
    ++in_layer_[std::size_t(layer(rows.position[k], true))];
}
void FirstRanks::count(const Particles& rows) {
  for (const Double3& x : rows.position) ++in_layer_[std::size_t(layer(x[axis_], false))];
}
void FirstRanks::cut() { slabs_ = Slabs(in_layer_, ranks_, unit_); }
std::int64_t FirstRanks::particles(int rank) const {
  return std::accumulate(in_layer_.begin() + slabs_.low(rank),
                         in_layer_.begin() + slabs_.high(rank), std::int64_t(0));
}
std::vector<std::vector<int>> FirstRanks::rows_of_ranks(const SolverState& rows) const {
  std::vector<std::vector<int>> all(static_cast<std::size_t>(ranks_));
  for (std::size_t k = axis_; k < rows.position.size(); k += 3)
    all[std::size_t(slabs_.owner(layer(rows.position[k], true)))].push_back(int(k / 3));
  return all;
}
std::vector<std::vector<int>> FirstRanks::rows_of_ranks(const Particles& rows) const {
  std::vector<std::vector<int>> all(static_cast<std::size_t>(ranks_));
  for (std::size_t k = 0; k < rows.size(); ++k)
    all[std::size_t(slabs_.owner(layer(rows.position[k][axis_], false)))].push_back(int(k));
  return all;
}

Particles part_of(const Particles& all, const std::vector<int>& rows, std::int64_t first) {
  Particles part;
  part.position = picked_rows(all.position, rows, 1);
  part.velocity = picked_rows(all.velocity, rows, 1);
  for (const int i : rows) part.ids.push_back(int(first + i));
  return part;
}

}  // namespace pbf::exec_module
