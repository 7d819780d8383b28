// Scene files: any bytes give a scene or an Error; what is a scene comes back from its own text.
#include <cstdlib>

#include "lib/base/error.h"
#include "lib/scene/load.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  pbf::Scene scene;
  try {
    scene = pbf::parse_scene({reinterpret_cast<const char*>(data), size}, "fuzz.yaml", {});
  } catch (const pbf::Error&) {
    return 0;
  }
  if (!(pbf::parse_scene(pbf::resolved_yaml(scene), "resolved", {}) == scene)) std::abort();
  return 0;
}
