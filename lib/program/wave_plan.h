// What the plan says of wave makers.
#pragma once

#include <string>

#include "lib/base/json.h"
#include "lib/scene/scene.h"

namespace pbf::program_module {

/// "waves NAME: ..." and what theory says of each wave maker; empty without any.
std::string wave_part(const Scene& scene);
/// The same, one object per wave maker; lengths in m, times in s.
Json wave_json(const Scene& scene);

}  // namespace pbf::program_module
