#include "lib/scene/difference.h"

#include <algorithm>

#include "lib/scene/keys.h"

namespace pbf::inline scene_module {
namespace {

std::string changed(const std::string& path, const std::string& before, const std::string& now) {
  return before == now ? std::string() : path + ": " + before + " before, " + now + " now";
}

std::string list_difference(const Block& list, const Object& before, const Object& now) {
  return changed(list.leaf(), std::to_string(list.size(before)), std::to_string(list.size(now)));
}

/// Of the keys of a list's entries, or of a block in them; there are as many entries.
std::string entry_difference(const Block& block, const Object& before, const Object& now,
                             Effect least) {
  const std::vector<Holder> was = block.holders(before), is = block.holders(now);
  std::string what;
  for (std::size_t k = 0; k < std::max(was.size(), is.size()) && what.empty(); ++k) {
    if (k >= was.size() || (k < is.size() && is[k].path < was[k].path))
      return changed(is[k].path, "off", "on");
    if (k >= is.size() || was[k].path < is[k].path) return changed(was[k].path, "on", "off");
    for (const Key* key : block.keys)
      if (what.empty() && (key->kinds & block.kind_of(is[k].object)) && key->effect >= least)
        what = changed(join(is[k].path, key->leaf()), value_text(*key, was[k].object),
                       value_text(*key, is[k].object));
  }
  return what;
}

}  // namespace

std::string first_difference(const KeyTable& table, const Object& before, const Object& now,
                             Effect least) {
  for (const Block& block : table.blocks) {
    if (!block.optional || block.list_around() || block.effect < least) continue;
    const bool was = block.is_present(before), is = block.is_present(now);
    if (was != is) return changed(block.path, was ? "on" : "off", is ? "on" : "off");
  }
  std::string what;
  for (const Key& key : table.keys)
    if (what.empty() && !key.block->list && key.effect >= least && key.block->is_present(now) &&
        (key.kinds & key.block->kind_of(now)))
      what = changed(key.path, value_text(key, before), value_text(key, now));
  for (const Block& block : table.blocks)
    if (what.empty() && block.list && block.effect >= least)
      what = list_difference(block, before, now);
  for (const Block& block : table.blocks)
    if (what.empty() && block.list_around() && block.effect >= least)
      what = entry_difference(block, before, now, least);
  return what;
}

std::string physics_difference(const Scene& before, const Scene& now) {
  return first_difference(scene_table(), object(before), object(now),
                          now.time.adaptive ? Effect::adaptive : Effect::results);
}

}  // namespace pbf::inline scene_module
