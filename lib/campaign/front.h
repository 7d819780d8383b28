// The front of a dam break in the dimensionless form of published experiments.
#pragma once

#include <string>
#include <vector>

namespace pbf::inline campaign_module {

/// A published front: Z over T.
struct FrontData {
  std::string name;  ///< of the file, without folder and ending
  std::vector<double> T, Z;
};

/// T = t sqrt(factor g / length), Z = (x - origin)/length with x the largest coordinate along the
/// axis plus half a spacing: a particle fills the space around its centre.
struct Front {
  int axis = 0;
  double origin = 0;  ///< m, the wall behind the column
  double length = 0;  ///< m, a, L or H of the experiment
  double factor = 1;  ///< 2 for a column twice as high as wide (Martin & Moyce: n^2)
  std::vector<FrontData> data;
};

/// Reads a table with the columns T and Z: lines that start with # are comments, then a header.
/// Throws Error(bad_input) naming file and line, Error(io) when it cannot be read.
FrontData read_front_data(const std::string& path);

/// A simulated front in the same form.
struct FrontCurve {
  std::vector<double> T, Z;
};
FrontCurve front_curve(const Front& front, double gravity, double spacing,
                       const std::vector<double>& time, const std::vector<double>& x);

/// RMS of Z_simulated(T) - Z over the published points within the simulated time, linear between
/// samples; NaN when there is none. `points`: how many were compared.
double front_deviation(const FrontCurve& curve, const FrontData& data,
                       std::size_t* points = nullptr);

}  // namespace pbf::inline campaign_module
