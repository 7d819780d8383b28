// Lengths in pictures: lines on the floor at round places, and labels along its near edges and up
// one edge of the box; in two dimensions a scale along the lower and the left edge.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "lib/render/box.h"
#include "lib/render/camera.h"
#include "lib/render/font.h"

namespace pbf::render_module {

/// Distance of lines along sides of which the longest is `longest` (above 0): 1, 2 or 5 times a
/// power of ten, so that 4 to 10 fit.
double grid_step(double longest);

/// The multiples of `step` from `low` to `high`, both ends included where they are (to rounding);
/// at most 1000.
std::vector<double> multiples(double low, double high, double step);

/// Appends the lines on the floor, where the eye sees one: at multiples of the grid's step
/// between the edges.
void add_floor_grid(const View& view, const Projection& projection, double width, double near_depth,
                    std::vector<FlatVertex>& out);

/// A label of a length, beside a place of an edge.
struct LengthLabel {
  std::string text;             ///< "0.5"
  std::array<double, 2> place;  ///< pixels, on the edge
  std::array<double, 2> away;   ///< unit vector in the picture, out of the box
};

/// The labels of an edge, those at every multiple of the step first: `of[0]`; then those of every
/// second, fifth, tenth ... multiple, from which one chooses by the room that there is.
struct EdgeLabels {
  std::vector<std::vector<LengthLabel>> of;
  bool ticks = false;      ///< whether each has one; on the floor it stands at a line of the grid
  std::string axis, unit;  ///< "y", "m": of the edge, not of its last number
};

/// Of the two near edges of the floor and of a vertical one on the outline of the box; in two
/// dimensions of the lower and the left one. None where no floor is seen. Places behind the eye are
/// left out.
std::vector<EdgeLabels> length_labels(const View& view, const Projection& projection);

/// Draws these labels beside the box: as many as keep a distance from each other, none of an edge
/// on which fewer than two fit. `size`: of the text, pixels per em.
void draw_lengths(Image& image, Texts& texts, const View& view, const Projection& projection,
                  double size);

}  // namespace pbf::render_module
