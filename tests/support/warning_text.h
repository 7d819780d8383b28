// What is told of a scene before it is run.
#pragma once

#include <string>

#include "lib/run/warnings.h"

/// The text of the only warning's kind; empty when there is none of it.
inline std::string text_of(const std::string& kind, const pbf::Scene& s) {
  for (const pbf::Warning& w : scene_warnings({s, "."}, count_particles(s, ".")))
    if (w.kind == kind) return w.text;
  return {};
}
