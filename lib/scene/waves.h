// What wave makers do, by theory: the motion of the paddle and the waves that it makes. Pure
// functions. Sources: Biesel 1951 (first order), Madsen 1971 (second order of a piston), Goring
// 1978 (solitary waves), Hasselmann et al. 1973 (JONSWAP), Tromans et al. 1991 (focused waves).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lib/scene/scene.h"

namespace pbf::scene_module {

/// 1/m, of linear waves: omega^2 = g k tanh(k depth). omega in 1/s, > 0.
double wave_number(double omega, double depth, double gravity);
/// m/s, how fast energy runs.
double group_speed(double omega, double k, double depth);
/// Height of the waves over the stroke at still water. kd: k times the depth; hinge: its height
/// above the floor over the depth, below 1, negative below the floor.
double piston_ratio(double kd);
double flap_ratio(double kd, double hinge);
/// m, amplitude of the second harmonic of a piston (Madsen).
double second_stroke(double height, double depth, double kd);
/// Of the spectrum in arbitrary units, at the frequency f (in 1/period). gamma: 1 for
/// Pierson-Moskowitz.
double wave_spectrum(double f, double gamma);
/// radians, of a line of an irregular sea, and the second number that a line has, in (0, 1].
struct LineNumbers {
  double phase, uniform;
};
LineNumbers line_numbers(std::uint64_t seed, std::int64_t line);

/// A harmonic: the paddle is at stroke sin(omega t + phase), the water at a distance s from it at
/// amplitude cos(omega t - k s + phase).
struct WaveLine {
  double omega = 0, k = 0, phase = 0;  ///< 1/s, 1/m, radians
  double stroke = 0, amplitude = 0;    ///< m
  double group = 0;                    ///< m/s, of the front
};
struct SolitaryWave {
  double height = 0, begin = 0;        ///< m; s, when the paddle begins
  double kappa = 0, speed = 0;         ///< 1/m, m/s
  double from = 0;                     ///< m, where the paddle is when it begins
  double half_stroke = 0, middle = 0;  ///< m; s after `begin`, of the crest at the paddle
  /// s, after which the paddle stands still, but for a thousandth.
  double duration() const;
};

/// A wave maker in its scene. Times are s of the motion's clock.
struct WaveMaker {
  int dimensions = 3;          ///< of the scene
  double smoothing_ratio = 2;  ///< h/d of the scene
  bool flap = false;
  std::size_t axis = 0;                ///< along which waves run, 0 or 1
  double sign = 1;                     ///< -1: they run against it
  double front = 0, back = 0;          ///< m, of the box at rest, along the axis times the sign
  double ahead = 0;                    ///< m, from the front to the end of the tank
  double depth = 0, hinge = 0;         ///< m, above the floor
  double gravity = 0;                  ///< m/s^2
  double height = 0, period = 0;       ///< m, s: of the waves; twice the crest, 2 pi/(kappa c)
  double k = 0, speed = 0, group = 0;  ///< 1/m, m/s
  bool second = false;                 ///< theory of second order
  double shortest = 0;                 ///< s, shortest period
  double start = 0, ramp = 0, gain = 1;
  std::vector<WaveLine> lines{};
  std::vector<SolitaryWave> solitary{};

  double length() const;  ///< m
  double kd() const { return k * depth; }
  double ursell() const { return height * length() * length() / (depth * depth * depth); }
  /// m, the height at which waves break by McCowan and Miche, and whether the first decides.
  double breaks_at() const;
  bool by_mccowan() const;
  /// Share of the height that a wave loses per wavelength at a spacing (m): an estimate from fits
  /// to flumes with levels: on and h = 2 d, or 3.5 d (in three dimensions 3 d), whichever is
  /// nearer (tests/regression/waves); kD 0.6 to 2, in two dimensions H/d 2 to 12, in three 4 to 8.
  /// 0 of solitary waves.
  double loss(double spacing) const;
  /// Whether h is nearer to 2 d than to what was recommended for waves without levels.
  bool has_short_kernel() const { return smoothing_ratio < (dimensions == 2 ? 2.75 : 2.5); }
  /// Of regular waves of a piston: the free wave of half the period that a motion of first order
  /// makes, as a share of the first harmonic. 0 of others.
  double free_share() const;
  /// s of the motion's clock, when the first wave is at the distance s (m).
  double arrival(double s) const { return start + s / group; }
  /// m, displacement at still water from where it rests, positive towards the waves.
  double paddle(double time) const;
  /// The same as rotation of a flap, degrees.
  double angle(double time) const;
  /// m above still water at the distance s from the front at rest, as expected with a gain of 1.
  /// 0 before the front of the waves arrives.
  double elevation(double s, double time) const;
};

/// m, to which blocks on the floor are filled ahead of the obstacle; absent: there are none, or
/// they differ. `given`: to which they would be filled if spacings fitted.
struct FilledDepth {
  double level, given;
};
std::optional<FilledDepth> filled_depth(const Scene& scene, const Obstacle& obstacle);

/// Of an obstacle that makes waves and has no errors (check_waves.cpp).
WaveMaker wave_maker(const Scene& scene, const Obstacle& obstacle);
/// Of the file that a run keeps of the wave maker.
inline std::string wave_file_name(const std::string& obstacle) {
  return "waves_" + obstacle + ".csv";
}
/// s, of irregular waves: `repeat`, or what it is by default.
double repeat_of(const Scene& scene, const Motion& motion);

/// Rows of a motion in the shortest period.
inline constexpr double kRowsPerPeriod = 64;
/// Rows of the motion throughout the run and beyond both its ends, kRowsPerPeriod to the period.
/// Their numbers are multiples of 1e-9 s, m or degrees, so that they do not depend on the last bit
/// of mathematical functions. `most`: of rows; the table is empty if it takes more.
MotionTable wave_table(const Scene& scene, const Obstacle& obstacle, double most = 4e6);

}  // namespace pbf::scene_module
