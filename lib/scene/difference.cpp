#include "lib/scene/difference.h"

#include <algorithm>

#include "lib/scene/keys.h"

namespace pbf::inline scene_module {
namespace {

/// The guard changes no particle, but where its alarms shorten the step.
bool is_free(const std::string& path, const Scene& now) {
  static const char* const kFree[] = {
      "name", "time.end", "threads", "backend", "solver.reproducible", "checkpoint.every"};
  if (path.rfind("guard.", 0) == 0) return !now.time.adaptive;
  return std::find(std::begin(kFree), std::end(kFree), path) != std::end(kFree);
}

std::string changed(const std::string& path, const std::string& before, const std::string& now) {
  return before == now ? std::string() : path + ": " + before + " before, " + now + " now";
}

std::string body_difference(const Scene& before, const Scene& now) {
  if (before.bodies.size() != now.bodies.size())
    return changed("bodies", std::to_string(before.bodies.size()),
                   std::to_string(now.bodies.size()));
  for (std::size_t b = 0; b < now.bodies.size(); ++b) {
    const unsigned shape = 1u << static_cast<unsigned>(now.bodies[b].shape);
    for (const Key& key : scene_keys()) {
      if (key.block() != "bodies[]" || !(key.shapes & shape)) continue;
      const std::string path = "bodies[" + std::to_string(b) + "]." + key.leaf();
      std::string what = changed(path, value_text(key, before, before.bodies[b]),
                                 value_text(key, now, now.bodies[b]));
      if (!what.empty()) return what;
    }
  }
  return {};
}

}  // namespace

std::string physics_difference(const Scene& before, const Scene& now) {
  for (const Block& block : scene_blocks()) {
    if (!block.optional || block.path == "checkpoint") continue;
    if (block.path == "guard" && !now.time.adaptive) continue;
    const bool was = block.present(before), is = block.present(now);
    if (was != is) return changed(block.path, was ? "on" : "off", is ? "on" : "off");
  }
  for (const Key& key : scene_keys()) {
    const std::string block = key.block();
    if (block == "bodies[]" || is_free(key.path, now) || !is_present(now, block)) continue;
    std::string what =
        changed(key.path, value_text(key, before, Body{}), value_text(key, now, Body{}));
    if (!what.empty()) return what;
  }
  return body_difference(before, now);
}

}  // namespace pbf::inline scene_module
