// A scene as YAML: the resolved scene and the documented reference.
#include <fmt/core.h>
#include <algorithm>
#include <sstream>

#include "lib/base/text.h"
#include "lib/scene/base_scene.h"
#include "lib/scene/keys.h"
#include "lib/scene/load.h"

namespace pbf::scene_module {
namespace {

constexpr std::size_t kWidth = 100;

std::string indent_of(const Block& block) {
  const auto depth = std::count(block.path.begin(), block.path.end(), '.') + 1;
  return std::string(block.path.empty() ? 0 : 2 * std::size_t(depth), ' ');
}

/// Comment lines, wrapped.
std::string comment(const std::string& text, const std::string& indent) {
  std::string out, line = indent + "#";
  std::istringstream words(text);
  for (std::string word; words >> word; line += " " + word) {
    if (line.size() + 1 + word.size() <= kWidth) continue;
    out += line + "\n";
    line = indent + "#";
  }
  return out + line + "\n";
}

/// "Help. [unit; range; default x]"
std::string documentation(const Key& key) {
  const std::string unit = unit_text(key), range = range_text(key);
  std::vector<std::string> facts;
  if (const Key* kind = key.block->kind; kind != nullptr && kind != &key)
    facts.push_back("of " + kind->kinds_text(key.kinds));
  if (!unit.empty()) facts.push_back("unit " + unit);
  if (!range.empty()) facts.push_back(range);
  if (unit.empty() && range.empty()) facts.push_back("text");
  facts.push_back(key.required ? "required" : "default " + default_text(key));
  return key.help + " [" + joined(facts, "; ") + "]";
}

class Writer {
 public:
  Writer(const KeyTable& table, const Object& object, bool comments)
      : table_(table), object_(object), comments_(comments) {}

  std::string text() {
    for (const Key& key : table_.keys) {
      if (key.block != block_) enter(*key.block);
      if (block_->list || !block_->is_present(object_)) continue;
      if (!(key.kinds & block_->kind_of(object_))) continue;
      const std::string indent = indent_of(*block_);
      if (comments_) out_ += comment(documentation(key), indent);
      out_ += indent + key.leaf() + ": " + value_text(key, object_) + "\n";
    }
    return out_;
  }

 private:
  void enter(const Block& entry) {
    const bool first = block_ == nullptr;
    block_ = &entry;
    if (!entry.list && entry.list_around()) return;  // written with its entries
    if (comments_ && !first) out_ += "\n";
    if (entry.path.empty()) return;
    if (entry.list) return write_list(entry);
    const std::string leaf = entry.leaf();
    const std::string indent = indent_of(entry).substr(2);
    if (!entry.is_present(object_)) {  // skip children of an absent block
      if (!entry.optional || !entry.parent->is_present(object_)) return;
      if (comments_) {
        out_ += comment(entry.help + how_it_is_off(entry), indent);
        for (const Key* key : entry.keys)
          out_ += comment(key->leaf() + ": " + documentation(*key), indent);
      }
      out_ += indent + leaf + ": off\n";
      return;
    }
    if (comments_) out_ += comment(entry.help + how_it_is_off(entry), indent);
    out_ += indent + leaf + ":\n";
  }

  std::string how_it_is_off(const Block& block) const {
    const std::string off = fmt::format("`{}: off`", block.leaf());
    const bool on_with_defaults = !table_.has_required(block);
    if (!block.optional) return "";
    if (block.on_by_default)
      return (on_with_defaults ? " Optional: on with the defaults without this block; off with "
                               : " Optional: off with ") +
             off + ".";
    return " Optional: without this block, or with " + off +
           (on_with_defaults ? ", it is off; {} or `on` turns it on with the defaults."
                             : ", it is off.");
  }

  void write_list(const Block& block) {
    const List& list = *block.list;
    if (comments_) {
      out_ += comment(block.help + (list.least > 0 ? ", " + list.least_text() : "") +
                          (list.remark.empty() ? "" : "; " + list.remark) + ".",
                      "");
      for (const Key* key : block.keys)
        out_ += comment(key->leaf() + ": " + documentation(*key), "");
      for (const Block& child : table_.blocks)
        if (child.parent == &block) {
          out_ += comment(child.leaf() + ": " + child.help + " [optional]", "");
          for (const Key* key : child.keys)
            out_ += comment(child.leaf() + "." + key->leaf() + ": " + documentation(*key), "");
        }
    }
    const std::size_t size = block.size(object_);
    out_ += block.leaf() + (size == 0 ? ": []\n" : ":\n");
    for (std::size_t i = 0; i < size; ++i) {
      const Object entry = block.entry(object_, i);
      std::string values = values_of(block, entry);
      for (const Block& child : table_.blocks)
        if (child.parent == &block && child.size(entry) > 0)
          values += ", " + child.leaf() + ": {" + values_of(child, entry) + "}";
      out_ += "  - {" + values + "}\n";
    }
    if (comments_ && !list.further.empty()) out_ += "  # - " + list.further + "\n";
  }

  static std::string values_of(const Block& block, const Object& holder) {
    std::vector<std::string> values;
    for (const Key* key : block.keys)
      if (key->kinds & block.kind_of(holder))
        values.push_back(key->leaf() + ": " + value_text(*key, holder));
    return joined(values, ", ");
  }

  const KeyTable& table_;
  const Object& object_;
  bool comments_;
  const Block* block_ = nullptr;
  std::string out_;
};

/// A small dam break with every block except motions, which runs as it is.
Scene example_scene() {
  Scene s = parse_scene(
      "{name: reference, domain: {min: [0, 0, 0], max: [1.6, 0.4, 0.8]}, fluid: {spacing: 0.02}, "
      "bodies: [{shape: block, min: [0, 0, 0], max: [0.4, 0.4, 0.4]}, "
      "{shape: sphere, center: [1.2, 0.2, 0.4], radius: 0.1}, "
      "{shape: random_box, min: [0, 0, 0.6], max: [0.2, 0.4, 0.7], count: 500}], "
      "time: {step: 0.002, end: 1}}",
      "reference", {});
  scene_table().make_all_present(object(s));
  s.tank_motion.reset();  // a fixed tank
  return s;
}

}  // namespace

std::string yaml_of(const KeyTable& table, const Object& object, bool comments) {
  return Writer(table, object, comments).text();
}

std::string resolved_yaml(const Scene& scene) {
  return yaml_of(scene_table(), object(scene), false);
}

std::string reference_yaml() {
  return "# The reference scene: every key with its meaning, unit, range and default. SI units.\n"
         "# Only the keys marked `required` must be there. Try it: pbf run reference.yaml\n"
         "# Any key can be changed from the command line: --set solver.iterations=8,\n"
         "# --set bodies[0].velocity=[1,0,0], --set viscosity=off\n" +
         comment(fmt::format("{}: {} [text; optional]", kBaseKey, kBaseHelp), "") + "\n" +
         yaml_of(scene_table(), object(example_scene()), true);
}

}  // namespace pbf::scene_module
