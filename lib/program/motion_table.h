// The curve through the rows of a table of motion.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "lib/scene/motion.h"

namespace pbf::inline program_module {

/// Column c at a time: cubic between rows, by slopes of second order; beyond the table straight on.
/// A slope takes the longer of the two ways beside its row no farther than 1.5 times what the
/// larger of the two rises is, which no smooth motion does. So a jump between two rows close
/// together, with long ones around, swings beyond the table by less than a quarter of itself.
double cubic(const MotionTable& table, std::size_t c, double t);
/// The same straight between rows, and beyond them as at the ends.
double straight(const MotionTable& table, std::size_t c, double t);

/// The cubic between two rows.
struct CurvePiece {
  double begin = 0, width = 0;  ///< s, of the table
  double y0 = 0, y1 = 0;        ///< at the rows
  double slope0 = 0, slope1 = 0;
  /// Times strictly between the rows at which it turns back.
  std::vector<double> turns() const;
  /// The time strictly between the rows at which its slope has an extreme.
  std::optional<double> steepest() const;
};

/// From `row` to the next one.
CurvePiece curve_piece(const MotionTable& table, std::size_t c, std::size_t row);
/// The row at which the piece of this time begins; of a time beyond the table the first or last.
std::size_t piece_at(const MotionTable& table, double t);

}  // namespace pbf::inline program_module
