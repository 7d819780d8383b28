#include "lib/scene/difference.h"

#include <map>
#include <utility>

#include "lib/base/text.h"
#include "lib/scene/keys.h"

namespace pbf::scene_module {
namespace {

/// Collects "key: this before, that now".
class Changes {
 public:
  explicit Changes(std::pair<const char*, const char*> sides) : sides_(sides) {}
  void add(const std::string& path, const std::string& before, const std::string& now) {
    if (before != now)
      all_.push_back(path + ": " + before + " " + sides_.first + ", " + now + " " + sides_.second);
  }
  void add_switch(const std::string& path, bool before, bool now) {
    add(path, before ? "on" : "off", now ? "on" : "off");
  }
  std::vector<std::string> take() { return std::move(all_); }

 private:
  std::pair<const char*, const char*> sides_;
  std::vector<std::string> all_;
};

/// Compares the keys of a list's entries, or of a block in them; both lists have the same length.
/// Keys that only one of two kinds has are skipped, since the kind itself is reported.
void add_entries(const Block& block, const Object& before, const Object& now, Effect least,
                 Changes& out) {
  const std::vector<Holder> was = block.holders(before), is = block.holders(now);
  std::map<std::string, const Holder*> then;
  for (const Holder& holder : was) then[holder.path] = &holder;
  for (const Holder& holder : is) {
    const auto other = then.find(holder.path);
    if (other == then.end()) {
      out.add_switch(holder.path, false, true);
      continue;
    }
    const Object &a = other->second->object, &b = holder.object;
    for (const Key* key : block.keys)
      if (key->effect >= least && (key->kinds & block.kind_of(a)) &&
          (key->kinds & block.kind_of(b)))
        out.add(join(holder.path, key->leaf()), value_text(*key, a), value_text(*key, b));
    then.erase(other);
  }
  for (const auto& [path, holder] : then) out.add_switch(path, true, false);
}

}  // namespace

std::vector<std::string> differences(const KeyTable& table, const Object& before, const Object& now,
                                     Effect least, std::pair<const char*, const char*> sides) {
  Changes out(sides);
  const auto in_both = [&](const Block& b) { return b.is_present(before) && b.is_present(now); };
  for (const Block& block : table.blocks)
    if (block.optional && !block.list_around() && block.effect >= least &&
        (block.parent == nullptr || in_both(*block.parent)))
      out.add_switch(block.path, block.is_present(before), block.is_present(now));
  for (const Key& key : table.keys)
    if (!key.block->list && key.effect >= least && in_both(*key.block) &&
        (key.kinds & key.block->kind_of(before)) && (key.kinds & key.block->kind_of(now)))
      out.add(key.path, value_text(key, before), value_text(key, now));
  const auto as_many = [&](const Block& b) { return b.size(before) == b.size(now); };
  for (const Block& block : table.blocks)
    if (block.list && block.effect >= least)
      out.add(block.leaf(), std::to_string(block.size(before)), std::to_string(block.size(now)));
  for (const Block& block : table.blocks)
    if (block.list_around() && block.effect >= least && as_many(*block.list_around()))
      add_entries(block, before, now, least, out);
  return out.take();
}

std::string first_of(std::vector<std::string> parts, std::size_t most) {
  if (parts.size() > most) {
    const std::size_t more = parts.size() - most;
    parts.resize(most);
    parts.push_back("and " + std::to_string(more) + " more");
  }
  return joined(parts, "; ");
}

std::string physics_difference(const Scene& before, const Scene& now) {
  return first_of(differences(scene_table(), object(before), object(now),
                              now.time.adaptive ? Effect::adaptive : Effect::results));
}

}  // namespace pbf::scene_module
