#include "lib/scene/keys.h"

#include <algorithm>

#include "lib/base/error.h"
#include "lib/scene/key_rows.h"

namespace pbf::scene_module {

// keys_*.cpp
KeyRows start_rows();
KeyRows obstacle_rows();
KeyRows gauge_rows();
KeyRows emitter_rows();
KeyRows motion_rows();
KeyRows moved_rows();
KeyRows free_rows();
KeyRows compare_rows();
KeyRows run_rows();

namespace {

template <class Row>
const Row* find(const std::vector<Row>& rows, std::string Row::*text, const std::string& wanted) {
  for (const Row& row : rows)
    if (row.*text == wanted) return &row;
  return nullptr;
}

}  // namespace

std::string path_of(std::string member) {
  std::erase(member, '-');
  std::replace(member.begin(), member.end(), '>', '.');
  return member;
}

void add_kind_row(std::vector<Key>& rows, Key row) {
  const auto there = std::ranges::find(rows, row.path, &Key::path);
  if (there == rows.end()) return rows.push_back(std::move(row));
  const auto said = [](const Key& k) {
    return std::tie(k.help, k.unit, k.most, k.required, k.by_center);
  };
  if (said(row) != said(*there) || row.range != there->range ||
      (row.flat != there->flat && row.flat != FlatY::middle))
    throw Error(ExitCode::internal, row.path +
                                        ": two kinds have this key and differ in its help, "
                                        "unit, range or traits; give them one text, or the "
                                        "keys different names");
  if (row.flat != there->flat) there->in_plane |= row.kinds;
  there->field = std::move(row.field);
  there->kinds |= row.kinds;
}

std::string join(const std::string& block, const std::string& leaf) {
  return block.empty() ? leaf : block + "." + leaf;
}
std::string block_of(const std::string& path) {
  const std::size_t dot = path.rfind('.');
  return dot == std::string::npos ? "" : path.substr(0, dot);
}
std::string leaf_of(const std::string& path) { return path.substr(path.rfind('.') + 1); }

std::string Key::leaf() const { return leaf_of(path); }
std::string Block::leaf() const {
  const std::string last = leaf_of(path);
  return list ? last.substr(0, last.find('[')) : last;
}

std::string Block::entry_path(std::size_t i) const {
  return list ? leaf() + "[" + std::to_string(i) + "]" : path;
}

const Block* Block::list_around() const {
  return list || parent == nullptr ? (list ? this : nullptr) : parent->list_around();
}

std::vector<Holder> Block::holders(const Object& object) const {
  std::vector<Holder> all;
  const Block* around = list_around();
  if (around == nullptr) {
    if (is_present(object)) all.push_back({object, path});
    return all;
  }
  for (std::size_t i = 0; i < around->size(object); ++i) {
    const Object holder = around->entry(object, i);
    if (this == around || size(holder) > 0)
      all.push_back({holder, around->entry_path(i) + path.substr(around->path.size())});
  }
  return all;
}

bool Block::is_present(const Object& object) const {
  if (!list && list_around() != nullptr) return false;
  return (parent == nullptr || parent->is_present(object)) && (list || size(object) > 0);
}

unsigned Block::kind_of(const Object& holder) const {
  return kind == nullptr ? ~0u : 1u << std::get<ChoiceField>(kind->field(holder)).get();
}

std::string List::least_text() const {
  return "at least " + (least == 1 ? "one" : std::to_string(least));
}

KeyTable::KeyTable(const std::vector<KeyRows>& parts, const Object& defaults) {
  for (const KeyRows& part : parts) {
    blocks.insert(blocks.end(), part.blocks.begin(), part.blocks.end());
    keys.insert(keys.end(), part.keys.begin(), part.keys.end());
  }
  for (Block& block : blocks)
    if (!block.path.empty()) {
      block.parent = find_block(block_of(block.path));
      if (block.exact == nullptr) block.exact = block.parent->exact;
    }
  for (Key& key : keys) {
    Block& block = const_cast<Block&>(*find_block(block_of(key.path)));
    block.keys.push_back(&key);
    if (key.is_kind) block.kind = &key;
    key.block = &block;
    key.standard = block.list_around() ? block.list_around()->list->standard : defaults;
    key.effect = std::min(key.effect, block.effect);
    if (block.exact != nullptr) key.exact = block.exact;
  }
  make_all_present(defaults);
  for (const Block& block : blocks)
    if (const Block* around = block.list_around(); around && around != &block)
      block.resize(around->list->standard, 1);
}

const Key* KeyTable::find_key(const std::string& path) const {
  return find(keys, &Key::path, path);
}
const Key* KeyTable::find_renamed(const std::string& path) const {
  return path.empty() ? nullptr : find(keys, &Key::was, path);
}
const Block* KeyTable::find_block(const std::string& path) const {
  return find(blocks, &Block::path, path);
}

bool KeyTable::has_required(const Block& block) const {
  if (block.list) return block.list->least > 0 && block.list->unless.empty();
  return std::ranges::any_of(block.keys, &Key::required) ||
         std::ranges::any_of(blocks, [&](const Block& child) {
           return child.parent == &block && is_required(child);
         });
}

bool KeyTable::is_required(const Block& block) const {
  return (!block.optional || block.on_by_default) && has_required(block);
}

void KeyTable::make_all_present(const Object& object) const {
  for (const Block& block : blocks)
    if (block.list_around() == nullptr) block.resize(object, 1);
}

std::map<const void*, std::string> KeyTable::names(const Object& object) const {
  const auto address = [](const auto& field) -> const void* { return field; };
  std::map<const void*, std::string> names;
  for (const Block& block : blocks) {
    if (block.list) names[block.list->address(object)] = block.leaf();
    for (const Holder& holder : block.holders(object))
      for (const Key* key : block.keys)
        names[std::visit(address, key->field(holder.object))] = join(holder.path, key->leaf());
  }
  return names;
}

const KeyTable& scene_table() {
  static Scene defaults;
  static const KeyTable table(
      {start_rows(), obstacle_rows(), gauge_rows(), emitter_rows(), motion_rows(), moved_rows(),
       free_rows(), compare_rows(), run_rows()},
      object(defaults));
  return table;
}

}  // namespace pbf::scene_module
