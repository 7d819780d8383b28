#include <cmath>

#include "lib/diag/measures.h"
#include "tests/catch.h"

using namespace pbf;

TEST_CASE("the energy's drift is from the start, its rise from the lowest value before") {
  EnergyTrack track;
  const double energy[] = {10, 8, 8.5, 7, 9, 6}, drift[] = {0, -0.2, -0.15, -0.3, -0.1, -0.4},
               rise[] = {0, 0, 0.05, 0.05, 0.2, 0.2};
  for (int k = 0; k < 6; ++k) {
    Measures m;
    m.energy = energy[k];
    track.follow(m);
    CHECK(m.energy_drift == Approx(drift[k]).margin(1e-15));
    CHECK(m.energy_rise == Approx(rise[k]).margin(1e-15));
  }
}

TEST_CASE("a state without energy has no drift while it stays so, and an infinite one after") {
  EnergyTrack track;
  Measures m;
  track.follow(m);
  CHECK(m.energy_drift == 0);
  CHECK(m.energy_rise == 0);
  m.energy = 1;
  track.follow(m);
  CHECK(std::isinf(m.energy_rise));
}
