// Whether a run folder that says it is done holds the run of a scene.
#pragma once

#include <string>

#include "lib/io/run_file.h"
#include "lib/scene/scene.h"

namespace pbf {

/// By which key the run that wrote a file is another than that of `scene`; empty when by none that
/// matters (physics_difference()).
std::string difference_of_file(const RunInfo& info, const Scene& scene);

/// Why the run.h5 of a folder with DONE is not the finished run of `scene` up to its end: missing,
/// not to be read, of another scene, not finished, shorter. Empty when it is, or when the scene
/// writes none.
std::string why_not_finished(const std::string& folder, const Scene& scene);

}  // namespace pbf
