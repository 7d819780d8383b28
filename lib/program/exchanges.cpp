#include "lib/program/exchanges.h"

#include <fmt/core.h>

#include <algorithm>

#include "lib/base/error.h"
#include "lib/program/features/solids.h"

namespace pbf::program_module {
namespace {

/// The fields that go along with the particles. With them goes the bin: were it computed on two
/// ranks, a compiler might round differently in two kernels, and ranks disagree about a row.
Exchange::Fields carried(const Program& program) {
  Exchange::Fields out;
  for (const FieldInfo* f : program.fields)
    if (f->is_per_particle() && (f->life == Life::rows || f->life == Life::state)) out.push_back(f);
  out.push_back(&field::bin);
  return out;
}

void follow(const Program& program, const Steps& steps, bool first_iteration, RankState& state,
            std::vector<Exchange>& to) {
  for (const ProgramStep& s : steps) {
    if (s.kind == ProgramStep::pass)
      to.push_back(state.before(program.passes[std::size_t(s.index)], first_iteration, program));
    for (int k = s.first; s.kind == ProgramStep::iterate && k < s.first + s.times; ++k)
      follow(program, s.body, first_iteration && k == 0, state, to);
    if (s.kind != ProgramStep::until) continue;
    to.emplace_back();
    follow(program, s.body, false, state, to);
  }
}

}  // namespace

int row_bytes(const Exchange::Fields& fields, Precision precision) {
  int sum = 0;
  for (const FieldInfo* f : fields) sum += f->bytes(precision);
  return sum;
}

Exchange RankState::before(const PassInfo& pass, bool first_iteration, const Program& program) {
  for (const FieldInfo* f : pass.flips) {
    const bool first = fresh_.erase({f, false}), second = fresh_.erase({f, true});
    if (first) fresh_.insert({f, true});
    if (second) fresh_.insert({f, false});
  }
  const auto array = [](const AccessInfo& a) {
    return Array{&a.field->primary(), a.field->first != nullptr};
  };
  // A pass that adds to a field may read its own rank's part of it.
  const auto adds_to = [&](const FieldInfo* f) {
    return std::any_of(pass.declared.begin(), pass.declared.end(),
                       [&](const AccessInfo& a) { return a.field == f && a.how == kAdds; });
  };
  Exchange e;
  e.pass = &pass;
  bool adds = false, reads_rows = false;
  for (const AccessInfo& a : pass.declared) {
    if (a.when == When::first_iteration && !first_iteration) continue;
    if ((a.how & kGathers) && fresh_.insert(array(a)).second) e.ghosts.push_back(a.field);
    if ((a.how & kReading) && !adds_to(a.field) && parts_.erase(array(a))) {
      e.sums.push_back(a.field);
      totals_.insert(array(a));
    }
    adds = adds || a.how == kAdds;
    reads_rows = reads_rows || ((a.how & kReading) && a.field->is_per_particle());
  }
  e.on_one_rank = adds && !reads_rows;
  for (const AccessInfo& a : pass.declared) {
    if (a.field == &field::id && (a.how & kPlaces)) e.rows = carried(program);
    if (a.how & (kWrites | kPlaces))
      fresh_.erase(array(a)), parts_.erase(array(a)), totals_.erase(array(a));
    if (!(a.how & kAdds)) continue;
    if (a.how & kPlaces) e.sums_within.push_back(a.field);
    if (totals_.contains(array(a)))
      throw Error(ExitCode::internal,
                  fmt::format("pass '{}' adds to {}, which was read and not set anew", pass.name,
                              name_of(*a.field)));
    if (a.how == kAdds && parts_.insert(array(a)).second) e.from_zero.push_back(a.field);
  }
  if (e.rows.empty()) return e;
  fresh_.clear();
  for (const FieldInfo* f : e.rows) fresh_.insert({f, false});
  return e;
}

std::vector<Exchange> exchanges(const Program& program, const Steps& steps, RankState& state) {
  std::vector<Exchange> out;
  follow(program, steps, true, state, out);
  return out;
}

std::vector<Exchange> exchanges(const Program& program) {
  RankState state;
  exchanges(program, program.first, state);
  exchanges(program, program.rest, state);
  std::vector<Exchange> out = exchanges(program, program.next, state);
  for (Exchange& e : exchanges(program, program.rest, state)) out.push_back(std::move(e));
  return out;
}

bool unfused_on_ranks(const Program& program, const Scene& scene) {
  return has_more_than_walls(scene) || !program.has_pairs();
}
std::vector<Exchange> exchanges_on_ranks(const Program& program, const Scene& scene) {
  if (!unfused_on_ranks(program, scene)) return exchanges(program);
  RankState state;
  exchanges(program, program.update, state);
  return exchanges(program, program.update, state);
}

}  // namespace pbf::program_module
