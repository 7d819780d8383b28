// --set and --grid: any argument gives a scene or an Error.
#include <cstdlib>

#include "lib/base/error.h"
#include "lib/campaign/batch_list.h"
#include "lib/scene/load.h"

namespace {
constexpr const char* kScene =
    "domain: {min: [0, 0, 0], max: [1, 1, 1]}\n"
    "fluid: {spacing: 0.1}\n"
    "bodies: [{shape: block, min: [0, 0, 0], max: [0.4, 0.4, 0.4]}]\n"
    "time: {step: 0.005, end: 0.1}\n";
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    if (pbf::parse_axis(text).empty()) std::abort();
  } catch (const pbf::Error&) {
  }
  try {
    const pbf::Scene scene = pbf::parse_scene(kScene, "scene", {text});
    if (!(pbf::parse_scene(pbf::resolved_yaml(scene), "resolved", {}) == scene)) std::abort();
  } catch (const pbf::Error&) {
  }
  return 0;
}
