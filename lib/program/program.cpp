#include "lib/program/program.h"

#include <algorithm>

#include "lib/program/features.h"

namespace pbf::inline program_module {
namespace {

ProgramStep step_of(int index) { return {ProgramStep::pass, index}; }
template <class P>
ProgramStep step_of() {
  return step_of(Passes::index_of<P>());
}

/// What features say of a scene.
struct Builder {
  Steps at_start, with_lists, in_iteration, behind, at_end;
  std::vector<LeftOut> without;

  /// Before each substep.
  template <class P>
  void start() {
    at_start.push_back(step_of<P>());
  }
  template <class P>
  void lists() {
    with_lists.push_back(step_of<P>());
  }
  template <class P>
  void iteration() {
    in_iteration.push_back(step_of<P>());
  }
  template <class P>
  void after() {
    behind.push_back(step_of<P>());
  }
  /// Behind all others, with lists or without.
  template <class P>
  void end() {
    at_end.push_back(step_of<P>());
  }
  void left_out(const char* what, const char* because) { without.push_back({what, because}); }
};

/// Joins b to the end of `steps`, where one pass does the work of both: false where none does.
/// The last of several iterations is then one by itself.
bool join(Steps& steps, int b) {
  if (steps.empty()) return false;
  ProgramStep& last = steps.back();
  if (last.kind == ProgramStep::pass) {
    const int both = Passes::fused(last.index, b);
    if (both >= 0) last.index = both;
    return both >= 0;
  }
  if (last.kind != ProgramStep::iterate || last.times == 0) return false;
  ProgramStep peeled = last;
  peeled.first += peeled.times - 1;
  peeled.times = 1;
  if (!join(peeled.body, b)) return false;
  if (--last.times == 0) steps.pop_back();
  steps.push_back(peeled);
  return true;
}

/// With every pair of passes joined that can be.
Steps joined(const Steps& steps) {
  Steps out;
  for (const ProgramStep& s : steps)
    if (s.kind != ProgramStep::pass || !join(out, s.index)) out.push_back(s);
  // A pass that does the work of two may itself be joined to the one before.
  return out.size() < steps.size() ? joined(out) : out;
}

/// One range of substeps that share lists.
void add_substeps(Steps& to, const Builder& b, int iterations, int repeats, int substeps) {
  for (int s = 0; s < substeps; ++s) {
    to.insert(to.end(), b.at_start.begin(), b.at_start.end());
    to.push_back(step_of<Predict>());
    if (s == 0) {
      to.insert(to.end(), {step_of<Sort>(), step_of<MakeLists>()});
      to.insert(to.end(), b.with_lists.begin(), b.with_lists.end());
    }
    if (b.in_iteration.empty()) continue;
    const ProgramStep round{ProgramStep::iterate, -1, 0, iterations, b.in_iteration};
    to.push_back(round);
    if (repeats > 0) to.push_back({ProgramStep::until, -1, 0, repeats, {round}});
  }
}

void collect_fields(const Steps& steps, std::vector<const FieldInfo*>& to) {
  for (const ProgramStep& s : steps) {
    collect_fields(s.body, to);
    if (s.index < 0) continue;
    const PassInfo& pass = pass_infos()[std::size_t(s.index)];
    const auto add = [&](const Access& a) {
      if (a.field != &field::lists && a.field != &field::motion &&
          std::find(to.begin(), to.end(), a.field) == to.end())
        to.push_back(a.field);
    };
    for (const Access& a : pass.reads) add(a);
    for (const Written& w : pass.writes) add(w.to);
  }
}

/// The sum between the rounds of `until`.
const PassInfo& residual() {
  static const PassInfo info{"mean compression", "residual", {{&field::density}}, {}};
  return info;
}

void count(const Steps& steps, int times, std::vector<PassCount>& to) {
  for (const ProgramStep& s : steps) {
    count(s.body, times * s.times, to);
    if (s.kind == ProgramStep::iterate) continue;
    const PassInfo* pass =
        s.kind == ProgramStep::until ? &residual() : &pass_infos()[std::size_t(s.index)];
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

const std::vector<PassInfo>& pass_infos() {
  static const std::vector<PassInfo> infos = Passes::infos();
  return infos;
}

Program make_program(const Scene& scene, const UpdateShape& shape, bool without_time) {
  Builder b;
  Features::add(scene, b);
  if (without_time) b.at_start.clear(), b.behind.clear(), b.at_end.clear();
  Program p;
  Steps middle;
  if (b.in_iteration.empty() && b.behind.empty()) {  // no pairs: particles only move
    for (int s = 0; s < shape.substeps; ++s) {
      middle.insert(middle.end(), b.at_start.begin(), b.at_start.end());
      middle.push_back(step_of<Predict>());
    }
  } else {
    // The ranges are as equal as can be.
    for (int r = 0, from = 0; r < shape.lists_per_update; ++r) {
      const int to = int(std::int64_t(shape.substeps) * (r + 1) / shape.lists_per_update);
      add_substeps(middle, b, scene.solver.iterations, shape.repeats, to - from);
      from = to;
    }
  }
  const Steps end = b.behind + b.at_end;
  p.update = middle + end;
  // An update begins with the passes up to its first lists, which may follow on the one before.
  const std::size_t order = b.at_start.size() + 1;  // where the sort is
  const bool pairs =
      p.update.size() > order + 1 && p.update[order].index == Passes::index_of<Sort>();
  const auto begin = middle.begin() + (pairs ? std::ptrdiff_t(order + 1) : 0);
  const Steps head(middle.begin(), begin);
  p.first = joined(head);
  p.rest = joined(Steps(begin, middle.end()));
  p.next = joined(end + head);
  p.last = joined(end);
  p.fields = {&field::position, &field::velocity, &field::density,  &field::id,
              &field::bin,      &field::order,    &field::bin_start};
  collect_fields(p.update, p.fields);
  collect_fields(b.with_lists, p.fields);  // a measure makes lists in any case
  p.left_out = b.without;
  return p;
}

std::vector<PassCount> count_passes(const Steps& steps) {
  std::vector<PassCount> out;
  count(steps, 1, out);
  return out;
}
std::vector<PassCount> count_passes(const Program& p) { return count_passes(p.next + p.rest); }

std::string field_names(const std::vector<Access>& fields) {
  std::string out;
  for (const Access& a : fields) {
    out.append(out.empty() ? "" : " ").append(a.field->name).append(a.other ? "'" : "");
  }
  return out;
}

std::string field_names(const std::vector<Written>& fields) {
  std::vector<Access> to;
  for (const Written& w : fields)
    if (to.empty() || to.back().field != w.to.field) to.push_back(w.to);
  return field_names(to);
}

std::string gathers_text(const PassInfo& pass) {
  std::string out;
  for (const auto& [field, name] : kFieldNames)
    if (pass.gathers & field) out.append(out.empty() ? "" : " ").append(name);
  return out;
}

}  // namespace pbf::inline program_module
