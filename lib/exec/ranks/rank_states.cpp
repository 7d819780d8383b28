#include "lib/exec/ranks/rank_states.h"

#include <numeric>

#include "lib/exec/ranks/packing.h"
#include "lib/exec/ranks/slabs.h"
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

void WholeState::add(const SolverState& part) {
  const auto n = std::size_t(plan_.particles);
  if (empty_) {
    all_ = part;
    all_.position.assign(3 * n, 0), all_.velocity.assign(only_positions_ ? 0 : 3 * n, 0);
    all_.id.resize(only_positions_ ? 0 : n);  // as a solver alone returns them
    std::iota(all_.id.begin(), all_.id.end(), 0);
    std::erase_if(all_.fields,
                  [](const StoredField& f) { return f.name == field::row_state.name; });
  }
  place_rows(part.position, part.id, 3, all_.position);
  if (!only_positions_) place_rows(part.velocity, part.id, 3, all_.velocity);
  for (StoredField& f : all_.fields) {
    const FieldInfo& info = *field_of(plan_, f.name);
    const StoredField& other = *part.find(f.name);
    if (info.is_per_particle()) {
      if (empty_) f.values.assign(n * std::size_t(f.numbers), 0);
      place_rows(other.values, part.id, std::size_t(f.numbers), f.values);
    } else if (is_part(info, plan_) && !empty_) {
      add_values(info, other.values, f.values);
    }
  }
  empty_ = false;
}
SolverState WholeState::result() && {
  for (StoredField& f : all_.fields) {
    gather_sums(f, scene_, plan_.particles);
    normalize(*field_of(plan_, f.name), f.values);
  }
  return std::move(all_);
}

namespace {

/// at(i): in h, along the slowest axis of the grid.
template <class At>
IdsOfRanks by_layer(std::size_t n, const At& at, const Plan& plan, int ranks) {
  const int layers = plan.cells[2];
  std::vector<int> layer(n);
  std::vector<std::int64_t> in_layer(static_cast<std::size_t>(layers));
  for (std::size_t i = 0; i < n; ++i) {
    layer[i] = int(std::clamp(at(i) / plan.cell_edge, 0.0, layers - 1.0));
    ++in_layer[std::size_t(layer[i])];
  }
  const Slabs slabs(in_layer, ranks, layers_per_unit(plan));
  IdsOfRanks ids(static_cast<std::size_t>(ranks));
  for (std::size_t i = 0; i < n; ++i) ids[std::size_t(slabs.owner(layer[i]))].push_back(int(i));
  return ids;
}

template <class T>
std::vector<T> picked(const std::vector<T>& rows, const std::vector<int>& ids,
                      std::size_t numbers) {
  std::vector<T> part;
  part.reserve(ids.size() * numbers);
  for (const int i : ids) {
    const auto row = rows.begin() + std::ptrdiff_t(std::size_t(i) * numbers);
    part.insert(part.end(), row, row + std::ptrdiff_t(numbers));
  }
  return part;
}

}  // namespace

IdsOfRanks ids_of_ranks(const Particles& all, const Scene& scene, const Plan& plan, int ranks) {
  const auto axis = std::size_t(plan.axes.of[2]);
  const double origin = scene.origin()[axis], h = scene.h();
  return by_layer(
      all.size(), [&](std::size_t i) { return (all.position[i][axis] - origin) / h; }, plan, ranks);
}
IdsOfRanks ids_of_ranks(const SolverState& all, const Plan& plan, int ranks) {
  const auto axis = std::size_t(plan.axes.of[2]);
  return by_layer(
      all.id.size(), [&](std::size_t i) { return all.position[3 * i + axis]; }, plan, ranks);
}

Particles part_of(const Particles& all, const std::vector<int>& ids) {
  Particles part;
  part.ids = ids;
  for (const int i : ids) {
    part.position.push_back(all.position[std::size_t(i)]);
    part.velocity.push_back(all.velocity[std::size_t(i)]);
  }
  return part;
}
SolverState part_of(const SolverState& all, const std::vector<int>& ids, const Scene& scene,
                    const Plan& plan, int rank) {
  SolverState s;
  s.precision = all.precision, s.updates = all.updates, s.steps = all.steps;
  s.position = picked(all.position, ids, 3), s.velocity = picked(all.velocity, ids, 3);
  s.id = picked(all.id, ids, 1);
  for (const StoredField& f : all.fields) {
    const FieldInfo* info = field_of(plan, f.name);
    StoredField& part = s.fields.emplace_back(StoredField{f.name, f.real, f.numbers});
    if (info && info->is_per_particle()) {
      part.values = picked(f.values, ids, std::size_t(f.numbers));
      continue;
    }
    part.values = f.values;
    gather_sums(part, scene, plan.capacity);
    if (info && is_part(*info, plan) && rank != 0) std::ranges::fill(part.values, 0);
  }
  s.fields.push_back({field::row_state.name,
                      false,
                      field::row_state.numbers,
                      {double(ids.size()), double(all.id.size()), 0, 0}});
  return s;
}

}  // namespace pbf::exec_module
