// Whether a run folder that says it is done holds the run of a scene.
#pragma once

#include <string>

#include "lib/io/run_file.h"
#include "lib/scene/scene.h"

namespace pbf::inline run_module {

/// By which key the run of a folder's run.vtkhdf is another than that of `scene`; empty when by
/// none that matters (physics_difference()), and when there is no such file that can be read.
std::string difference_of_file(const std::string& folder, const Scene& scene);

/// Why the run.vtkhdf of a folder with DONE is not a finished run up to the end of `scene`:
/// missing, not to be read, not finished, shorter. Empty when it is, or when the scene writes none.
std::string why_not_finished(const std::string& folder, const Scene& scene);

}  // namespace pbf::inline run_module
