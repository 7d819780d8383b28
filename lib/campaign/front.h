// The front of a dam break in the dimensionless form of published experiments.
#pragma once

#include <string>
#include <vector>

namespace pbf::campaign_module {

/// A published front: Z over T.
struct FrontData {
  std::string name;  ///< of the file, without folder and ending
  std::vector<double> T, Z;
};

/// T = t sqrt(factor g / length), Z = (x - origin)/length, with x the largest coordinate along the
/// axis plus half a spacing, because a particle fills the space around its center.
struct Front {
  int axis = 0;
  double origin = 0;  ///< m, the wall behind the column
  double length = 0;  ///< m, the length a, L or H of the experiment
  double factor = 1;  ///< 2 for a column twice as high as wide (Martin & Moyce: n^2)
  std::vector<FrontData> data;
};

/// Reads a table with the columns T and Z: comment lines with #, then a header. Throws
/// Error(bad_input) with file and line, Error(io) if it cannot be read.
FrontData read_front_data(const std::string& path);

/// A simulated front in the same form.
struct FrontCurve {
  std::vector<double> T, Z;
};
FrontCurve front_curve(const Front& front, double gravity, double spacing,
                       const std::vector<double>& time, const std::vector<double>& x);

/// RMS of Z_simulated(T) - Z over the published points within the simulated time, with linear
/// interpolation; NaN without such points. `points`: their number.
double front_deviation(const FrontCurve& curve, const FrontData& data,
                       std::size_t* points = nullptr);

}  // namespace pbf::campaign_module
