#include <cmath>
#include <limits>

#include "lib/solver/diagnostics.h"
#include "tests/support/catch.h"
#include "tests/support/folder.h"

using namespace pbf;

TEST_CASE("the energy's drift is from the start, its rise from the lowest value before") {
  EnergyTrack track;
  const double energy[] = {10, 8, 8.5, 7, 9, 6}, drift[] = {0, -0.2, -0.15, -0.3, -0.1, -0.4},
               rise[] = {0, 0, 0.05, 0.05, 0.2, 0.2};
  for (int k = 0; k < 6; ++k) {
    Diagnostics m;
    m.energy = energy[k];
    track.follow(m);
    CHECK(m.energy_drift == Approx(drift[k]).margin(1e-15));
    CHECK(m.energy_rise == Approx(rise[k]).margin(1e-15));
  }
}

TEST_CASE(
    "of a start without energy the rise is a share of the most energy since, never infinite") {
  EnergyTrack track;
  Diagnostics m;
  track.follow(m);
  CHECK(m.energy_drift == 0);
  CHECK(m.energy_rise == 0);
  const double energy[] = {1e-300, 2, 1, 1.5}, drift[] = {1, 1, 0.5, 0.75};
  for (int k = 0; k < 4; ++k) {
    m.energy = energy[k];
    track.follow(m);
    CHECK(m.energy_drift == Approx(drift[k]));
    CHECK(m.energy_rise == 1);
  }
}

TEST_CASE("energy lost and made again after a start of next to none counts by its own size") {
  EnergyTrack track;
  Diagnostics m;
  for (const double e : {1e-320, 5.0, 1.0, 2.0}) {
    m.energy = e;
    track.follow(m);
    CHECK(std::isfinite(m.energy_drift));
    CHECK(m.energy_rise <= 1);
  }
}

TEST_CASE("a history with an infinite rise, as old checkpoints hold, goes on finite") {
  EnergyTrack track({true, 0, 0, 0, std::numeric_limits<double>::infinity()});
  Diagnostics m;
  m.energy = 3;
  track.follow(m);
  CHECK(m.energy_rise == 1);
  CHECK(m.energy_drift == 1);
}

TEST_CASE("drift and rise leave out the work of what moves, and help and page say so") {
  struct Measure {
    double energy, work, drift, rise;
  };
  const auto check = [](const std::vector<Measure>& measures) {
    EnergyTrack track;
    for (const Measure& wanted : measures) {
      Diagnostics m;
      m.energy = wanted.energy;
      m.work = wanted.work;
      track.follow(m);
      CAPTURE(m.energy, m.work);
      CHECK(m.energy_drift == Approx(wanted.drift).margin(1e-15));
      CHECK(m.energy_rise == Approx(wanted.rise).margin(1e-15));
    }
  };
  // E - W is 10, 11, 7, 9.
  check({{10, 0, 0, 0}, {13, 2, 0.1, 0.1}, {9, 2, -0.3, 0.1}, {12, 3, -0.1, 0.2}});
  // Without energy at the start the divisor is the largest E, 5 and then 8, not the largest E - W.
  check({{0, 0, 0, 0}, {5, 2, 0.6, 0.6}, {8, 2, 0.75, 0.75}, {4, 2, 0.25, 0.75}});
  const std::string help = diagnostics_help(),
                    page = test::read_file(PBF_SOURCE_DIR "/lib/solver/DIAGNOSTICS.md");
  for (const char* line :
       {"energy_drift             (E - W - E0)/E0; W: work of moving bodies, E0: E at the start "
        "(if none: the largest E)",
        "energy_rise              largest (E - W) - (lowest E - W before), over E0"})
    CHECK(help.find(line) != std::string::npos);
  CHECK(page.find("| `energy_drift` | (E − W − E0)/E0. ") != std::string::npos);
  CHECK(page.find("| `energy_rise` | largest rise of E − W above its lowest earlier value, ") !=
        std::string::npos);
}
