// What linear theory says of the sponges ahead of a wave maker.
#pragma once

#include <string>
#include <vector>

#include "lib/scene/waves.h"

namespace pbf::scene_module {

/// Share of the height that a zone before a wall sends back, by linear theory of long waves: at its
/// `lengths` (wavelengths) velocities decay at rate s^profile, s from 0 to 1 at the wall.
/// rate: per period. 1 for a length of 0.
double sponge_reflection(double lengths, double rate, int profile);

/// A zone in which waves of a wave maker end.
struct WaveSponge {
  std::string name;
  double from = 0;        ///< m, its begin along the waves, from the front of the paddle
  double lengths = 0;     ///< wavelengths
  double reflection = 0;  ///< share of the height
};
/// Of zones whose velocities decay towards the far end; those of solitary waves have no wavelength
/// and are left out.
std::vector<WaveSponge> wave_sponges(const Scene& scene, const WaveMaker& maker);

}  // namespace pbf::scene_module
