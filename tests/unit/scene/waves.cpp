// Wave makers: theory against numbers that were computed in another way, and the keys.
#include "lib/scene/waves.h"

#include <cmath>
#include <numbers>
#include <set>

#include "tests/support/catch.h"
#include "tests/support/flume.h"

namespace pbf::scene_test {
namespace {

constexpr double kG = 9.81, kPi = std::numbers::pi;
const std::string kSea =
    "kind: irregular_waves, direction: [1, 0, 0], height: 0.05, period: 1.5, seed: 7, repeat: 120";
const std::string kSolitary = "kind: solitary_waves, direction: [1, 0, 0], heights: [0.06]";

WaveMaker maker(const Scene& s) { return wave_maker(s, s.obstacles[0]); }

/// k by bisection of omega^2 = g k tanh(k depth).
double bisected(double omega, double depth) {
  double low = 1e-9, high = 1e6;
  for (int n = 0; n < 200; ++n) {
    const double k = 0.5 * (low + high);
    (kG * k * std::tanh(k * depth) < omega * omega ? low : high) = k;
  }
  return low;
}
/// Variance of f over `time`, from so many samples.
template <class F>
double variance(F f, double from, double time, int samples) {
  double sum = 0, squares = 0;
  for (int n = 0; n < samples; ++n) {
    const double x = f(from + time * n / samples);
    sum += x, squares += x * x;
  }
  return squares / samples - sum / samples * (sum / samples);
}

}  // namespace

TEST_CASE("waves: the wave number is the root of the dispersion relation from shallow to deep") {
  for (const double depth : {0.01, 0.3, 5.0, 400.0})
    for (const double period : {0.1, 1.2, 2.0, 60.0})
      CHECK(wave_number(2 * kPi / period, depth, kG) ==
            Approx(bisected(2 * kPi / period, depth)).epsilon(1e-12));
  // Energy runs at d omega/dk.
  const double k = 2.3, depth = 0.3, dk = 1e-5;
  const auto omega = [&](double x) { return std::sqrt(kG * x * std::tanh(x * depth)); };
  CHECK(group_speed(omega(k), k, depth) ==
        Approx((omega(k + dk) - omega(k - dk)) / (2 * dk)).epsilon(1e-8));
}

TEST_CASE("waves: height over stroke of pistons and flaps is that of Biesel's theory") {
  const std::array kd{0.5, 1.0, 2.0, 3.0}, piston{0.499, 0.982, 1.682, 1.933},
      flap{0.255, 0.528, 1.041, 1.350};
  for (std::size_t n = 0; n < kd.size(); ++n) {
    CHECK(piston_ratio(kd[n]) == Approx(piston[n]).margin(5e-4));
    CHECK(flap_ratio(kd[n], 0) == Approx(flap[n]).margin(5e-4));
    CHECK(flap_ratio(kd[n], -1e6) == Approx(piston[n]).margin(5e-4));
    // By quadrature of the paddle's profile against that of the wave.
    for (const double hinge : {-0.5, 0.0, 0.4}) {
      double sum = 0;
      const int cells = 20000;
      for (int c = 0; c < cells; ++c) {
        const double z = (c + 0.5) / cells;
        sum += std::max(0.0, (z - hinge) / (1 - hinge)) * std::cosh(kd[n] * z) / cells;
      }
      const double x = kd[n];
      CHECK(flap_ratio(x, hinge) ==
            Approx(4 * x * std::sinh(x) / (std::sinh(2 * x) + 2 * x) * sum).epsilon(1e-7));
    }
  }
  CHECK(piston_ratio(1000) == Approx(2));
  CHECK(std::isfinite(flap_ratio(1000, 0.5)));
}

TEST_CASE("waves: low ones lose more height, with h = 2 d the least") {
  WaveMaker w;
  w.k = 2 * kPi / 1.77, w.depth = 0.3;
  w.smoothing_ratio = 3;
  const auto loss = [&](int dimensions, double height) {
    w.dimensions = dimensions, w.height = height;
    return w.loss(0.01);
  };
  CHECK(loss(2, 0.04) == Approx(0.134).margin(5e-4));
  CHECK(loss(2, 0.08) == Approx(0.097).margin(5e-4));
  CHECK(loss(3, 0.04) == Approx(0.043).margin(5e-4));
  CHECK(loss(3, 0.08) == loss(3, 0.04));
  w.smoothing_ratio = 2;
  CHECK(loss(2, 0.04) == Approx(0.0896).margin(5e-4));
  CHECK(loss(2, 0.08) == Approx(0.0326).margin(5e-4));
  CHECK(loss(3, 0.08) == Approx(0.0200).margin(5e-4));
}

TEST_CASE("waves: regular ones of second order have the stroke and the bound crest of theory") {
  const WaveMaker w = maker(flume(kRegular));
  CHECK(w.second);
  CHECK(w.depth == Approx(0.3));
  CHECK(w.length() == Approx(3.258).margin(5e-4));
  CHECK(2 * w.lines[0].stroke == Approx(0.104).margin(5e-4));
  CHECK(2 * w.lines[1].stroke == Approx(0.0089).margin(5e-5));
  CHECK(w.lines[1].amplitude / w.lines[0].amplitude == Approx(0.278).margin(5e-4));
  CHECK(w.ursell() == Approx(23.6).margin(0.05));
  CHECK(w.breaks_at() == Approx(0.234));
  CHECK(w.free_share() == Approx(0.19).margin(0.006));
  CHECK_FALSE(maker(flume(kRegular + ", order: 1")).second);
  // The paddle pushes water: what it displaces in half a period is in the crest that leaves it.
  const double t = 20, half = 1;
  const double pushed = (w.paddle(t + half / 2) - w.paddle(t - half / 2)) * w.depth;
  double crest = 0;
  for (int n = 0; n < 1000; ++n) {
    const double s = (n + 0.5) / 1000 * w.length() / 2;
    crest += std::max(0.0, w.height / 2 * std::sin(2 * kPi * s / w.length())) * w.length() / 2000;
  }
  CHECK(pushed == Approx(crest).epsilon(0.01));
}

TEST_CASE("waves: what is expected is 0 before the front arrives, and the wave behind it") {
  const WaveMaker w = maker(flume(kRegular + ", order: 1, start: 1"));
  CHECK(w.ramp == 2);
  CHECK(w.elevation(3, 1 + 3 / w.group) == 0);
  CHECK(w.elevation(3, 2 + 3 / w.group) != 0);
  CHECK(w.elevation(0, 11) == Approx(0.03));
  CHECK(w.elevation(w.length() / 2, 11) == Approx(-0.03));
  CHECK(w.paddle(1) == 0);
  CHECK(w.paddle(1 + 2.5 + 2) == Approx(w.lines[0].stroke));
  CHECK(maker(flume(kRegular + ", order: 1, gain: 1.1")).paddle(6.5) ==
        Approx(1.1 * maker(flume(kRegular + ", order: 1")).paddle(6.5)));
}

TEST_CASE("waves: an irregular sea has its significant height exactly, whatever the band") {
  for (const char* more : {"", ", band: [0.6, 2]", ", spectrum: pierson_moskowitz", ", gamma: 6"}) {
    CAPTURE(more);
    const WaveMaker w = maker(flume(kSea + more));
    const double m0 = variance([&](double t) { return w.elevation(0, t); }, 10 + w.ramp, 120, 4096);
    CHECK(m0 == Approx(0.05 * 0.05 / 16).epsilon(1e-6));
  }
  CHECK(maker(flume(kSea)).lines.size() == 209);
  // The peak: the line of largest amplitude is that of the period.
  const WaveMaker w = maker(flume(kSea));
  const auto peak = std::ranges::max_element(w.lines, {}, &WaveLine::amplitude);
  CHECK(2 * kPi / peak->omega == Approx(1.5));
  // gamma is the height of the peak over that of Pierson and Moskowitz.
  CHECK(wave_spectrum(1, 3.3) == Approx(3.3 * wave_spectrum(1, 1)));
}

TEST_CASE("waves: the phase of a line depends on the seed and its number alone") {
  const WaveMaker w = maker(flume(kSea)), narrow = maker(flume(kSea + ", band: [0.8, 1.2]"));
  for (const char* end : {"8", "20"}) {  // of the run, which decides the distance of the lines
    const WaveMaker other =
        maker(flume(kSea, {"obstacles.0.motion.repeat=auto", std::string("time.end=") + end}));
    for (const WaveLine& l : other.lines)
      CHECK(l.phase == line_numbers(7, std::lround(l.omega / (2 * kPi) * std::stod(end))).phase);
  }
  for (const WaveLine& l : narrow.lines) {
    const auto same = std::ranges::find(w.lines, l.omega, &WaveLine::omega);
    REQUIRE(same != w.lines.end());
    CHECK(same->phase == l.phase);
  }
  CHECK(line_numbers(7, 40).phase != line_numbers(8, 40).phase);
  std::set<double> all;
  double sum = 0;
  for (int n = 0; n < 1000; ++n)
    all.insert(line_numbers(1, n).phase), sum += line_numbers(1, n).phase;
  CHECK(all.size() == 1000);
  CHECK(sum / 1000 == Approx(kPi).margin(0.2));
  // Random amplitudes keep the phases, and their energy is right in the mean.
  double energy = 0;
  for (const char* seed : {"1", "2", "3", "4", "5", "6", "7", "8"})
    for (const WaveLine& l : maker(flume(kSea + ", amplitudes: random",
                                         {std::string("obstacles.0.motion.seed=") + seed}))
                                 .lines)
      energy += l.amplitude * l.amplitude / 2 / 8;
  CHECK(energy != Approx(0.05 * 0.05 / 16).epsilon(1e-6));
  CHECK(energy == Approx(0.05 * 0.05 / 16).epsilon(0.25));
}

TEST_CASE("waves: repeat: auto becomes the length of the run, which a resumed run then keeps") {
  const Scene s =
      flume("kind: irregular_waves, direction: [1, 0, 0], height: 0.05, period: 1.5, start: 0.5");
  CHECK(s.obstacles[0].motion->repeat == 8);
  CHECK(contains(resolved_yaml(s), "repeat: 8"));
}

TEST_CASE("waves: a solitary one has the stroke that was measured, and Goring's duration") {
  const std::vector<std::string> set{"obstacles.0.motion.depth=0.218", "fluid.spacing=0.00990909",
                                     "bodies.0.max=[8, 0.218]",
                                     "obstacles.0.motion.heights=[0.057552]", "time.end=12"};
  const Scene s = flume(kSolitary + ", theory: boussinesq", set);
  const WaveMaker w = maker(s);
  CHECK(w.paddle(100) == Approx(0.257).margin(0.002));  // Briggs et al. 1996
  const double c = std::sqrt(kG * (0.218 + 0.057552)),
               kappa = std::sqrt(0.75 * 0.057552 / 0.218) / 0.218;
  CHECK(w.solitary[0].duration() == Approx(2 / (kappa * c) * (3.8 + 0.264)));
  CHECK(w.paddle(w.solitary[0].duration()) == Approx(w.paddle(100)).epsilon(1e-3));
  // The volume of the wave is what the paddle has pushed.
  double volume = 0;
  for (int n = 0; n < 4000; ++n) volume += w.elevation(0.002 * n, 4) * 0.002;
  CHECK(volume == Approx(2 * 0.057552 / kappa).epsilon(1e-3));
  CHECK(w.paddle(100) * 0.218 == Approx(volume).epsilon(1e-2));
  // The crest has the height, and runs at c.
  CHECK(w.elevation(c * (3 - w.solitary[0].middle), 3) == Approx(0.057552));
  const double rayleigh = maker(flume(kSolitary, set)).paddle(100);
  CHECK(rayleigh == Approx(w.paddle(100) * std::sqrt(1.264)).epsilon(1e-3));
}

TEST_CASE("waves: a second solitary wave begins at its time, where the first one left the paddle") {
  const WaveMaker w =
      maker(flume(kSolitary, {"obstacles.0.motion.heights=[0.06, 0.03]",
                              "obstacles.0.motion.times=[0, 4]", "obstacles.0.min=[-0.6, 0]"}));
  REQUIRE(w.solitary.size() == 2);
  CHECK(w.paddle(4) == Approx(2 * w.solitary[0].half_stroke).epsilon(2e-3));
  CHECK(w.paddle(100) ==
        Approx(2 * (w.solitary[0].half_stroke + w.solitary[1].half_stroke)).epsilon(2e-3));
}

TEST_CASE("waves: focused ones have their crest at the place and the time, and no higher one") {
  const WaveMaker w =
      maker(flume("kind: focused_waves, direction: [1, 0, 0], crest: 0.06, period: 1.5, "
                  "band: [0.5, 1.6], place: 4, time: 12"));
  CHECK(w.elevation(4 - 0.2, 12) == Approx(0.06));
  for (const double off : {-0.3, -0.05, 0.05, 0.3}) {
    CHECK(w.elevation(3.8 + off, 12) < 0.0599);
    CHECK(w.elevation(3.8, 12 + off) < 0.0599);
  }
  const WaveMaker trough =
      maker(flume("kind: focused_waves, direction: [1, 0, 0], crest: 0.06, period: 1.5, "
                  "band: [0.5, 1.6], place: 4, time: 12, phase: 180"));
  CHECK(trough.elevation(3.8, 12) == Approx(-0.06));
}

TEST_CASE("waves: the table is the motion in nanometers, and a longer run only adds rows") {
  const Scene s = flume(kRegular), longer = flume(kRegular, {"time.end=12"});
  const MotionTable &a = s.obstacles[0].motion->table, &b = longer.obstacles[0].motion->table;
  const WaveMaker w = maker(s);
  CHECK(a.columns == 3);
  REQUIRE(a.time.size() > 512);
  CHECK(a.time.front() < 0);
  CHECK(a.time[a.time.size() - 3] >=
        8);  // the slope of the last row in the run is that of a longer one
  for (std::size_t k = 0; k < a.time.size(); ++k) {
    CHECK(a.values[k][0] == Approx(w.paddle(a.time[k])).margin(6e-10));
    CHECK(a.values[k][0] * 1e9 == Approx(std::round(a.values[k][0] * 1e9)).margin(1e-4));
    CHECK(a.time[k] == b.time[k]);
    CHECK(a.values[k] == b.values[k]);
  }
  CHECK(a.time[11] - a.time[10] == Approx(2.0 / 128));
}

TEST_CASE("waves: flaps turn, and directions are those of the keys") {
  const std::string flap =
      "kind: regular_waves, pivot: [0.2, 0, 0.1], height: 0.04, period: 1.2, axis: ";
  const Scene s = flume(flap + "[0, 1, 0]");
  const MotionTable& t = s.obstacles[0].motion->table;
  const WaveMaker w = maker(s);
  CHECK(w.flap);
  CHECK(t.columns == 6);
  const double kd = bisected(2 * kPi / 1.2, 0.3) * 0.3;
  double most = 0;
  for (const auto& row : t.values) most = std::max(most, row[4]);
  CHECK(most == Approx(std::atan(0.02 / flap_ratio(kd, 1.0 / 3) / 0.2) * 180 / kPi).epsilon(2e-3));
  CHECK(w.paddle(6) == Approx(maker(flume(flap + "[0, 1, 0]")).paddle(6)));
  // Towards -x: the same waves from a paddle at the other end.
  const std::vector<std::string> turned{"obstacles.0.min=[7.8, 0]", "obstacles.0.max=[8.3, 0.6]",
                                        "bodies.0.min=[0, 0]", "bodies.0.max=[7.8, 0.3]"};
  const Scene back =
      flume("kind: regular_waves, direction: [-2, 0, 0], height: 0.06, period: 2", turned);
  CHECK(maker(back).ahead == Approx(7.8));
  const Scene forth = flume(kRegular);
  for (std::size_t k = 0; k < 500; ++k)
    CHECK(back.obstacles[0].motion->table.values[k][0] ==
          -forth.obstacles[0].motion->table.values[k][0]);
}

TEST_CASE("waves: along y a flap turns about -x") {
  const Scene s =
      flume("kind: regular_waves, axis: [-1, 0, 0], pivot: [0, 0.2, 0], height: 0.04, period: 1.2",
            {"dimensions=3", "domain.max=[0.2, 8, 0.6]", "bodies.0.min=[0, 0.2, 0]",
             "bodies.0.max=[0.2, 8, 0.3]", "obstacles.0.min=[-0.1, -0.3, 0]",
             "obstacles.0.max=[0.3, 0.2, 0.6]", "gauges=[]", "fluid.smoothing_ratio=3"});
  const WaveMaker w = maker(s);
  CHECK(w.axis == 1);
  CHECK(w.sign == 1);
  for (std::size_t k = 0; k < 300; ++k) {
    const auto& row = s.obstacles[0].motion->table.values[k];
    CHECK(row[3] == Approx(-w.angle(s.obstacles[0].motion->table.time[k])).margin(1e-9));
  }
}

}  // namespace pbf::scene_test
