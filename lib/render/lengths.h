// The labels of lengths on a picture.
#pragma once

#include "lib/render/camera.h"
#include "lib/render/texts.h"

namespace pbf::render_module {

/// Draws the labels of length_labels() (lib/render/grid.h) beside the box: as many as keep a
/// distance from each other, none of an edge on which fewer than two fit. `size`: of the text,
/// pixels per em.
void draw_lengths(Image& image, Texts& texts, const View& view, const Projection& projection,
                  double size);

}  // namespace pbf::render_module
