// The curve through the rows of a table of motion.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "lib/scene/motion.h"

namespace pbf::program_module {

/// Column c at time t: cubic between rows, with slopes of second order; beyond the table straight.
/// A slope times the longer interval beside its row is at most 1.5 times the larger change over the
/// two intervals; smooth motions stay below this limit. Around a jump between two close rows, the
/// curve thus leaves the range of the table by less than a quarter of the jump.
double cubic(const MotionTable& table, std::size_t c, double t);
/// The same with straight lines between rows; constant beyond the table.
double straight(const MotionTable& table, std::size_t c, double t);

/// The cubic between two rows.
struct CurvePiece {
  double begin = 0, width = 0;  ///< s, of the table
  double y0 = 0, y1 = 0;        ///< at the rows
  double slope0 = 0, slope1 = 0;
  /// Times of extremes, strictly between the rows.
  std::vector<double> turns() const;
  /// The time of the extreme slope, if it is strictly between the rows.
  std::optional<double> steepest() const;
};

/// The piece from `row` to the next row.
CurvePiece curve_piece(const MotionTable& table, std::size_t c, std::size_t row);
/// The row at which the piece of time t begins; beyond the table that of the first or last piece.
std::size_t piece_at(const MotionTable& table, double t);

}  // namespace pbf::program_module
