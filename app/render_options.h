// Converts the options of `pbf render` to numbers. Errors are Error(bad_input) with the name of the
// option.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lib/scene/scene.h"

namespace pbf::app_module {

struct RenderOptions {
  std::string run;                  ///< path of run.vtkhdf
  std::string frames = "all";       ///< k, a:b, a:b:step (b excluded, negative from the end) or all
  std::string size;                 ///< WxH, empty: as the scene says
  std::string camera;               ///< position=x,y,z;target=x,y,z;fov=deg;orbit=deg/s
  std::string style, color, range;  ///< empty: as the scene says
  std::string out;                  ///< folder, empty: render/ beside the run file
};

/// "all", "k", "a:b" or "a:b:step", as in Python: b excluded, negative from the end, empty for the
/// ends. Throws if no frame of `frames` is selected.
std::vector<std::int64_t> select_frames(const std::string& text, std::int64_t frames);

/// Whether the range is computed from the frames.
bool by_quantile(const RenderOptions& options);

/// Applies --size, --camera, --style, --color and --range to the scene's render settings. A new
/// color without a range gets the default range of its field.
void apply_render_options(const RenderOptions& options, Scene& scene);

}  // namespace pbf::app_module
