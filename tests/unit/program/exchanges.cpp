// What ranks exchange. The expected lists are written by hand from kernels/README.md ("The step").
#include "lib/program/exchanges.h"

#include <array>

#include "tests/support/catch.h"
#include "tests/support/program_steps.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

std::string fields_text(const Exchange::Fields& fields) {
  std::string out;
  for (const FieldInfo* f : fields) out += (out.empty() ? "" : ", ") + name_of(*f);
  return out;
}
/// "delta[position']": ghosts in [], rows in {}, sums in (), sums within the pass in (within: ).
/// Launches without an exchange do not appear.
std::string exchange_text(const std::vector<Exchange>& all) {
  std::string out;
  for (const Exchange& e : all) {
    std::string one;
    if (!e.ghosts.empty()) one += "[" + fields_text(e.ghosts) + "]";
    if (!e.rows.empty()) one += "{" + fields_text(e.rows) + "}";
    if (!e.sums.empty()) one += "(" + fields_text(e.sums) + ")";
    if (!e.sums_within.empty()) one += "(within: " + fields_text(e.sums_within) + ")";
    if (e.on_one_rank) one += " on one rank";
    if (e.pass && one.empty()) continue;
    out += (out.empty() ? "" : ", ") + (e.pass ? e.pass->name + one : "until");
  }
  return out;
}

const std::string kRowMessage = "{position, velocity, id, bin}",
                  kSorted = "predict+sort" + kRowMessage,
                  kAgain = ", density+lambda[position], delta[position']",
                  kIterations = ", delta[position']" + kAgain + kAgain;  // of three, after lists

}  // namespace

TEST_CASE("exchanges: 8 and one of rows with 4 iterations and xsph, 184 bytes of a ghost row") {
  const auto cost = [](int iterations, Precision precision) {
    const Program p =
        program_of("", {"viscosity.xsph=0.1", "solver.iterations=" + std::to_string(iterations)});
    std::array<int, 3> sum{};  // exchanges, messages of rows, bytes of a ghost row
    for (const Exchange& e : exchanges(p)) {
      sum[0] += !e.ghosts.empty();
      sum[1] += !e.rows.empty();
      sum[2] += row_bytes(e.ghosts, precision) + row_bytes(e.rows, precision);
    }
    return sum;
  };
  CHECK(cost(4, Precision::single) == std::array{8, 1, 184});
  CHECK(cost(4, Precision::dbl) == std::array{8, 1, 360});
  CHECK(cost(1, Precision::single) == std::array{2, 1, 88});
  CHECK(cost(10, Precision::single) == std::array{20, 1, 376});
}

TEST_CASE("exchanges: an update in the middle of a run, feature by feature") {
  struct Row {
    std::string more;
    std::vector<std::string> set;
    std::string wanted;
  };
  const std::string loads = "loads(load sums), ",
                    cells =
                        ", level cells(within: level cell count, level cell sum, level corner "
                        "sum)",
                    levels = ", level multipliers(within: level cell sum, level corner sum)",
                    book = ", loads of the levels on one rank", delta = ", delta[position']",
                    lambda = ", density+lambda[position]";
  const Row row = GENERATE_COPY(
      Row{"", {}, kSorted + kIterations}, Row{"", {"tensile.k=0.01"}, kSorted + kIterations},
      Row{kTank, {}, kSorted + kIterations}, Row{kStanding, {}, kSorted + kIterations},
      Row{"", {"solver.iterations=1"}, kSorted + delta},
      // The density pass has the ghosts that lambda gathers.
      Row{"",
          {"solver.fused=false", "solver.iterations=2"},
          kSorted + delta + ", density[position]" + delta},
      Row{"",
          {"viscosity.xsph=0.1"},
          "xsph+predict+sort[position', velocity]" + kRowMessage + kIterations},
      // Nothing has moved since the sort.
      Row{"", {"solver.iterations=0", "viscosity.xsph=0.1"}, "xsph+predict+sort" + kRowMessage},
      Row{"",
          {"vorticity.epsilon=0.1"},
          "curl[position, velocity], confinement[curl], " + kSorted + kIterations},
      // The curl finds positions as xsph has left them, but its velocities are new.
      Row{"",
          {"viscosity.xsph=0.1", "vorticity.epsilon=0.1"},
          "xsph[position, velocity'], curl[velocity], confinement[curl], " + kSorted + kIterations},
      Row{"", {"domain.loads=true"}, loads + kSorted + kIterations},
      Row{kWaveMaker, {}, loads + kSorted + kIterations},
      // A particle takes along on which side of a gauge it is.
      Row{kFlow, {}, "predict+sort{position, velocity, id, bin}" + kIterations},
      Row{"",
          {"solver.levels=on", "solver.iterations=2"},
          kSorted + cells + levels + delta + lambda + levels + delta},
      // All ranks know all multipliers, so one of them books.
      Row{"",
          {"solver.levels=on", "solver.iterations=2", "domain.loads=true"},
          loads + kSorted + cells + levels + book + delta + lambda + levels + book + delta},
      Row{"", {"solver.iterations=0"}, ""},
      Row{kWaveMaker, {"solver.iterations=0"}, "loads(load sums)"});
  CAPTURE(row.more, row.set);
  CHECK(exchange_text(exchanges(program_of(row.more, row.set))) == row.wanted);
}

TEST_CASE("exchanges: substeps, repeated iterations, passes one by one and a measurement") {
  const auto middle = [](const UpdateShape& shape, std::vector<std::string> set = {}) {
    return exchange_text(exchanges(program_of("", std::move(set), shape)));
  };
  const std::string delta = ", delta[position']";
  const std::string taken = delta + kAgain + ", density+lambda[position], delta+predict[position']",
                    all = kAgain + kAgain + kAgain;
  // The first iteration of a substep looks at velocities of neighbors.
  CHECK(middle({2, 1, 0}) ==
        kSorted + taken + ", density+lambda[position, velocity]" + kIterations);
  CHECK(middle({2, 2, 0}) == kSorted + taken + ", sort" + kRowMessage + kIterations);
  // Rounds for a tolerance have no first iteration.
  CHECK(middle({1, 1, 4}) == kSorted + kIterations + ", until" + all);
  CHECK(middle({2, 1, 4}) == kSorted + kIterations + ", until" + all +
                                 ", density+lambda[position, velocity]" + kIterations + ", until" +
                                 all);

  // Packed rows: lambda needs 8 bytes of a ghost, xsph one row instead of two.
  const std::string packed_lambda = "density+lambda[packed position]",
                    packed = ", " + packed_lambda + delta;
  CHECK(middle({1, 1, 0, true}, {"viscosity.xsph=0.1"}) ==
        "xsph+predict+sort[position]" + kRowMessage + packed + packed + packed);
  const std::string last = ", " + packed_lambda + ", delta+pack motion[position']";
  CHECK(middle({1, 1, 0, true}, {"viscosity.xsph=0.1", "time.order=2", "solver.iterations=2"}) ==
        "xsph+predict+sort[free velocity]{position, velocity, id, free velocity, bin}" + packed +
            last);

  const Program p = program_of("", {"viscosity.xsph=0.1"});
  RankState state;
  for (int updates = 0; updates < 2; ++updates)
    CHECK(exchange_text(exchanges(p, p.update, state)) ==
          "sort" + kRowMessage + kIterations + ", xsph[position, velocity']");
  CHECK(exchange_text(exchanges(p, p.lists, state)) == "sort" + kRowMessage);
  CHECK(exchange_text(exchanges(p, p.first, state)) == kSorted);
  CHECK(exchange_text(exchanges(p, p.rest, state)) == kIterations.substr(2));
  CHECK(exchange_text(exchanges(p, p.last, state)) == "xsph[position, velocity']");
}

namespace {

const FieldInfo* field_of(const Program& p, const std::string& name) {
  for (const FieldInfo* f : p.fields)
    if (f->name == name) return f;
  return nullptr;
}

}  // namespace

TEST_CASE("exchanges: ghosts are stale after any pass that writes, sums after one that adds") {
  const Program p = program_of("", {"domain.loads=true"});
  const FieldInfo *sums = field_of(p, "load sums"), *place = field_of(p, "position");
  RankState state;
  const auto before = [&](const FieldInfo* f, unsigned how) {
    const PassInfo pass = described({"sample", ""}, {{&field::density, kReads}, {f, how}}, {});
    const Exchange e = state.before(pass, true, p);
    return e.ghosts.size() + e.sums.size();
  };
  for (const unsigned how : {unsigned(kWrites), unsigned(kUpdates), unsigned(kPlaces)}) {
    before(place, how);
    CHECK(before(place, kReads) == 0);
    CHECK(before(place, kGathers) == 1);
    CHECK(before(place, kGathers) == 0);
  }
  CHECK(before(&other<field::position>, kGathers) == 1);  // an array of its own
  // After a sort the ghosts are other particles: only what went along with them is known.
  CHECK(before(&field::density, kGathers) == 1);
  before(field_of(p, "id"), kPlaces);
  CHECK(before(place, kGathers) == 0);
  CHECK(before(&other<field::position>, kGathers) == 1);
  CHECK(before(&field::density, kGathers) == 1);
  for (const unsigned how : {unsigned(kLooks), unsigned(kReads), unsigned(kUpdates)}) {
    CHECK(before(sums, kAdds) == 0);
    CHECK(before(sums, kAdds) == 0);
    CHECK(before(sums, how) == 1);
    CHECK(before(sums, how) == 0);  // all ranks have the total
    before(sums, kWrites);
  }
  before(sums, kAdds);
  before(sums, kWrites);  // nobody wants to know
  CHECK(before(sums, kLooks) == 0);
  // A total to which all ranks added again would count several times.
  before(sums, kAdds);
  before(sums, kLooks);
  CHECK(error_of([&] { before(sums, kAdds); }) ==
        "1 pass 'sample' adds to load sums, which was read and not set anew");
}

}  // namespace pbf::scene_test
