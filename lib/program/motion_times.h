// Sample times of a prescribed motion that do not miss its largest speed and acceleration.
#pragma once

#include <vector>

#include "lib/scene/scene.h"

namespace pbf::program_module {

/// Ascending times between `from` and `to` (s since the start), both included. The largest speed
/// and acceleration at these times are within 1 % of those of the motion. The times are the rows of
/// a table and the points of largest slope between them, the extremes of a sine in one period, and
/// points throughout a ramp.
std::vector<double> telling_times(const Scene& scene, const Motion& motion, double from, double to);
std::vector<double> telling_times(const Scene& scene, const TankMotion& motion, double from,
                                  double to);

}  // namespace pbf::program_module
