// Warnings about surfaces of obstacles from files.
#pragma once

#include <string>

#include "lib/scene/scene.h"

namespace pbf::run_module {

/// Obstacles a considerable part of whose surface is on parts too thin for their maps; empty if
/// there is none. The surfaces have been read.
std::string thin_text(const Scene& scene);

}  // namespace pbf::run_module
