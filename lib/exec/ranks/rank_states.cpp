#include "lib/exec/ranks/rank_states.h"

#include <numeric>

#include "lib/exec/ranks/packing.h"
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

SolverState whole_state(const SolverState& rank_0, const std::vector<std::vector<char>>& parts,
                        const Scene& scene, const Plan& plan) {
  SolverState all = rank_0;
  const auto n = std::size_t(plan.particles);
  const bool only_positions = rank_0.velocity.empty();
  all.position.assign(3 * n, 0), all.velocity.assign(only_positions ? 0 : 3 * n, 0);
  all.id.resize(only_positions ? 0 : n);  // as a solver alone returns them
  std::iota(all.id.begin(), all.id.end(), 0);
  std::erase_if(all.fields, [](const StoredField& f) { return f.name == field::row_state.name; });
  bool first = true;
  for (const std::vector<char>& part : parts) {
    const SolverState s = state_of(part);
    place_rows(s.position, s.id, 3, all.position);
    if (!only_positions) place_rows(s.velocity, s.id, 3, all.velocity);
    for (StoredField& f : all.fields) {
      const FieldInfo& info = *field_of(plan, f.name);
      const StoredField& other = *s.find(f.name);
      if (info.is_per_particle()) {
        if (first) f.values.assign(n * std::size_t(f.numbers), 0);
        place_rows(other.values, s.id, std::size_t(f.numbers), f.values);
      } else if (is_part(info, plan) && !first) {
        add_values(info, other.values, f.values);
      }
    }
    first = false;
  }
  for (StoredField& f : all.fields) {
    gather_sums(f, scene, plan.particles);
    normalize(*field_of(plan, f.name), f.values);
  }
  return all;
}

SolverState part_of_state(const SolverState& all, const Scene& scene, const Plan& plan, int rank,
                          int ranks) {
  const auto n = std::int64_t(all.id.size());
  const std::int64_t low = n * rank / ranks, high = n * (rank + 1) / ranks;
  SolverState s = all;
  const auto cut = [&](std::vector<double>& rows, std::size_t numbers) {
    rows = {rows.begin() + std::ptrdiff_t(std::size_t(low) * numbers),
            rows.begin() + std::ptrdiff_t(std::size_t(high) * numbers)};
  };
  cut(s.position, 3), cut(s.velocity, 3);
  s.id = {all.id.begin() + low, all.id.begin() + high};
  for (StoredField& f : s.fields) {
    const FieldInfo* info = field_of(plan, f.name);
    gather_sums(f, scene, plan.capacity);
    if (info && info->is_per_particle())
      cut(f.values, std::size_t(f.numbers));
    else if (info && is_part(*info, plan) && rank != 0)
      std::ranges::fill(f.values, 0);
  }
  s.fields.push_back({field::row_state.name,
                      false,
                      field::row_state.numbers,
                      {double(high - low), double(n), 0, 0}});
  return s;
}

}  // namespace pbf::exec_module
