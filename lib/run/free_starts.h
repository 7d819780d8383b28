// Where free bodies are when all files have been read.
#pragma once

#include "lib/scene/scene.h"

namespace pbf::run_module {

/// Throws Error(bad_input), naming the body, if one is too light, reaches through a wall, or
/// overlaps another obstacle (moving ones as they are at the start) or the casing of an emitter.
/// The loader has told what needs no files. Maps have been made (make_maps()).
void require_free_starts(const Scene& scene);

}  // namespace pbf::run_module
