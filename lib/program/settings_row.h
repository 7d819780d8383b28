// Which problem of the page configs/SETTINGS.md a scene looks like.
#pragma once

#include <optional>

#include "lib/scene/scene.h"

namespace pbf::program_module {

struct SettingsRow {
  const char* row;      ///< of tests/regression/settings/settings.yaml: "waves"
  const char* heading;  ///< on the page
  const char* because;  ///< what in the scene says so
};

/// Empty if the scene looks like none of them.
std::optional<SettingsRow> settings_row(const Scene& scene);

}  // namespace pbf::program_module
