// The plan of gauges: areas of discs on surfaces, rectangles, what is left out.
#include <cmath>

#include "lib/program/levels.h"
#include "lib/program/loads.h"
#include "lib/program/plan.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf {
namespace {

using scene_test::kMinimal;
using scene_test::parse;

constexpr double kSpacing = 0.1;

Plan plan_of(const std::string& more, const std::vector<std::string>& set = {}) {
  return make_plan(parse(kMinimal + more, set), 500);
}
double area(const std::string& on, const std::string& at, double radius,
            const std::string& obstacles = "", const std::vector<std::string>& set = {}) {
  const Plan p =
      plan_of("obstacles: [" + obstacles + "]\ngauges: [{name: p, kind: pressure, on: " + on +
                  ", at: " + at + ", radius: " + std::to_string(radius) + "}]\n",
              set);
  REQUIRE(p.gauges.of<PatchTally>().sites.size() == 1);
  // Pa per N
  return load_grain(parse(kMinimal, set), p) / p.gauges.columns.at(0).grain.value;
}
/// Of a disc whose share falls from 1 at r - d to 0 at r + d.
double disc(double r) { return kPi * (r * r + kSpacing * kSpacing / 3); }

}  // namespace

TEST_CASE("gauges: the area of a disc is what of it lies on the surface, before it fluid") {
  const std::string box = "{name: b, shape: box, min: [0.1, 0.1, 0], max: [0.9, 0.9, 0.3]}";
  CHECK(area("x_min", "[0, 0.5, 0.5]", 0.2) == Approx(disc(0.2)).epsilon(2e-3));
  CHECK(area("z_max", "[0.4, 0.5, 1]", 0.25) == Approx(disc(0.25)).epsilon(2e-3));
  CHECK(area("x_min", "[0, 0, 0.5]", 0.2) == Approx(disc(0.2) / 2).epsilon(5e-3));  // in an edge
  CHECK(area("x_min", "[0, 0, 0]", 0.2) == Approx(disc(0.2) / 4).epsilon(5e-3));
  CHECK(area("x_min", "[0, 0.5, 0.5]", 1) == Approx(1).epsilon(5e-3));  // the whole wall
  CHECK(area("b", "[0.5, 0.5, 0.3]", 0.2, box) == Approx(disc(0.2)).epsilon(2e-3));
  CHECK(area("b", "[0.1, 0.5, 0.3]", 0.2, box) == Approx(disc(0.2) / 2).epsilon(2e-2));
  CHECK(area("b", "[0.5, 0.5, 0.3]", 0.7, box) == Approx(0.64).epsilon(5e-3));
  CHECK(area("z_min", "[0.05, 0.5, 0]", 1.2, box) == Approx(0.36).epsilon(1e-2));  // beside the box
  const std::string ball = "{name: s, shape: sphere, center: [0.5, 0.5, 0.5], radius: 0.4}";
  CHECK(area("s", "[0.5, 0.1, 0.5]", 0.2, ball) == Approx(disc(0.2)).epsilon(2e-3));
  const std::string pile =
      "{name: c, shape: cylinder, from: [0.5, 0.5, 0], to: [0.5, 0.5, 0.6], radius: 0.35}";
  CHECK(area("c", "[0.15, 0.5, 0.3]", 0.2, pile) == Approx(disc(0.2)).epsilon(2e-3));
  CHECK(area("c", "[0.15, 0.5, 0]", 0.2, pile) == Approx(disc(0.2) / 2).epsilon(5e-3));
  CHECK(area("c", "[0.5, 0.5, 0.6]", 0.5, pile) == Approx(kPi * 0.35 * 0.35).epsilon(5e-3));
  // In two dimensions a strip of the thickness.
  const std::vector<std::string> flat = {"dimensions=2", "domain.max=[1, 0.1, 1]"};
  CHECK(area("x_min", "[0, 0, 0.5]", 0.2, "", flat) == Approx(0.4 * 0.1).epsilon(2e-3));
  CHECK(area("x_min", "[0, 0, 0]", 0.2, "", flat) == Approx(0.2 * 0.1).epsilon(5e-3));
}

TEST_CASE("gauges: the edges of a rectangle are level, then up") {
  const auto gate = [](const std::string& normal, const std::vector<std::string>& set = {}) {
    const Plan p =
        plan_of("gauges: [{name: q, kind: flow, center: [0.5, 0.5, 0.5], normal: " + normal +
                    ", size: [" + (set.empty() ? "0.4, " : "") + "0.2]}]\n",
                set);
    REQUIRE(p.gauges.of<FlowTally>().sites.size() == 1);
    return p.gauges.of<FlowTally>().sites[0];
  };
  const FlowGate x = gate("[2, 0, 0]"), z = gate("[0, 0, -1]");
  const Axes axes = plan_of("").axes;
  const auto along = [&](const double(&v)[3], int a) { return v[axes.inside(a)]; };
  CHECK(std::fabs(along(x.edge[0], 1)) == Approx(1));
  CHECK(std::fabs(along(x.edge[1], 2)) == Approx(1));
  CHECK(along(x.normal, 0) == Approx(1));
  CHECK(x.half[0] == Approx(0.2 / 0.2).epsilon(1e-4));  // h is 0.2 m
  CHECK(x.half[1] == Approx(0.1 / 0.2).epsilon(1e-4));
  CHECK(std::fabs(along(z.edge[0], 0)) == Approx(1));
  CHECK(std::fabs(along(z.edge[1], 1)) == Approx(1));
  const FlowGate flat = gate("[0, 0, 1]", {"dimensions=2", "domain.max=[1, 0.1, 1]"});
  CHECK(flat.half[0] == Approx(0.1 / 0.2).epsilon(1e-4));
  CHECK(flat.half[1] > 1e6);
}

TEST_CASE(
    "gauges: pressure on a wall keeps the levels off, and what a scene does without is named") {
  const std::string gauge =
      "gauges: [{name: p, kind: pressure, on: x_min, at: [0, 0.5, 0.5], radius: 0.2}]\n";
  const Scene s = parse(kMinimal + gauge + "solver: {levels: auto}\n");
  REQUIRE(why_no_levels(s));
  CHECK(std::string(why_no_levels(s)) == "the scene has a pressure gauge on a wall");
  const auto left_out = [](const Plan& p, const std::string& what) {
    for (const LeftOut& l : p.left_out)
      if (l.what == what) return l.because;
    return std::string();
  };
  CHECK(left_out(plan_of(""), "gauges") == "no key gauges");
  CHECK(left_out(plan_of(gauge), "gauges").empty());
  CHECK(left_out(plan_of(gauge), "loads on the walls").empty());
  CHECK(plan_of("").gauges.of<ProbeTally>().sums == 0);
}

TEST_CASE("gauges: the columns of each say where it is, in which unit, and how they are read") {
  const auto all =
      plan_of(
          "gauges:\n"
          "  - {name: H, kind: level, at: [0.5, 0.25]}\n"
          "  - {name: U, kind: velocity, at: [0.5, 0.25, 0.1]}\n"
          "  - {name: Q, kind: flow, center: [0.5, 0.5, 0.1], normal: [1, 0, 0], size: [1, 0.2]}\n"
          "  - {name: P, kind: pressure, on: x_max, at: [1, 0.5, 0.1], radius: 0.2}\n",
          {"solver.hyperviscosity=0"})
          .columns;
  REQUIRE(all.size() == 6);
  CHECK(all[0].place == "x = 0.5 m, y = 0.25 m");
  CHECK(all[1].place == "(0.5, 0.25, 0.1) m");
  CHECK(all[2].place == "(0.5, 0.5, 0.1) m, normal (1, 0, 0), 1 x 0.2 m");
  CHECK(all[4].place == "x_max at (1, 0.5, 0.1) m, radius 0.2 m");
  const char* const names[] = {"H  m",    "U x m/s",    "U y m/s", "U z m/s",
                               "Q  kg/s", "Q total kg", "P  Pa",   "P peak Pa"};
  const Join joins[] = {Join::now,  Join::now,   Join::now,  Join::now,
                        Join::mean, Join::total, Join::mean, Join::peak};
  std::size_t numbers = 0;
  for_each_number(all, Series::gauges, [&](const ReadingColumn& c, int component, std::size_t k) {
    REQUIRE(k < std::size(names));
    CHECK(c.of + " " + number_name(c, component) + " " + c.unit == names[k]);
    CHECK(c.join == joins[k]);
    ++numbers;
  });
  CHECK(numbers == std::size(names));
}

TEST_CASE("readings: closed walls and obstacles with loads have columns, others none") {
  const auto columns = [](std::vector<std::string> set) {
    set.push_back("solver.hyperviscosity=0");
    std::vector<std::string> out;
    const auto all =
        plan_of(
            "obstacles: [{name: a, shape: sphere, center: [0.5, 0.5, 0.5], radius: 0.25},\n"
            "  {name: b, shape: plane, point: [0.2, 0, 0], normal: [1, 0, 0], loads: true}]\n",
            set)
            .columns;
    for_each_number(all, Series::measures, [&](const ReadingColumn& c, int component, std::size_t) {
      out.push_back(c.of + " " + number_name(c, component));
    });
    return out;
  };
  const std::vector<std::string> of_b = {"b force_x",   "b force_y",  "b force_z",    "b torque_x",
                                         "b torque_y",  "b torque_z", "b force_peak", "b impulse_x",
                                         "b impulse_y", "b impulse_z"};
  CHECK(columns({}) == of_b);
  CHECK(columns({"domain.loads=true"}).size() == 7 * 10);
  CHECK(columns({"domain.loads=true", "domain.open=[z_max, x_min]"}).size() == 5 * 10);
  CHECK(columns({"domain.loads=true", "obstacles=[]", "dimensions=2", "domain.max=[1, 0.1, 1]"})
            .size() == 4 * 10);
  CHECK(columns({"obstacles=[]"}).empty());
}

TEST_CASE("readings: what takes energy has a column where the scene has it") {
  const auto columns = [](const std::vector<std::string>& set) {
    std::string out;
    const auto all = plan_of("", set).columns;
    for_each_number(all, Series::measures, [&](const ReadingColumn& c, int component, std::size_t) {
      CHECK(c.kind == std::string("dissipation"));
      CHECK(c.join == Join::total);
      out += c.of + "/" + number_name(c, component) + " " + c.unit + "; ";
    });
    return out;
  };
  CHECK(columns({}) == "hyperviscosity/energy J; ");
  CHECK(columns({"time.order=1"}) == "");
  CHECK(columns({"gravity=0", "time.step=0.01"}) == "");
  CHECK(columns({"time.order=1", "viscosity={}", "vorticity={}"}) ==
        "viscosity/energy J; confinement/energy J; ");
  CHECK(columns({"time.order=1", "viscosity.xsph=0", "solver.velocity_damping=0.9"}) ==
        "damping/energy J; ");
}

}  // namespace pbf
