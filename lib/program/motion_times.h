// Times at which to look at a prescribed motion, so that nothing of it is missed.
#pragma once

#include <vector>

#include "lib/scene/scene.h"

namespace pbf::inline program_module {

/// Rising times from `from` to `to` (s since the start), both included, so close together where
/// the motion changes that its speed and its acceleration are nowhere larger than at one of them
/// by more than 1 %: the rows of a table and the steepest places between them, the extremes of a
/// sine, the whole of a ramp however short it is. What is periodic is looked at for one period.
std::vector<double> telling_times(const Scene& scene, const Motion& motion, double from, double to);
std::vector<double> telling_times(const Scene& scene, const TankMotion& motion, double from,
                                  double to);

}  // namespace pbf::inline program_module
