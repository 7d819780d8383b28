// What `pbf run` is given: a scene file, or a run file whose scene is to run again.
#pragma once

#include <string>
#include <vector>

#include "lib/scene/load.h"

namespace pbf {

/// load_scene() of a scene file; of a run file (told by its first bytes) the scene that it holds,
/// with every default as it was then, and the overrides of this time on top. Paths in it are those
/// of the scene file that the run was begun with. Throws as load_scene() and RunReader do.
LoadedScene load_scene_or_run(const std::string& path, const std::vector<std::string>& overrides);

}  // namespace pbf
