#include "lib/scene/difference.h"

#include "lib/scene/keys.h"

namespace pbf::inline scene_module {
namespace {

std::string changed(const std::string& path, const std::string& before, const std::string& now) {
  return before == now ? std::string() : path + ": " + before + " before, " + now + " now";
}

std::string list_difference(const Block& list, const Object& before, const Object& now,
                            Effect least) {
  const std::size_t n = list.size(now);
  std::string what = changed(list.leaf(), std::to_string(list.size(before)), std::to_string(n));
  for (std::size_t i = 0; i < n && what.empty(); ++i) {
    const Object was = list.entry(before, i), is = list.entry(now, i);
    for (const Key* key : list.keys)
      if (what.empty() && (key->kinds & list.kind_of(is)) && key->effect >= least)
        what = changed(join(list.entry_path(i), key->leaf()), value_text(*key, was),
                       value_text(*key, is));
  }
  return what;
}

}  // namespace

std::string first_difference(const KeyTable& table, const Object& before, const Object& now,
                             Effect least) {
  for (const Block& block : table.blocks) {
    if (!block.optional || block.effect < least) continue;
    const bool was = block.is_present(before), is = block.is_present(now);
    if (was != is) return changed(block.path, was ? "on" : "off", is ? "on" : "off");
  }
  std::string what;
  for (const Key& key : table.keys)
    if (what.empty() && !key.block->list && key.effect >= least && key.block->is_present(now))
      what = changed(key.path, value_text(key, before), value_text(key, now));
  for (const Block& block : table.blocks)
    if (what.empty() && block.list && block.effect >= least)
      what = list_difference(block, before, now, least);
  return what;
}

std::string physics_difference(const Scene& before, const Scene& now) {
  return first_difference(scene_table(), object(before), object(now),
                          now.time.adaptive ? Effect::adaptive : Effect::results);
}

}  // namespace pbf::inline scene_module
