// Gauges against what the particles themselves say, on every backend and precision.
#include <cmath>
#include <cstring>

#include "lib/program/loads.h"
#include "tests/support/catch.h"
#include "tests/support/obstacles.h"

using namespace oracle_test;
using namespace obstacle_test;
using backend_test::here;
using backend_test::is_double;
using backend_test::loads_of;
using backend_test::Series;
using backend_test::WallLoad;
namespace gauge_keys = pbf::gauge_keys;

namespace {

void add(pbf::Scene& s, gauge_keys::Any kind) {
  s.gauges.push_back({"g" + std::to_string(s.gauges.size() + 1), std::move(kind)});
}
std::vector<double> list(const pbf::Double3& x) { return {x[0], x[1], x[2]}; }
void add_pressure(pbf::Scene& s, const std::string& on, const pbf::Double3& at, double radius) {
  add(s, gauge_keys::Pressure{list(at), on, radius});
}
void add_flow(pbf::Scene& s, const pbf::Double3& center, const pbf::Double3& normal,
              std::vector<double> size) {
  add(s, gauge_keys::Flow{center, normal, std::move(size)});
}
double plane_of(const pbf::Gauge& flow) { return std::get<gauge_keys::Flow>(flow.kind).center[0]; }

/// A lattice that fills the floor of a box `depth` high, gravity along -`up`.
Case tank(const pbf::Double3& size, double depth, std::size_t up = 2, bool flat = false) {
  const double d = 0.02;
  Case c;
  c.scene.dimensions = flat ? 2 : 3;
  c.scene.fluid.spacing = d;
  c.scene.domain.min = {-3, 5, 0.5};
  pbf::Double3 count;
  for (std::size_t k = 0; k < 3; ++k) {
    c.scene.domain.max[k] = c.scene.domain.min[k] + size[k];
    count[k] = std::floor((k == up ? depth : size[k]) / d + 0.01);
  }
  for (double z = 0; z < count[2]; ++z)
    for (double y = 0; y < count[1]; ++y)
      for (double x = 0; x < count[0]; ++x) {
        pbf::Double3 at{(x + 0.5) * d, (y + 0.5) * d, (z + 0.5) * d};
        for (std::size_t k = 0; k < 3; ++k) at[k] += c.scene.domain.min[k];
        if (flat) at[1] = *c.scene.plane();
        c.particles.position.push_back(at);
        c.particles.velocity.push_back({});
      }
  c.scene.gravity = {};
  c.scene.gravity[up] = -9.81;
  c.scene.time.step = 0.002;
  return here(c);
}

/// A block that falls beside a box and splashes through two rectangles.
Case splash_among_gauges(bool flat) {
  Case c = flat ? flat_block(14, 30, 0.1, 0.3, 1, 1) : jittered_block(9, 6, 12, 0.1, 0.3, 1, 1);
  pbf::Scene& s = c.scene;
  s.domain.max[0] = s.domain.min[0] + (flat ? 0.6 : 0.4);
  if (!flat) s.domain.max[1] = s.domain.min[1] + 0.15;
  s.domain.max[2] = s.domain.min[2] + 0.7;
  s.gravity = {2, 0, -9.81};
  s.time.step = 0.004;
  Placing put(s);
  put.box({flat ? 11.0 : 6.5, 0, 0}, {flat ? 13.0 : 8.5, 4, 2}).loads = false;
  c = without_inner(here(c), 0.2);
  const auto at = [&](double x, double y, double z) {
    const pbf::Double3& o = s.domain.min;
    return pbf::Double3{o[0] + x, o[1] + y, o[2] + z};
  };
  const double x = flat ? 0.35 : 0.22, top = c.scene.h() * 2;
  pbf::Scene& t = c.scene;
  using List = std::vector<double>;
  if (flat)
    add(t, gauge_keys::Level{{at(x, 0, 0)[0]}});
  else
    add(t, gauge_keys::Level{{at(x, 0, 0)[0], at(0, 0.07, 0)[1]}});
  const pbf::Double3 place = at(0.1, 0.07, 0.1), wall = at(0.1, 0.07, 0);
  add(t, gauge_keys::Velocity{list(place)});
  add_flow(t, at(x, 0.075, 0.35), {1, 0, 0}, flat ? List{0.7} : List{0.15, 0.7});
  add_flow(t, at(0.1, 0.075, 0.1), {0, 0, -1}, flat ? List{0.2} : List{0.2, 0.1});
  add_pressure(t, "z_min", wall, 0.05);
  const pbf::obstacle_keys::Box& box = pbf_test::box_of(t.obstacles[0]);
  add_pressure(t, t.obstacles[0].name,
               {box.min[0], 0.5 * (box.min[1] + box.max[1]), t.domain.min[2] + top / 2}, 0.05);
  return c;
}

std::vector<double> readings(pbf::Solver& s) {
  return s.readings(Series::gauges, pbf::Interval::goes_on);
}
/// Bit for bit, of what is no number too.
bool same(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), 8 * a.size()) == 0;
}

}  // namespace

TEST_CASE("the level of a resting lattice is right to a tenth of a spacing, wherever it is read") {
  const bool flat = GENERATE(false, true);
  const std::size_t up = flat ? 2 : std::size_t(GENERATE(0, 1, 2));
  pbf::Double3 size{0.3, flat ? 0.02 : 0.22, 0.26};
  size[up] = 0.41;
  Case c = tank(size, 0.24, up, flat);
  std::size_t across[2];
  for (std::size_t k = 0, n = 0; k < 3; ++k)
    if (k != up) across[n++] = k;
  const auto at = [&](std::size_t k, double share) {
    return c.scene.domain.min[k] + share * size[k];
  };
  for (const double a : {0.0, 0.31, 0.5, 0.873, 1.0})
    for (const double b : {0.0, 0.43, 1.0}) {
      std::vector<double> place{at(across[0], a)};
      if (!flat) place.push_back(at(across[1], b));
      add(c.scene, gauge_keys::Level{place});
    }
  SECTION("a tank") {}
  SECTION("a tank without a floor") { c.scene.domain.open = {std::string(1, "xyz"[up]) + "_min"}; }
  const bool open = !c.scene.domain.open.empty();
  for (const double level : readings(*make(c))) {
    const double off = std::fabs(level - 0.24);
    CHECK(off < (open ? 0.2 : 0.1) * c.scene.fluid.spacing);  // two surfaces
  }
}

TEST_CASE("a level counts what is wet of the line: over a box, under a plate, nothing where dry") {
  Case c = tank({0.4, 0.2, 0.4}, 0.24);
  Placing put(c.scene);
  put.box({2, 0, 0}, {8, 5, 2});                     // 0.08 high
  put.box({2, 0, 4}, {3.9, 5, 4.5}).name = "plate";  // from 0.16 to 0.18
  c = without_inner(here(c), 0.2);
  const double x = c.scene.domain.min[0], y = c.scene.domain.min[1], d = c.scene.fluid.spacing;
  add(c.scene, gauge_keys::Level{{x + 0.04, y + 0.1}});
  add(c.scene, gauge_keys::Level{{x + 0.25, y + 0.1}});
  add(c.scene, gauge_keys::Level{{x + 0.12, y + 0.1}});
  const std::vector<double> level = readings(*make(c));
  CHECK(level[0] == Approx(0.24).margin(0.1 * d));
  CHECK(level[1] == Approx(0.24 - 0.08).margin(0.1 * d));
  CHECK(level[2] == Approx(0.24 - 0.08 - 0.02).margin(0.1 * d));
  Case dry = tank({0.4, 0.2, 0.4}, 0.24);
  for (std::size_t k = 0; k < dry.particles.size(); ++k)
    dry.particles.position[k][0] = x + std::fmod(double(k) * 0.02, 0.1) + 0.01;
  for (const double a : {0.2, 0.39, 0.4})
    for (const double b : {0.0, 0.1, 0.2}) add(dry.scene, gauge_keys::Level{{x + a, y + b}});
  for (const double l : readings(*make(dry))) CHECK(l == 0);
}

TEST_CASE("an inclined line is wet up to where it leaves the water") {
  const bool flat = GENERATE(false, true);
  const std::size_t up = flat ? 2 : std::size_t(GENERATE(0, 2));
  pbf::Double3 size{0.3, flat ? 0.02 : 0.22, 0.26};
  size[up] = 0.41;
  Case c = tank(size, 0.24, up, flat);
  const std::size_t along = up == 0 ? 2 : 0;
  const pbf::Double3& low = c.scene.domain.min;
  for (const double slope : {0.3, 1.0, 3.0}) {
    pbf::Double3 from = low, to = low;
    if (!flat) from[1] = low[1] + 0.07, to[1] = low[1] + (up == 1 ? 0.07 : 0.15);
    // Through the surface in the middle of the tank.
    const double run = std::min(0.1, 0.15 / slope);
    from[along] += 0.13 - run, to[along] += 0.13 + run;
    from[up] += 0.24 - slope * run, to[up] += 0.24 + slope * run;
    add(c.scene, gauge_keys::Line{from, to});
    add(c.scene, gauge_keys::Line{to, from});
    const double length =
        std::sqrt(4 * run * run * (1 + slope * slope) + (to[1] - from[1]) * (to[1] - from[1]));
    const std::vector<double> wet = readings(*make(c));
    const std::size_t n = wet.size();
    CAPTURE(flat, up, slope);
    // The surface is a tenth of a spacing off at most, and the line crosses it at an angle.
    const double allowed = 0.1 * c.scene.fluid.spacing * length / (2 * slope * run);
    CHECK(wet[n - 2] == Approx(length / 2).margin(allowed));
    CHECK(wet[n - 1] == Approx(wet[n - 2]).margin(1e-9));
  }
}

TEST_CASE("connected lines end at the first gap, from the end that gravity points to") {
  const bool turned = GENERATE(false, true);
  Case c = tank({0.3, 0.2, 0.4}, 0.3);
  const pbf::Double3 low = c.scene.domain.min;
  const double d = c.scene.fluid.spacing;
  const auto keep = [&](auto&& wanted) {
    pbf::Particles kept;
    for (std::size_t k = 0; k < c.particles.size(); ++k)
      if (wanted(c.particles.position[k][2] - low[2])) {
        kept.position.push_back(c.particles.position[k]);
        kept.velocity.push_back({});
      }
    c.particles = kept;
  };
  keep([](double z) { return z < 0.12 || (z > 0.2 && z < 0.26); });  // 0.12 and 0.06 m of water
  if (turned) c.scene.gravity[2] = 9.81;
  const double x = low[0] + 0.15, y = low[1] + 0.1, top = c.scene.domain.max[2];
  add(c.scene, gauge_keys::Level{{x, y}});
  add(c.scene, gauge_keys::Level{{x, y}, true});
  add(c.scene, gauge_keys::Line{{x, y, low[2]}, {x, y, top}, true});
  add(c.scene, gauge_keys::Line{{x, y, low[2] + 0.26}, {x, y, low[2]}, true});
  add(c.scene, gauge_keys::Line{{x, y, low[2] + 0.16}, {x, y, top}, true});  // begins in the gap
  const std::vector<double> r = readings(*make(c));
  CHECK(r[0] == Approx(0.18).margin(0.3 * d));
  CHECK(r[1] == Approx(turned ? 0 : 0.12).margin(turned ? 0 : 0.1 * d));
  CHECK(r[2] == Approx(0.12).margin(0.1 * d));
  CHECK(r[3] == Approx(0.06).margin(0.2 * d));
  CHECK(r[4] == 0);
}

TEST_CASE("a velocity gauge is the mean of the particles within a radius, nan where none is") {
  const bool flat = GENERATE(false, true);
  const double share = GENERATE(1.0, 0.7, 1.4);  // of h
  Case c = here(flat ? flat_block(12, 12, 0.2, 2) : jittered_block(8, 8, 8, 0.2, 2));
  const pbf::Double3 low = c.scene.domain.min;
  const double h = share * c.scene.h();
  std::vector<pbf::Double3> places;
  for (const double a : {0.02, 0.07, 0.11})
    places.push_back({low[0] + a, flat ? *c.scene.plane() : low[1] + 0.08, low[2] + 0.09});
  places.push_back({low[0] + 0.02, low[1], c.scene.domain.max[2]});  // dry
  for (const pbf::Double3& p : places) {
    gauge_keys::Velocity gauge{list(p)};
    if (share != 1) gauge.within = h;
    add(c.scene, gauge);
  }
  auto solver = make(c);
  solver->step(3);
  const auto snap = solver->download({"velocity"}, pbf::ScalarType::f64).get();
  const auto x = snap.fields[0].as<double>(), v = snap.find("velocity")->as<double>();
  const std::vector<double> got = readings(*solver);
  REQUIRE(got.size() == 3 * places.size());
  for (std::size_t g = 0; g < places.size(); ++g) {
    double sum = 0, mean[3] = {0, 0, 0};
    for (std::size_t i = 0; i < snap.count; ++i) {
      double q2 = 0;
      for (std::size_t k = 0; k < 3; ++k)
        if (!(flat && k == 1)) q2 += std::pow((x[3 * i + k] - places[g][k]) / h, 2);
      if (q2 >= 1) continue;
      const double w = std::pow(1 - q2, 3);
      sum += w;
      for (std::size_t k = 0; k < 3; ++k) mean[k] += w * v[3 * i + k];
    }
    for (std::size_t k = 0; k < 3; ++k) {
      CAPTURE(g, k);
      if (g + 1 == places.size()) {
        REQUIRE(sum == 0);
        CHECK(std::isnan(got[3 * g + k]));
      } else {
        CHECK(got[3 * g + k] == Approx(mean[k] / sum).margin(is_double() ? 1e-6 : 1e-5));
      }
    }
  }
}

TEST_CASE("flow through a rectangle across the channel balances the particles on both sides") {
  Case c = splash_among_gauges(GENERATE(false, true));
  SECTION("an update is a step") {}
  SECTION("substeps") { c.scene.solver.substeps = 2; }
  const int level = GENERATE(0, 1);
  const double plane = plane_of(c.scene.gauges[2]);
  auto solver = make(c);
  const auto beyond = [&] {
    const pbf::Snapshot snap = places_of(*solver);
    std::int64_t n = 0;
    for (std::size_t i = 0; i < snap.count; ++i) n += snap.fields[0].as<double>()[3 * i] >= plane;
    return n;
  };
  const double mass = pbf::make_plan(c.scene, std::int64_t(c.particles.size())).mass;
  const std::int64_t first = beyond();
  std::int64_t before = first, most = 0;
  for (int k = 0; k < 12; ++k) {
    solver->step(10, {.level = level});
    const std::int64_t now = beyond();
    const std::vector<double> r = solver->readings(Series::gauges, pbf::Interval::ends);
    CHECK(r[5] == Approx(mass * double(now - first)).epsilon(1e-12).margin(1e-9 * mass));
    CHECK(r[4] == Approx(mass * double(now - before) / (10 * c.scene.time.step))
                      .epsilon(1e-6)
                      .margin(1e-6 * mass));
    most = std::max(most, std::abs(now - before));
    before = now;
  }
  CHECK(most > 20);
}

TEST_CASE("flow counts what goes through the rectangle alone, with the sign of its normal") {
  Case c;
  c.scene.domain = {{0, 0, 0}, {1, 1, 1}, {}, false};
  c.scene.fluid.spacing = 0.05;
  c.scene.gravity = {};
  c.scene.solver.iterations = 0;
  c.scene.time.step = 0.01;
  for (const double y : {0.1, 0.3, 0.5, 0.7, 0.9})
    for (const double z : {0.1, 0.5, 0.9}) {
      c.particles.position.push_back({0.495, y, z});
      c.particles.velocity.push_back({y < 0.6 ? 1.0 : 0.0, 0, 0});
    }
  add_flow(c.scene, {0.5, 0.4, 0.5}, {1, 0, 0}, {0.5, 0.6});  // y 0.3, 0.5; z 0.5
  add_flow(c.scene, {0.5, 0.4, 0.5}, {-1, 0, 0}, {0.5, 1});   // and all z
  add_flow(c.scene, {0.5, 0.5, 0.5}, {1, 0, 0}, {1, 1});
  c = here(c);
  auto solver = make(c);
  const double mass = pbf::make_plan(c.scene, std::int64_t(c.particles.size())).mass;
  solver->step(1);
  const std::vector<double> r = solver->readings(Series::gauges, pbf::Interval::ends);
  CHECK(r[1] == Approx(2 * mass));
  CHECK(r[3] == Approx(-6 * mass));
  CHECK(r[5] == Approx(9 * mass));
  CHECK(r[4] == Approx(9 * mass / 0.01));
  solver->step(1);
  const std::vector<double> later = readings(*solver);
  CHECK(later[4] == 0);
  CHECK(later[5] == Approx(9 * mass));
}

TEST_CASE("pressure gauges of a tank at rest read what hydrostatics says, also in edges",
          "[slow]") {
  const bool flat = GENERATE(false, true);
  const std::size_t up = flat ? 2 : std::size_t(GENERATE(0, 2));
  // No multiple of d: the crystal of a lattice at rest pushes sideways by 2 % more than it weighs.
  const double depth = 0.4, d = 0.02, width = 0.31;
  pbf::Double3 size{width, flat ? d : width, width};
  size[up] = 0.5;
  Case c = tank(size, depth, up, flat);
  c.scene.viscosity = pbf::Viscosity{0.05};
  c.scene.time.order = pbf::TimeOrder::first;  // peaks are lower, for waves are damped more
  const std::size_t side = up == 0 ? 2 : 0, other = 3 - up - side;
  const std::string wall = std::string(1, "xyz"[side]) + "_max";
  const auto place = [&](double height, double along) {
    pbf::Double3 at = c.scene.domain.min;
    at[side] += size[side];
    at[up] += height;
    at[other] += along;
    return at;
  };
  const std::vector<double> heights{0.1, 0.2, 0.3};
  for (const double z : heights) add_pressure(c.scene, wall, place(z, width / 2), 0.05);
  if (!flat) {
    add_pressure(c.scene, wall, place(0.2, 0.01), 0.06);  // reaches into an edge
    add_pressure(c.scene, wall, place(0.2, 0), 0.06);
  }
  pbf::Double3 floor = c.scene.domain.min;
  floor[side] += width / 2;
  if (!flat) floor[other] += width / 2;
  add_pressure(c.scene, std::string(1, "xyz"[up]) + "_min", floor, 0.06);
  auto solver = make(c);
  solver->step(400);
  solver->readings(Series::gauges, pbf::Interval::ends);
  solver->step(800);
  const std::vector<double> r = readings(*solver);
  const pbf::Diagnostics m = solver->diagnose();
  // The surface has sunk a little with the compression.
  const double level = 2 * (m.center_of_mass[up] - c.scene.domain.min[up]);
  CHECK(level == Approx(depth * std::pow(0.3 / 0.31, flat ? 1 : 2)).epsilon(0.01));
  for (std::size_t g = 0; 2 * g < r.size(); ++g) {
    const double z = g < 3 ? heights[g] : 2 * g + 2 == r.size() ? 0 : 0.2;
    CAPTURE(g, z, r[2 * g], 9810 * (level - z));
    CHECK(r[2 * g] == Approx(9810 * (level - z)).epsilon(0.02));
    CHECK(r[2 * g + 1] >= r[2 * g]);
    CHECK(r[2 * g + 1] < 1.25 * r[2 * g]);
  }
}

TEST_CASE("a disc larger than its surface reads the surface's whole load over its area") {
  Case c = splash_among_gauges(false);
  pbf::Scene& s = c.scene;
  s.gauges.clear();
  s.domain.loads = true;
  for (const char* wall : {"x_min", "z_min", "y_max"}) {
    pbf::Double3 at;
    for (std::size_t k = 0; k < 3; ++k)
      at[k] = s.domain.min[k] + 0.4 * (s.domain.max[k] - s.domain.min[k]);
    const auto axis = std::size_t(wall[0] - 'x');
    at[axis] = (wall[2] == 'm' && wall[3] == 'i' ? s.domain.min : s.domain.max)[axis];
    if (axis == 2) at[0] = s.domain.min[0] + 0.05;
    add_pressure(s, wall, at, 5);
  }
  auto solver = make(c);
  solver->step(60);
  const std::vector<double> r = readings(*solver);
  const auto plan = pbf::make_plan(s, std::int64_t(c.particles.size()));
  const auto loads = loads_of(c, *solver);
  for (std::size_t g = 0; g < s.gauges.size(); ++g)
    for (const WallLoad& l : loads) {
      if (l.wall != std::get<gauge_keys::Pressure>(s.gauges[g].kind).on) continue;
      const double area = pbf::load_grain(s, plan) / plan.gauges.columns[2 * g].grain.value;
      const std::size_t axis = std::size_t(l.wall[0] - 'x');
      const double into = l.wall.substr(2) == "min" ? -l.force[axis] : l.force[axis];
      CHECK(into > 0);
      CHECK(r[2 * g] * area == Approx(into).epsilon(1e-6));
      CHECK(r[2 * g + 1] * area == Approx(l.peak).epsilon(1e-6));
    }
}

TEST_CASE("gauges do not depend on threads, pass-by-pass updates, or being handed over", "[slow]") {
  Case c = splash_among_gauges(GENERATE(false, true));
  auto a = make(c);
  a->step(20);
  a->readings(Series::gauges, pbf::Interval::ends);
  a->step(40);
  const std::vector<double> expected = readings(*a);
  REQUIRE(expected[5] > 0);
  REQUIRE(expected[9] > 0);
  SECTION("threads") {
    c.scene.threads = 1;
    auto b = make(c);
    b->step(20);
    b->readings(Series::gauges, pbf::Interval::ends);
    b->step(40);
    CHECK(same(readings(*b), expected));
  }
  SECTION("pass by pass, and read and measured on the way") {
    auto b = make(c);
    b->step(20);
    b->readings(Series::gauges, pbf::Interval::ends);
    for (int k = 0; k < 20; ++k) b->inspection()->trace();
    readings(*b);
    b->diagnose();
    for (int k = 0; k < 20; ++k) b->inspection()->step_checked({1e9, 1e9, 1 << 30});
    CHECK(same(readings(*b), expected));
  }
  SECTION("handed over in the middle") {
    auto first = make(c), second = make(c);
    first->step(20);
    first->readings(Series::gauges, pbf::Interval::ends);
    first->step(17);
    second->set_state(first->state());
    second->step(23);
    CHECK(same(readings(*second), expected));
  }
  SECTION("back to a kept state, and steps without time") {
    auto b = make(c);
    b->step(20);
    b->readings(Series::gauges, pbf::Interval::ends);
    b->keep();
    b->step(17);
    b->set_state(b->state(pbf::StateOf::kept));
    const std::vector<double> there = readings(*b);
    const pbf::SolverState state = b->state();
    b->step(5, {.without_time = 1.0});
    std::vector<double> back = readings(*b);
    for (std::size_t k = 4; k < back.size(); ++k) CHECK(back[k] == there[k]);  // flow, pressure
    b->set_state(state);
    b->step(40);
    CHECK(same(readings(*b), expected));
  }
}

TEST_CASE("steps without time move particles through a rectangle without a count") {
  Case c = jittered_block(8, 6, 8, 0.3, 0, 1, 0.7);  // over-dense
  c.scene.domain.max[0] += 0.2;
  add_flow(c.scene, {c.scene.domain.min[0] + 0.112, 0.36, -1.9}, {1, 0, 0}, {1, 1});
  c.scene.gravity = {};
  c = here(c);
  const double plane = plane_of(c.scene.gauges[0]);
  auto solver = make(c);
  const auto beyond = [&] {
    const pbf::Snapshot snap = places_of(*solver);
    int n = 0;
    for (std::size_t i = 0; i < snap.count; ++i) n += snap.fields[0].as<double>()[3 * i] >= plane;
    return n;
  };
  solver->step(1);
  const double before = readings(*solver)[1];
  const int there = beyond();
  solver->step(40, {.without_time = 0.0});
  const int now = beyond();
  REQUIRE(now > there + 5);
  CHECK(readings(*solver)[1] == before);
  solver->step(1);
  const double mass = pbf::make_plan(c.scene, std::int64_t(c.particles.size())).mass;
  CHECK(readings(*solver)[1] == Approx(before + mass * (beyond() - now)).margin(1e-9 * mass));
}

TEST_CASE("gauges leave the particles' bits alone") {
  Case c = splash_among_gauges(false);
  auto with = make(c);
  for (int k = 0; k < 4; ++k) with->step(10), with->readings(Series::gauges, pbf::Interval::ends);
  const pbf::SolverState there = with->state();
  c.scene.gauges.clear();
  auto without = make(c);
  without->step(40);
  CHECK(backend_test::same_particles(there, without->state()));
}
