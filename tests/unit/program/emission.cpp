// What emitters emit as a function of time. The oracle adds up small pieces of the way.
#include "lib/program/emission.h"

#include <cmath>
#include <set>

#include "lib/program/plan.h"
#include "lib/program/schedule.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

const std::string kTwoJets =
    "domain: {min: [0, 0, 0], max: [1, 1, 1], open: [x_max]}\n"
    "fluid: {spacing: 0.05}\n"
    "bodies: [{shape: block, min: [0, 0, 0], max: [0.2, 0.2, 0.2]}]\n"
    "time: {step: 0.004, end: 0.5}\n"
    "emitters:\n"
    "  - {name: a, shape: disc, center: [0.3, 0.5, 0.5], normal: [1, 0, 0], radius: 0.13, speed: "
    "2, "
    "start: 0.1, end: 0.4}\n"
    "  - {name: b, shape: rectangle, center: [0.75, 0.5, 0.8], normal: [0, 0, 1], size: [0.1, "
    "0.2], "
    "speed: 1.5}\n";

Emitter with_table(const std::vector<std::pair<double, double>>& rows) {
  Emitter e;
  e.path = "v.csv";
  for (const auto& [t, v] : rows) {
    e.table.time.push_back(t);
    e.table.values.push_back({v});
  }
  return e;
}

/// m, by the midpoint rule over `n` pieces.
double way_in_pieces(const std::vector<std::pair<double, double>>& rows, double from, double to,
                     double t, int n = 200000) {
  const double end = std::min(t, to);
  double sum = 0;
  for (int k = 0; end > from && k < n; ++k) {
    const double at = from + (end - from) * (k + 0.5) / n;
    for (std::size_t r = 0; r + 1 < rows.size(); ++r)
      if (at >= rows[r].first && at < rows[r + 1].first) {
        const double u = (at - rows[r].first) / (rows[r + 1].first - rows[r].first);
        sum += (rows[r].second + u * (rows[r + 1].second - rows[r].second)) * (end - from) / n;
      }
  }
  return sum;
}

}  // namespace

TEST_CASE("emission: the number of particles is that of the layers whose way is made") {
  const Scene s = parse(kTwoJets);
  const EmissionPlan plan = plan_emission(s, 64);
  REQUIRE(plan.nozzles.size() == 2);
  // By hand: places (i, j) d with a distance of at most 0.13 - 0.025 = 2.1 d; 2 x 4 in the
  // rectangle.
  CHECK(plan.nozzles[0].columns == 13);
  CHECK(plan.nozzles[1].columns == 8);
  CHECK(plan.nozzles[1].area == Approx(0.1 * 0.2));
  CHECK(plan.at_start() == 64 + 2 * (13 + 8));
  for (int k = 0; k <= 125; ++k) {
    const double t = 0.004 * k;
    const double a = 2 * std::clamp(t - 0.1, 0.0, 0.3), b = 1.5 * t;
    // The first layer stands half a spacing behind the opening; ties count as due.
    const auto layers = [](double way) { return std::floor(way / 0.05 + 0.5 + 1e-7); };
    CAPTURE(k);
    CHECK(plan.particles(t) == 64 + 13 * (2 + layers(a)) + 8 * (2 + layers(b)));
  }
}

TEST_CASE("emission: ids are given once, in the order of time, whatever the steps are") {
  const Scene s = parse(kTwoJets);
  const EmissionPlan plan = plan_emission(s, 64);
  for (const int level : {0, 1, 3})
    for (const int substeps : {1, 2, 3, 5})
      for (int lists = 1; lists <= substeps; ++lists) {
        CAPTURE(level, substeps, lists);
        std::set<std::int64_t> all;
        std::int64_t next = plan.at_start();
        const double dt = 0.004 / (substeps << level);
        for (std::int64_t k = 0; k < std::int64_t(125 * substeps) << level; ++k) {
          std::int64_t born = 0;
          for (std::size_t e = 0; e < 2; ++e) {
            const EmitterStep now = emitter_step(plan, e, k, dt, substeps, lists);
            for (int m = now.held - now.born; m < now.held; ++m)
              for (int c = 0; c < plan.nozzles[e].columns; ++c)
                REQUIRE(all.insert(now.id[m] + c).second);
            born += now.born * plan.nozzles[e].columns;
            REQUIRE(now.held - now.released >= plan.layers);
          }
          // Each step continues where the one before has ended.
          REQUIRE((born == 0 || *all.rbegin() == next + born - 1));
          next += born;
        }
        CHECK(next == plan.particles(0.5));
        CHECK(std::int64_t(all.size()) == next - plan.at_start());
      }
}

TEST_CASE("emission: emitters whose layers begin at the same time share no ids") {
  const Scene s =
      parse(kTwoJets, {"emitters.0.start=0", "emitters.0.end=0.5", "emitters.1.speed=2"});
  const EmissionPlan plan = plan_emission(s, 64);
  std::set<std::int64_t> first;
  for (std::int64_t layer = 0; layer < 12; ++layer) {
    CAPTURE(layer);
    if (layer >= plan.layers) REQUIRE(plan.birth(0, layer) == plan.birth(1, layer));
    CHECK(plan.id(0, layer) + plan.nozzles[0].columns <= plan.id(1, layer));
    CHECK(first.insert(plan.id(0, layer)).second);
    CHECK(first.insert(plan.id(1, layer)).second);
  }
}

TEST_CASE("emission: layers make the way of the table, and stand still where its speed is 0") {
  Scene s = parse(kTwoJets);
  const std::vector<std::pair<double, double>> rows{{0, 0},   {0.05, 1}, {0.1, 0},
                                                    {0.2, 0}, {0.3, 3},  {0.5, 0.5}};
  Emitter e = with_table(rows);
  e.start = 0.02;
  e.end = 0.45;
  const SpeedCurve curve(s, e);
  for (const double t : {0.0, 0.02, 0.03, 0.05, 0.1, 0.17, 0.2, 0.21, 0.3, 0.41, 0.45, 0.6}) {
    CAPTURE(t);
    CHECK(curve.way(t) == Approx(way_in_pieces(rows, 0.02, 0.45, t)).epsilon(1e-5).margin(1e-9));
  }
  CHECK(curve.speed(0.25) == Approx(1.5));
  CHECK(curve.speed(0.01) == 0);
  CHECK(curve.speed(0.46) == 0);
  const double most = curve.way(1);
  for (int k = 1; k < 100; ++k) {
    const double way = most * k / 100, t = curve.time_of(way);
    CHECK(curve.way(t) == Approx(way));
    CHECK(curve.way(t * (1 - 1e-6)) <= way);
  }
  CHECK(curve.time_of(curve.way(0.15)) <= 0.1 + 1e-12);  // the first time, not the pause behind it
  CHECK(std::isinf(curve.time_of(most * 1.001)));
}

TEST_CASE("emission: an emitter that never begins, or whose speed is 0, keeps what it holds") {
  for (const char* set : {"emitters.0.speed=0", "emitters.0.start=7"}) {
    const Scene s = parse(kTwoJets, {set, "emitters.0.end=9", "emitters.1.speed=0"});
    const EmissionPlan plan = plan_emission(s, 64);
    CHECK(plan.particles(0) == plan.particles(0.5));
    CHECK(plan.nozzles[0].curve.speed(0.3) == 0);
    CHECK(emitter_step(plan, 0, 17, 0.004, 1, 1).front == Approx(-0.025));
  }
}

TEST_CASE("emission: a layer stands where its way has taken it, also within a step") {
  const Scene s = parse(kTwoJets);
  const EmissionPlan plan = plan_emission(s, 64);
  for (std::int64_t k = 0; k < 125; ++k) {
    const EmitterStep now = emitter_step(plan, 1, k, 0.004, 1, 1);
    const double way = 1.5 * 0.004 * double(k + 1);
    CHECK(now.speed == Approx(1.5));
    // The first held layer has made its way from half a spacing behind the opening.
    const double layers = std::round((way - now.front) / 0.05 - 0.5);
    CHECK(now.front == Approx(way - (layers + 0.5) * 0.05).margin(1e-12));
    CHECK(now.front - now.released * 0.05 < 1e-9);
    CHECK(now.front - 0.05 * (now.released - 1) >= -1e-9);
  }
}

TEST_CASE("emission: an id names its emitter, its layer and the time") {
  const Scene s = parse(kTwoJets);
  const EmissionPlan plan = plan_emission(s, 64);
  for (std::size_t e = 0; e < 2; ++e)
    for (std::int64_t layer = 0; layer < 12; ++layer)
      for (const std::int64_t c : {std::int64_t(0), plan.nozzles[e].columns - 1})
        CHECK(plan.of_id(plan.id(e, layer) + c) == std::pair(e, layer));
  // Layer 12 of b is the 11th that begins: at a way of 10.5 spacings.
  CHECK(no_row_text(s, plan, plan.id(1, 12)) ==
        "at t = 0.35 s emitters[1] (b) had no room for a layer of 8 particles; ");
}

TEST_CASE("emission: the plan knows the largest number of particles, and memory goes by it") {
  const Scene s = parse(kTwoJets);
  const Plan plan = make_plan(s, 64 + 42);
  const std::int64_t most = 64 + 13 * (2 + 12) + 8 * (2 + 15);
  CHECK(plan.particles == 106);
  CHECK(plan.most_particles() == most);
  const Scene fewer = parse(kTwoJets, {"capacity=200"});
  CHECK(make_plan(fewer, 106).most_particles() == 200);
  CHECK(error_of([&] { make_plan(parse(kTwoJets, {"capacity=100"}), 106); }) ==
        "2 capacity: is 100, below the 106 particles at the start; raise it");
  CHECK(contains(plan_text(plan, s),
                 "emitter a: 13 columns, 0.0325 m^2; at 2 m/s 65 kg/s, 520 "
                 "particles/s; 156 particles leave it"));
}

}  // namespace pbf::scene_test
