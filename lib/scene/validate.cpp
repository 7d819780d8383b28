#include "lib/scene/validate.h"

#include <algorithm>

#include "lib/base/text.h"
#include "lib/scene/keys.h"
#include "lib/scene/number.h"
#include "lib/scene/remedies.h"
#include "lib/scene/suggest.h"
#include "lib/scene/value.h"

namespace pbf::scene_module {
namespace {

/// The parent of a path: "bodies[0].min" -> "bodies[0]" -> "bodies" -> "".
std::string around(const std::string& path) {
  const std::size_t end = path.find_last_of(".[");
  return end == std::string::npos ? "" : path.substr(0, end);
}

/// `off` or an explicit null. In a file, a missing value is not `off`: the keys of the block were
/// forgotten or commented out.
bool turns_off(const Node& node) {
  if (node.kind == Node::Kind::null) return node.line < 0 || !node.text.empty();
  return !node.quoted && node.is_word({"off", "false"});
}

bool turns_on(const Node& node) { return !node.quoted && node.is_word({"on", "true"}); }

/// "at least one body"; just "gauges" for a list that may be empty.
std::string least_text(const Block& list) {
  const List& l = *list.list;
  if (l.least == 0) return list.leaf();
  return l.least_text() + " " + (l.least == 1 ? l.entry_name : list.leaf());
}

class Validator {
 public:
  Validator(const KeyTable& table, const Object& object, Problems& problems)
      : table_(table), object_(object), problems_(problems) {}

  KeyPlaces run(const Node& root) {
    out_.places[""] = (root_ = &root)->place();
    if (root.kind == Node::Kind::map)
      read_block(*table_.find_block(""), "", root, object_, ~0u);
    else
      report(root.place(), "",
             "expected a scene: keys such as " + examples() + "; got " + root.shown() +
                 (root.kind == Node::Kind::scalar ? missing_space(root.text) : ""));
    return std::move(out_);
  }

 private:
  /// The first blocks of the top level, as examples in a message.
  std::string examples() const {
    std::string text;
    for (std::size_t i = 1; i < std::min<std::size_t>(4, table_.blocks.size()); ++i)
      text += (i == 1 ? "" : ", ") + table_.blocks[i].leaf();
    return text;
  }

  void report(const std::string& place, const std::string& key, const std::string& what) {
    problems_.add(place, key, what);
    out_.bad.insert(key);
  }

  /// Reads a map as a block or entry called `shown` ("bodies[0]") into the members of `holder`.
  /// `kind`: bit of an entry's kind, 0 if it is missing or wrong.
  void read_block(const Block& block, const std::string& shown, const Node& node,
                  const Object& holder, unsigned kind) {
    std::map<std::string, std::size_t> seen;  // every key and its first index in the node
    for (std::size_t i = 0; i < node.keys.size(); ++i) {
      const Node& name = node.keys[i];
      if (name.kind != Node::Kind::scalar) {
        report(name.place(), shown, "a key must be a word, got " + name.shown());
        continue;
      }
      const std::string path = join(shown, name.text);
      if (const auto [first, fresh] = seen.try_emplace(name.text, i); !fresh) {
        report(name.place(), path,
               "given twice, first at " + node.keys[first->second].place() + "; remove one");
        continue;
      }
      // A path in one word counts too: solver.iterations beside solver: {iterations: ...}.
      const auto [before, fresh] = out_.places.try_emplace(path, node.items[i].place());
      if (!fresh) {
        report(name.place(), path, "given twice, first at " + before->second + "; remove one");
        continue;
      }
      read_entry(block, path, name, node.items[i], holder, kind);
    }
    require(block, shown, seen, kind);
  }

  void read_entry(const Block& in, const std::string& path, const Node& name, const Node& value,
                  const Object& holder, unsigned kind) {
    const std::string table = join(in.path, name.text);
    if (const Block* list = table_.find_block(table + "[]")) return read_list(*list, value);
    const Block* block = table_.find_block(table);
    if (block != nullptr && !block->list) return read_child(*block, path, value, holder);
    const Key* key = table_.find_key(table);
    if (key == nullptr) {
      if (const Key* now = table_.find_renamed(table))
        return report(name.place(), path, "is called " + now->path + " now; rename it");
      // Box of an entry of unknown kind: only the kind is reported.
      if (kind == 0 && name.text == "size" && std::ranges::any_of(in.keys, &Key::by_center)) return;
      std::string what = "unknown key";
      if (!problems_.full()) what += slip(name, value);
      if (!problems_.full() && what == "unknown key") what += suggestion(in, path, name);
      // The name may be any text: keep it short and on one line.
      std::string clean = name.shown();
      clean = clean.substr(1, clean.size() - 2);
      const std::string parent = path.substr(0, path.size() - name.text.size());
      return report(name.place(), parent + clean, what);
    }
    // A path in one word reaches only into blocks that are present.
    if (const Block& own = *key->block; &own != &in && (own.list || !own.is_present(object_)))
      return report(name.place(), path,
                    "belongs into " +
                        (own.list ? "an entry of " + own.leaf() : "the block " + own.path) +
                        "; write it there");
    if (kind != 0 && !(key->kinds & kind)) {
      const std::string leaf = in.kind->leaf();
      return report(name.place(), path,
                    "belongs to " + leaf + " " + in.kind->kinds_text(key->kinds) + ", this " +
                        (in.list ? in.list->entry_name : in.leaf()) + " is a " +
                        in.kind->kinds_text(kind) + "; remove it or change the " + leaf);
    }
    const std::string problem = read_field(*key, value, key->field(holder));
    if (!problem.empty()) report(value.place(), path, problem);
  }

  /// Recognizes slips in braces: {cfm: 1,5}, {step:0.002} and {step 0.002}.
  static std::string slip(const Node& name, const Node& value) {
    if (value.kind == Node::Kind::null && !name.text.empty() &&
        name.text.find_first_not_of("0123456789") == std::string::npos)
      return "; decimals take a point, a comma begins the next key";
    const std::string space = missing_space(name.text);
    return space.empty() ? missing_colon(name.text) : space;
  }

  /// ", did you mean bodies[1].max?", with further advice; empty if nothing is near.
  std::string suggestion(const Block& in, const std::string& path, const Node& name) const {
    Suggestion found = suggest_key(table_, join(in.path, name.text));
    for (std::string& key : found.keys)
      if (!in.path.empty() && key.rfind(in.path + ".", 0) == 0)  // put the index of the entry back
        key = path.substr(0, path.size() - name.text.size() - 1) + key.substr(in.path.size());
    std::string text;
    if (!found.keys.empty()) text = ", did you mean " + joined(found.keys, " or ") + "?";
    if (!found.note.empty()) text += (text.empty() ? "; " : " ") + found.note;
    return text;
  }

  void read_child(const Block& block, const std::string& path, const Node& value,
                  const Object& holder) {
    if (value.kind == Node::Kind::map) {
      block.resize(holder, 1);
      return read_block(block, path, value, holder, read_kind(block, path, value, holder));
    }
    if (block.optional && (turns_on(value) || turns_off(value))) {
      block.resize(holder, turns_on(value));
      if (turns_on(value)) require(block, path, {}, block.kind ? 0u : ~0u);
      return;
    }
    std::string what = "expected a block {" +
                       (block.keys.empty() ? "" : block.keys[0]->leaf() + ": ") + "...}, got " +
                       value.shown();
    if (value.kind == Node::Kind::scalar) what += missing_space(value.text);
    std::string inside = in_block(block, value);
    if (inside.empty()) inside = file_in_block(block, value);
    if (!inside.empty()) what += "; write " + inside;
    if (block.optional)
      what += table_.has_required(block) ? "; write off for off"
                                         : "; write {} or on for on with the defaults, off for off";
    if (value.kind == Node::Kind::null && value.line >= 0)
      what += "; its keys stand below it, indented by two spaces";
    report(value.place(), path, what);
  }

  /// "viscosity: {xsph: 0.1} (Factor c; ...)" for a number instead of an optional block whose first
  /// key is its strength; otherwise empty.
  std::string in_block(const Block& block, const Node& value) const {
    double number = 0;
    if (!block.optional || table_.has_required(block) || block.keys.empty() ||
        value.kind != Node::Kind::scalar || value.quoted ||
        read_number(value.text, number) != NumberError::none)
      return "";
    const Key& first = *block.keys[0];
    if (!is_numeric(first.field(first.standard)) || !in_range(first, number)) return "";
    return block.leaf() + ": {" + first.leaf() + ": " + value.text + "} (" +
           first.help.substr(0, first.help.find_last_not_of('.') + 1) + ")";
  }

  /// "motion: {kind: file, path: gate.csv}" for a file name instead of a block that can name a
  /// file, "motion: {kind: sine, ...}" for a word of its kinds; otherwise empty.
  static std::string file_in_block(const Block& block, const Node& value) {
    if (block.kind == nullptr || value.kind != Node::Kind::scalar) return "";
    if (const std::string kind = nearest_choice(value.text, block.kind->choices); !kind.empty())
      return block.leaf() + ": {" + block.kind->leaf() + ": " + kind + ", ...}";
    if (!value.text.ends_with(".csv")) return "";
    for (const Key* key : block.keys)
      if (key->names_file)
        return block.leaf() + ": {" + block.kind->leaf() + ": " +
               block.kind->kinds_text(key->kinds) + ", " + key->leaf() + ": " + value.text + "}";
    return "";
  }

  void read_list(const Block& block, const Node& value) {
    const List& list = *block.list;
    if (value.kind != Node::Kind::list || value.items.size() < least_entries(list, *root_))
      return report(value.place(), block.leaf(),
                    "expected a list of " + least_text(block) + ", e.g. - " + list.example +
                        "; got " + value.shown());
    block.resize(object_, value.items.size());
    for (std::size_t i = 0; i < value.items.size(); ++i) {
      const Node& item = value.items[i];
      const std::string shown = block.entry_path(i);
      out_.places[shown] = item.place();
      const Object entry = block.entry(object_, i);
      if (item.kind == Node::Kind::map)
        read_block(block, shown, item, entry, read_kind(block, shown, item, entry));
      else
        report(
            item.place(), shown,
            "expected a " + list.entry_name + " such as " + list.example + ", got " + item.shown());
    }
  }

  /// As Block::kind_of(), or 0 if the word is missing or wrong (reported with the other keys). Read
  /// first, because it decides which other keys there are.
  unsigned read_kind(const Block& block, const std::string& shown, const Node& node,
                     const Object& entry) {
    if (const Key* kind = block.kind) {
      const Node* word = node.find(kind->leaf());
      if (word == nullptr || !read_field(*kind, *word, kind->field(entry)).empty()) {
        out_.bad.insert(join(shown, kind->leaf()));
        return 0;
      }
    }
    return block.kind_of(entry);
  }

  /// Whether `in` (inside `around`) is on but not mentioned: its required keys are missing.
  bool is_on_unseen(const Block& in, const Block& around,
                    const std::map<std::string, std::size_t>& seen) const {
    if (in.parent == nullptr || in.list_around()) return false;  // absent unless mentioned
    const bool inside =
        in.parent == &around ? !seen.count(in.leaf()) : is_on_unseen(*in.parent, around, seen);
    return inside && in.size(object_) > 0;
  }

  void require(const Block& block, const std::string& shown,
               const std::map<std::string, std::size_t>& seen, unsigned kind) {
    const std::string place = out_.places[shown];
    for (const Key& key : table_.keys) {
      const Block& in = *key.block;
      const bool direct = &in == &block;
      if (!key.required || (direct && seen.count(key.leaf()))) continue;
      if (!direct && !is_on_unseen(in, block, seen)) continue;
      if (!key.is_kind && !(key.kinds & kind)) continue;
      const std::string range = range_text(key), unit = unit_text(key);
      std::string what = "missing; required";
      if (!unit.empty()) what += ", in " + unit;
      if (!key.choices.empty()) what += ": " + range;
      report(place, direct ? join(shown, key.leaf()) : key.path, what + " (" + key.help + ")");
    }
    for (const Block& child : table_.blocks)
      if (child.list && least_entries(*child.list, *root_) > 0 && child.parent == &block &&
          !seen.count(child.leaf()))
        report(place, child.leaf(), "missing; required, a list of " + least_text(child));
  }

  const KeyTable& table_;
  const Object& object_;
  Problems& problems_;
  const Node* root_ = nullptr;
  KeyPlaces out_;
};

}  // namespace

std::string KeyPlaces::place(const std::string& key) const {
  const auto it = places.find(key);
  return it != places.end() ? it->second : place(around(key));
}

bool KeyPlaces::good(std::initializer_list<std::string> keys) const {
  return std::none_of(keys.begin(), keys.end(), [this](const std::string& key) {
    std::string path = key;
    while (!path.empty() && !bad.count(path)) path = around(path);
    return !path.empty();
  });
}

KeyPlaces read_tree(const KeyTable& table, const Node& root, const Object& object,
                    Problems& problems) {
  return Validator(table, object, problems).run(root);
}

}  // namespace pbf::scene_module
