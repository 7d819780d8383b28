#include "lib/program/program.h"

#include <fmt/core.h>
#include <algorithm>

#include "lib/base/error.h"
#include "lib/base/text.h"
#include "lib/program/features.h"
#include "lib/program/make_program.h"

namespace pbf::program_module {
namespace {

/// Fuses pass b with the last pass of `steps`. False if no pass does the work of both. If the last
/// pass belongs to iterations, the last iteration becomes a step of its own.
bool join(Steps& steps, int b, const PassSet& passes) {
  if (steps.empty()) return false;
  ProgramStep& last = steps.back();
  if (last.kind == ProgramStep::pass) {
    const int both = passes.fused(last.index, b);
    if (both >= 0) last.index = both;
    return both >= 0;
  }
  if (last.kind != ProgramStep::iterate || last.times == 0) return false;
  ProgramStep peeled = last;
  peeled.first += peeled.times - 1;
  peeled.times = 1;
  if (!join(peeled.body, b, passes)) return false;
  if (--last.times == 0) steps.pop_back();
  steps.push_back(peeled);
  return true;
}

/// The steps with all possible fusions.
Steps joined(const Steps& steps, const PassSet& passes) {
  Steps out;
  for (const ProgramStep& s : steps)
    if (s.kind != ProgramStep::pass || !join(out, s.index, passes)) out.push_back(s);
  // A fused pass may itself be fused with the one before.
  return out.size() < steps.size() ? joined(out, passes) : out;
}

/// Adds a range of substeps that share lists.
void add_substeps(Steps& to, const PassSet& b, int iterations, int repeats, int substeps) {
  for (int s = 0; s < substeps; ++s) {
    to.insert(to.end(), b.at_start.begin(), b.at_start.end());
    if (s == 0) to.insert(to.end(), b.before_sort.begin(), b.before_sort.end());
    to.push_back(b.predict);
    to.insert(to.end(), b.behind_predict.begin(), b.behind_predict.end());
    if (s == 0) {
      to.insert(to.end(), {b.sort, b.make_lists});
      to.insert(to.end(), b.with_lists.begin(), b.with_lists.end());
    }
    if (b.in_iteration.empty()) continue;
    const ProgramStep round{ProgramStep::iterate, -1, 0, iterations, b.in_iteration};
    to.push_back(round);
    if (repeats > 0) to.push_back({ProgramStep::until, -1, 0, repeats, {round}});
  }
}

void collect_fields(const Steps& steps, Program& p) {
  for (const ProgramStep& s : steps) {
    collect_fields(s.body, p);
    if (s.index < 0) continue;
    for (const AccessInfo& a : p.passes[std::size_t(s.index)].needs) {
      const FieldInfo* f = &a.field->primary();
      if (f->rows && std::find(p.fields.begin(), p.fields.end(), f) == p.fields.end())
        p.fields.push_back(f);
    }
  }
}

/// Adds the further fields of the program to what the passes that reorder rows declare.
void carry_fields(const std::vector<CarriedField>& all, Program& p) {
  for (const CarriedField& c : all) {
    const auto is = [&](const CarriedField& o) { return o.first == c.first; };
    if (std::find(p.fields.begin(), p.fields.end(), c.first) == p.fields.end() ||
        std::any_of(p.carried_fields.begin(), p.carried_fields.end(), is))
      continue;
    p.carried_fields.push_back(c);
    for (PassInfo& pass : p.passes) {
      if (!pass.reorders_rows()) continue;
      std::vector<AccessInfo> declared = std::move(pass.declared);
      declared.push_back({c.second, kLooks});
      declared.push_back({c.first, kPlaces});
      pass.flips.push_back(c.first);
      pass = described(pass, std::move(declared), std::move(pass.flips));
    }
  }
}

/// Throws Error(internal) for fields that a sort would not carry, or a state could not hold.
void check_state_fields(const Program& p) {
  const auto wrong = [](const FieldInfo& f, const char* why) {
    throw Error(ExitCode::internal, fmt::format("field '{}': {}", f.name, why));
  };
  for (const FieldInfo* f : p.fields) {
    if (f->life < Life::rows) continue;
    if (f->is_per_particle() && !f->pair)
      wrong(*f, "rows of particles that sorts carry need a pair");
    if (f->life == Life::state && f->numbers == 0) wrong(*f, "a state needs its numbers (each())");
    if (f->bytes(Precision::single) % 4 != 0) wrong(*f, "a row is no multiple of 4 bytes");
  }
  if (p.carried_fields.size() > std::size_t(CarriedRows::most))
    throw Error(ExitCode::internal, "sorts carry too many fields");
}

/// The sum that decides whether `until` repeats its body.
const PassInfo& residual() {
  static const PassInfo info =
      described({"mean compression", "residual"}, {{&field::density, kReads}}, {});
  return info;
}

const char* word(W w) {
  constexpr const char* words[] = {"", "mark", "lambda", "1/density"};
  return words[int(w)];
}

/// The contents of the fourth component w in each of the two arrays of positions.
struct Fourth {
  W first = W::any, second = W::any;

  W& of(const FieldInfo& f) { return f.first ? second : first; }
  /// Applies a pass in that iteration of a substep. Throws Error(internal) if w does not hold what
  /// the pass declares.
  void after(const PassInfo& pass, int iteration, bool has_iterations) {
    for (const FieldInfo* f : pass.flips)
      if (f == &field::position) std::swap(first, second);
    for (const AccessInfo& a : pass.declared) {
      if (&a.field->primary() != &field::position || (a.how & kWriting) || a.w == W::any ||
          (a.when == When::first_iteration && iteration > 0) || of(*a.field) == a.w)
        continue;
      throw Error(ExitCode::internal,
                  fmt::format("pass '{}' asks for {} in w of {}, which holds '{}'", pass.name,
                              word(a.w), name_of(*a.field), word(of(*a.field))));
    }
    for (const AccessInfo& a : pass.declared) {
      if (&a.field->primary() != &field::position || !(a.how & (kWrites | kPlaces))) continue;
      // The sort copies w. Without iterations no particle is marked: w is 1.
      const bool carried = (a.how & kPlaces) && a.w == W::any;
      const W w = carried ? of(other<field::position>) : a.w;
      of(*a.field) = w == W::mark && !has_iterations ? W::inverse_density : w;
    }
  }
};

void follow(const Program& p, const Steps& steps, int iteration, Fourth& w) {
  for (const ProgramStep& s : steps) {
    if (s.kind == ProgramStep::pass)
      w.after(p.passes[std::size_t(s.index)], iteration, p.has_iterations);
    // All later iterations are like the second.
    for (int k = s.first; s.kind == ProgramStep::iterate && k < s.first + std::min(s.times, 2); ++k)
      follow(p, s.body, iteration + k, w);
    if (s.kind == ProgramStep::until) follow(p, s.body, 1, w);
  }
}

/// Checks that w holds what every pass declares, with and without fused passes, in the first update
/// and in later ones.
void check_fourth(const Program& p) {
  Fourth seen, fast;
  for (int updates = 0; updates < 2; ++updates) follow(p, p.update, 0, seen);
  for (const Steps* steps : {&p.first, &p.rest, &p.next, &p.rest, &p.last})
    follow(p, *steps, 0, fast);
}

template <class Name>
std::string names(const std::vector<AccessInfo>& needs, const Name& name) {
  std::string out;
  for (const AccessInfo& a : needs)
    if (const std::string one = name(a); !one.empty()) out += (out.empty() ? "" : " ") + one;
  return out;
}

void count(const Program& program, const Steps& steps, int times, std::vector<PassCount>& to) {
  for (const ProgramStep& s : steps) {
    count(program, s.body, times * s.times, to);
    if (s.kind == ProgramStep::iterate) continue;
    const PassInfo* pass =
        s.kind == ProgramStep::until ? &residual() : &program.passes[std::size_t(s.index)];
    const int mine = s.kind == ProgramStep::until ? times * s.times : times;
    const auto at =
        std::find_if(to.begin(), to.end(), [&](const PassCount& c) { return c.pass == pass; });
    if (at == to.end())
      to.push_back({pass, mine});
    else
      at->times += mine;
  }
}

Steps operator+(Steps a, const Steps& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace

std::span<const PassText> pass_texts() { return Passes::texts; }

Program make_program(const Scene& scene, const UpdateShape& shape, bool without_time) {
  return make_program_of<Features>(scene, shape, without_time);
}

Program assembled(const Scene& scene, PassSet b, bool without_time) {
  const UpdateShape& shape = b.shape;
  Program p;
  p.has_iterations = !b.in_iteration.empty();
  if (without_time)
    b.at_start.clear(), b.before_sort.clear(), b.behind_iterations.clear(), b.behind.clear(),
        b.at_end.clear(), b.between.clear();
  Steps middle;
  if (b.in_iteration.empty() && b.behind.empty() &&
      b.before_sort.empty()) {  // no pairs: particles only move
    for (int s = 0; s < shape.substeps; ++s) {
      middle.insert(middle.end(), b.at_start.begin(), b.at_start.end());
      middle.push_back(b.predict);
    }
  } else {
    // The ranges are as equal as possible.
    for (int r = 0, from = 0; r < shape.lists_per_update; ++r) {
      const int to = int(std::int64_t(shape.substeps) * (r + 1) / shape.lists_per_update);
      add_substeps(middle, b, scene.solver.iterations, shape.repeats, to - from);
      from = to;
    }
    middle.insert(middle.end(), b.behind_iterations.begin(), b.behind_iterations.end());
  }
  const Steps end = b.behind + b.at_end;
  p.update = middle + end;
  // The passes up to the first sort may be fused with the end of the previous update.
  // Index of the sort.
  const std::size_t order = b.at_start.size() + b.before_sort.size() + 1 + b.behind_predict.size();
  const bool pairs = p.update.size() > order + 1 && p.update[order].index == b.sort.index;
  const auto begin = middle.begin() + (pairs ? std::ptrdiff_t(order + 1) : 0);
  const Steps head(middle.begin(), begin);
  p.first = joined(head, b);
  p.rest = joined(Steps(begin, middle.end()), b);
  p.next = joined(end + head, b);
  p.last = joined(end, b);
  p.rest_next = p.rest + p.next;
  p.rest_last = p.rest + p.last;
  p.lists = Steps{b.sort, b.make_lists} + b.with_all_lists;
  p.between = std::move(b.between);
  p.between_every = p.between.empty() ? 0 : b.between_every;
  p.readings = b.at_reading;
  p.passes = std::move(b.infos);
  p.fields = {&field::position, &field::velocity, &field::density, &field::id,
              &field::counts,   &field::bin,      &field::order,   &field::bin_start};
  collect_fields(p.update, p);
  collect_fields(p.between, p);
  collect_fields(p.lists, p);  // a measure makes lists in any case
  collect_fields(p.readings, p);
  for (const FieldInfo* f : p.fields)
    if (f->life == Life::state) p.state.push_back(f);
  carry_fields(b.carried_fields, p);
  p.left_out = std::move(b.without);
  if (!b.before_sort.empty() && !p.has_pairs())
    throw Error(ExitCode::internal, "particles come or go in a program without a sort");
  check_fourth(p);
  check_state_fields(p);
  return p;
}

std::vector<PassCount> count_passes(const Program& program, const Steps& steps) {
  std::vector<PassCount> out;
  count(program, steps, 1, out);
  return out;
}
std::vector<PassCount> count_passes(const Program& p) { return count_passes(p, p.next + p.rest); }

std::string reads_text(const PassInfo& pass) {
  return names(pass.needs,
               [](const AccessInfo& a) { return a.how & kReading ? name_of(*a.field) : ""; });
}
std::string writes_text(const PassInfo& pass) {
  return names(pass.needs,
               [](const AccessInfo& a) { return a.how & kWriting ? name_of(*a.field) : ""; });
}
std::string gathers_text(const PassInfo& pass) {
  return names(pass.declared, [](const AccessInfo& a) -> std::string {
    if (!(a.how & kGathers) || a.when != When::always) return "";
    const bool place = &a.field->primary() == &field::position;
    return place && a.w != W::any ? std::string("position ") + word(a.w) : a.field->name;
  });
}

}  // namespace pbf::program_module
