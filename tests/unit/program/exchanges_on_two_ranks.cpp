// A model of two ranks, which knows only the declarations of passes, executes programs of all
// combinations of features with their exchanges. Without any one of these it must fail at once.
#include <algorithm>
#include <array>
#include <map>

#include "lib/program/exchanges.h"
#include "tests/support/catch.h"
#include "tests/support/program_steps.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

/// Two ranks. Arrays carry the time at which they were written, sums are numbers.
class TwoRanks {
 public:
  /// Executes a pass. False if a rank gathers ghosts, or reads a sum, that are not current.
  bool launch(const PassInfo& pass, const Exchange& e) {
    bool good = true;
    const std::string name = pass.name;
    for (const FieldInfo* f : pass.flips) std::swap(copies_[f][0], copies_[f][1]);
    for (const FieldInfo* f : e.ghosts) of(*f).ghosts = of(*f).own;
    for (const FieldInfo* f : e.sums) add_up(sums_[f]);
    for (const AccessInfo& a : pass.declared) {
      if ((a.how & kGathers) && (a.when == When::always || marked_))
        good = good && of(*a.field).ghosts == of(*a.field).own;
      // A pass that adds may read the part that its own rank has added.
      const bool own_part =
          std::any_of(pass.declared.begin(), pass.declared.end(),
                      [&](const AccessInfo& b) { return b.field == a.field && b.how == kAdds; });
      if ((a.how & kReading) && !own_part) good = good && is_total(sums_[a.field]);
    }
    if (name.find("sort") != std::string::npos) {  // rows change places and ranks
      for (auto& [field, pair] : copies_)
        for (Copies& c : pair) c.ghosts = -1;
    } else {
      good = good && e.rows.empty();
    }
    for (const AccessInfo& a : pass.declared) {
      const double mine = ++time_, theirs = ++time_;
      Sums& sum = sums_[a.field];
      if ((a.how & kPlaces) && (a.how & kAdds)) {
        sum = {mine, theirs, mine + theirs};
        for (const FieldInfo* f : e.sums_within)
          if (f == a.field) add_up(sum);
        good = good && is_total(sum);
      } else if (a.how & kAdds) {
        // The only pass that all ranks execute alike.
        const bool same = name == "loads of the levels";
        sum.rank[0] += mine;
        if (!e.on_one_rank) sum.rank[1] += same ? mine : theirs;
        sum.total += same ? mine : mine + theirs;
      } else if (a.how & (kWrites | kPlaces)) {
        of(*a.field).own = time_;
        sum = {};
      }
    }
    for (const FieldInfo* f : e.rows) of(*f).ghosts = of(*f).own;
    if (name.find("delta") != std::string::npos) marked_ = false;
    if (name.find("predict") != std::string::npos) marked_ = true;
    return good;
  }

 private:
  struct Copies {
    double own = 0, ghosts = -1;
  };
  struct Sums {
    double rank[2] = {}, total = 0;
  };
  static void add_up(Sums& s) { s.rank[0] = s.rank[1] = s.rank[0] + s.rank[1]; }
  static bool is_total(const Sums& s) { return s.rank[0] == s.total && s.rank[1] == s.total; }
  Copies& of(const FieldInfo& f) { return copies_[&f.primary()][f.first ? 1 : 0]; }

  std::map<const FieldInfo*, std::array<Copies, 2>> copies_;
  std::map<const FieldInfo*, Sums> sums_;
  bool marked_ = true;  ///< the next iteration is the first of its substep
  double time_ = 0;
};

/// Executes steps on two ranks, with their exchanges.
struct RanksRun {
  const Program& program;
  int rounds;  ///< of until
  TwoRanks ranks{};
  RankState state{};
  std::string wrong{};

  void run(const Steps& steps) {
    const std::vector<Exchange> list = exchanges(program, steps, state);
    std::size_t at = 0;
    walk(steps, list, at);
    if (at != list.size()) wrong = "the list is longer than the steps";
  }

 private:
  void walk(const Steps& steps, const std::vector<Exchange>& list, std::size_t& at) {
    for (const ProgramStep& s : steps) {
      if (s.kind == ProgramStep::pass) launch(s.index, list, at);
      for (int k = 0; s.kind == ProgramStep::iterate && k < s.times; ++k) walk(s.body, list, at);
      if (s.kind != ProgramStep::until) continue;
      if (list.at(at).pass) wrong = "until has no sum";
      const std::size_t body = at + 1;
      TwoRanks none = ranks;
      for (int k = 0; k < std::max(rounds, 1); ++k) walk(s.body, list, at = body);
      if (rounds == 0) ranks = none;
    }
  }
  void launch(int index, const std::vector<Exchange>& list, std::size_t& at) {
    const Exchange& e = list.at(at++);
    const PassInfo& pass = program.passes[std::size_t(index)];
    if (e.pass != &pass) wrong = std::string(pass.name) + " is not in the list";
    const auto try_without = [&](Exchange::Fields Exchange::*part) {
      for (std::size_t k = 0; k < (e.*part).size(); ++k) {
        Exchange less = e;
        (less.*part).erase((less.*part).begin() + std::ptrdiff_t(k));
        if (TwoRanks copy = ranks; copy.launch(pass, less))
          wrong = std::string(pass.name) + " needs no " + name_of(*(e.*part)[k]);
      }
    };
    try_without(&Exchange::ghosts);
    try_without(&Exchange::sums);
    try_without(&Exchange::sums_within);
    if (!ranks.launch(pass, e)) wrong = std::string(pass.name) + " reads what is not current";
  }
};

}  // namespace

TEST_CASE("exchanges: in every program two ranks read what is current, and no exchange is idle") {
  const Scene plain = parse(kMinimal), flow = parse(kMinimal + kFlow + kTank),
              solid = parse(kMinimal + kWaveMaker);
  int programs = 0;
  for (const Scene& base : {plain, flow, solid})
    for (int has = 0; has < 32; ++has)
      for (const int iterations : {0, 1, 3})
        for (const UpdateShape& shape : std::vector<UpdateShape>{
                 {1, 1, 0}, {2, 1, 0}, {3, 2, 0}, {1, 1, 2}, {2, 2, 2}, {3, 1, 2}})
          for (const bool without_time : {false, true}) {
            Scene s = base;
            s.solver.iterations = iterations;
            s.solver.fused = has & 1;
            if (has & 2) s.viscosity.emplace();
            if (has & 4) s.vorticity.emplace();
            s.domain.loads = has & 8;
            if (has & 2) s.time.order = TimeOrder::second;  // hyperviscosity, too
            s.solver.levels = has & 16 ? LevelsMode::on : LevelsMode::off;
            const Program p = make_program(s, shape, without_time);
            for (const int rounds : {0, 1, 2}) {
              RanksRun run{p, rounds};
              for (const Steps* steps :
                   {&p.first, &p.rest, &p.next, &p.rest, &p.next, &p.rest, &p.last, &p.between,
                    &p.first, &p.rest, &p.last, &p.lists, &p.update, &p.update, &p.between})
                run.run(*steps);
              ++programs;
              if (run.wrong.empty()) continue;
              CAPTURE(has, iterations, shape.substeps, shape.lists_per_update, shape.repeats,
                      without_time, rounds);
              REQUIRE(run.wrong == "");
            }
          }
  CHECK(programs == 3 * 32 * 3 * 6 * 2 * 3);
}

}  // namespace pbf::scene_test
