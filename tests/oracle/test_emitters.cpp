// Flows through nozzles and orifices against what is known of them.
#include <cmath>

#include "lib/exec/make_solver.h"
#include "lib/program/plan.h"
#include "lib/run/emit.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::emitter_flow_test {
namespace {

struct Flow {
  Scene scene;
  Plan plan;
  std::unique_ptr<Solver> solver;
  Flow(const std::string& text, const std::vector<std::string>& set) {
    scene = scene_test::parse(text, set);
    Particles particles = emit_particles(scene, "");
    plan = make_plan(scene, std::int64_t(particles.size()));
    solver = make_solver(scene, plan, std::move(particles));
  }
  /// Particles that the sink has taken.
  double gone() {
    double particles = -1;
    const std::vector<double> all = solver->readings(Series::measures, Interval::goes_on);
    for_each_number(plan.columns, Series::measures,
                    [&](const ReadingColumn& c, int, std::size_t k) {
                      if (std::string(c.kind) == "sink" && std::string(c.name) == "particles")
                        particles = all.at(k);
                    });
    return particles;
  }
};

}  // namespace

TEST_CASE("a nozzle under 40 layers of water brings what it should, without bursts", "[slow]") {
  for (const double speed : {2.0, 0.5}) {
    Flow f(
        "domain: {min: [0, 0, 0], max: [0.36, 0.36, 1.1]}\n"
        "fluid: {spacing: 0.02}\n"
        "bodies: [{shape: block, min: [0, 0, 0], max: [0.36, 0.36, 0.8]}]\n"
        "emitters: [{name: jet, shape: rectangle, center: [0.18, 0.18, 0.1], normal: [0, 0, 1], "
        "size: [0.12, 0.12], speed: 2}]\n"
        "time: {step: 0.002, end: 0.5}\n",
        {"emitters.0.speed=" + std::to_string(speed)});
    CAPTURE(speed);
    const auto start = double(f.plan.particles);
    double lowest = 1e300, first = 0;
    for (int update = 50; update <= 250; update += 10) {
      f.solver->step(update == 50 ? 50 : 10);
      const Diagnostics m = f.solver->diagnose();
      const double t = 0.002 * update;
      REQUIRE(double(m.particles) == start + 36 * std::floor(speed * t / 0.02 + 0.5 + 1e-6));
      REQUIRE(m.speed_max <= 1.5 * speed + 0.1 * std::sqrt(2 * 9.81 * 0.7));
      REQUIRE(m.compression_max < 0.1);
      // What the nozzle brings is booked: what is left can only fall, to the accuracy of the books.
      const double own = m.energy - m.inflow;
      if (first == 0) first = own;
      lowest = std::min(lowest, own);
      REQUIRE(own < lowest + 0.02 * first);
    }
  }
}

TEST_CASE("water runs out of a slot as fast as free-streamline theory says", "[slow]") {
  // A slot in a wide wall: pi/(pi + 2) = 0.611 of sqrt(2 g H).
  Flow f(
      "dimensions: 2\n"
      "domain: {min: [0, 0], max: [1.2, 1.0]}\n"
      "fluid: {spacing: 0.01}\n"
      "bodies: [{shape: block, min: [0, 0], max: [0.6, 0.8]}]\n"
      "obstacles:\n"
      "  - {name: low, shape: box, min: [0.6, 0], max: [0.64, 0.1]}\n"
      "  - {name: high, shape: box, min: [0.6, 0.2], max: [0.64, 1.0]}\n"
      "sinks: [{name: out, min: [0.8, 0], max: [1.2, 1.0]}]\n"
      "time: {step: 0.001, end: 0.9}\n",
      {});
  f.solver->step(300);
  const double before = f.gone();
  const auto left = double(f.solver->state().id.size());
  CHECK(left + before == double(f.plan.particles));
  f.solver->step(300);
  const double rate = (f.gone() - before) * 1e-4 / 0.3;  // m^2/s
  // What is left in the tank, in the middle of the time; some of it is on its way to the sink.
  const double level = 0.5 * (left + double(f.solver->state().id.size())) * 1e-4 / 0.6;
  CHECK(rate / (0.1 * std::sqrt(2 * 9.81 * (level - 0.15))) == Approx(0.61).margin(0.03));
  CHECK(double(f.solver->state().id.size()) + f.gone() == double(f.plan.particles));
}

}  // namespace pbf::emitter_flow_test
