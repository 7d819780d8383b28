#include "lib/scene/validate.h"

#include <algorithm>

#include "lib/scene/keys.h"
#include "lib/scene/value.h"

namespace pbf::inline scene_module {
namespace {

std::string join(const std::string& block, const std::string& leaf) {
  return block.empty() ? leaf : block + "." + leaf;
}

/// `off` anywhere; null from the command line only: in a file it is a block whose keys were
/// forgotten or commented out.
bool turns_off(const Node& node) {
  if (node.kind == Node::Kind::null) return node.line < 0;
  return node.kind == Node::Kind::scalar && !node.quoted &&
         (node.text == "off" || node.text == "false");
}

bool turns_on(const Node& node) {
  return node.kind == Node::Kind::scalar && !node.quoted &&
         (node.text == "on" || node.text == "true");
}

/// A key of the block, to show what one looks like.
std::string example_of(const std::string& block) {
  for (const Key& key : scene_keys())
    if (key.block() == block) return key.leaf() + ": ...";
  return "...";
}

std::string shapes_text(unsigned mask) {
  std::string text;
  for (std::size_t s = 0; s < shape_names().size(); ++s)
    if (mask & (1u << s)) text += (text.empty() ? "" : ", ") + shape_names()[s];
  return text;
}

class Validator {
 public:
  explicit Validator(Problems& problems) : problems_(problems) {}

  PlacedScene run(const Node& root) {
    out_.places[""] = root.place();
    if (root.kind == Node::Kind::map)
      read_block("", "", root, nullptr);
    else
      report(root.place(), "",
             "expected a scene: keys such as domain, fluid, bodies; got " + root.shown());
    return std::move(out_);
  }

 private:
  void report(const std::string& place, const std::string& key, const std::string& what) {
    problems_.add(place, key, what);
    out_.bad.insert(key);
  }

  /// Reads a map as block `table` ("bodies[]") called `shown` ("bodies[0]").
  void read_block(const std::string& table, const std::string& shown, const Node& node,
                  Body* body) {
    const unsigned shape = body != nullptr ? read_shape(shown, node, *body) : 0;
    std::map<std::string, std::size_t> seen;  // every key and which of the node's it is first
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
      // Also as a path in one word: solver.iterations beside solver: {iterations: ...}.
      const auto [before, fresh] = out_.places.try_emplace(path, node.items[i].place());
      if (!fresh) {
        report(name.place(), path, "given twice, first at " + before->second + "; remove one");
        continue;
      }
      read_entry(join(table, name.text), path, name, node.items[i], body, shape);
    }
    require(table, shown, seen, body, shape);
  }

  void read_entry(const std::string& table, const std::string& path, const Node& name,
                  const Node& value, Body* body, unsigned shape) {
    if (table == "bodies") return read_bodies(value);
    if (const Block* block = table == "bodies[]" ? nullptr : find_block(table))
      return read_child(*block, path, value);
    const Key* key = find_key(table);
    if (key == nullptr) {
      if (const Key* now = find_renamed(table))
        return report(name.place(), path, "is called " + now->path + " now; rename it");
      std::string what = "unknown key";
      std::string near = problems_.full() ? "" : nearest_path(table);
      const std::size_t list = near.find("[]");
      if (list != std::string::npos && body != nullptr)  // say which body, as the path does
        near = path.substr(0, path.find('.')) + near.substr(list + 2);
      if (!near.empty()) what += ", did you mean " + near + "?";
      // The name may be anything: no line breaks in a message, no page of text.
      std::string clean = name.shown();
      clean = clean.substr(1, clean.size() - 2);
      const std::string parent = path.substr(0, path.size() - name.text.size());
      return report(name.place(), parent + clean, what);
    }
    if (body != nullptr && shape != 0 && !(key->shapes & shape))
      return report(name.place(), path,
                    "belongs to shape " + shapes_text(key->shapes) + ", this body is a " +
                        shapes_text(shape) + "; remove it or change the shape");
    Body none;
    const std::string problem =
        read_field(*key, value, key->field(out_.scene, body != nullptr ? *body : none));
    if (!problem.empty()) report(value.place(), path, problem);
  }

  void read_child(const Block& block, const std::string& path, const Node& value) {
    if (value.kind == Node::Kind::map) {
      block.set_present(out_.scene, true);
      return read_block(block.path, path, value, nullptr);
    }
    if (block.optional && (turns_on(value) || turns_off(value)))
      return block.set_present(out_.scene, turns_on(value));
    std::string what = "expected a block {" + example_of(block.path) + "}, got " + value.shown();
    if (block.optional) what += "; write {} or on for on with the defaults, off for off";
    report(value.place(), path, what);
  }

  void read_bodies(const Node& value) {
    if (value.kind != Node::Kind::list || value.items.empty())
      return report(value.place(), "bodies",
                    "expected a list of at least one body, e.g. - {shape: block, min: [0, 0, 0], "
                    "max: [1, 1, 1]}; got " +
                        value.shown());
    out_.scene.bodies.assign(value.items.size(), Body{});
    for (std::size_t i = 0; i < value.items.size(); ++i) {
      const Node& item = value.items[i];
      const std::string shown = "bodies[" + std::to_string(i) + "]";
      out_.places[shown] = item.place();
      if (item.kind == Node::Kind::map)
        read_block("bodies[]", shown, item, &out_.scene.bodies[i]);
      else
        report(item.place(), shown,
               "expected a body such as {shape: block, min: [0, 0, 0], max: "
               "[1, 1, 1]}, got " +
                   item.shown());
    }
  }

  /// Bit of the body's shape, or 0 when it is missing or wrong (reported with the other keys). Read
  /// before them, for it decides which they are.
  unsigned read_shape(const std::string& shown, const Node& node, Body& body) {
    const Node* shape = const_cast<Node&>(node).find("shape");
    const Key& key = *find_key("bodies[].shape");
    if (shape == nullptr || !read_field(key, *shape, key.field(out_.scene, body)).empty()) {
      out_.bad.insert(shown + ".shape");
      return 0;
    }
    return 1u << static_cast<unsigned>(body.shape);
  }

  void require(const std::string& table, const std::string& shown,
               const std::map<std::string, std::size_t>& seen, const Body* body, unsigned shape) {
    const std::string place = out_.places[shown];
    for (const Key& key : scene_keys()) {
      const std::string in = key.block();
      const std::string leaf = key.leaf();
      const bool direct = in == table;
      // A required block that is absent altogether: each of its required keys is missing.
      const bool below = table.empty() && !in.empty() && in != "bodies[]" && !seen.count(in);
      if (!key.required || (!direct && !below) || (direct && seen.count(leaf))) continue;
      if (body != nullptr && leaf != "shape" && !(key.shapes & shape)) continue;
      const std::string range = range_text(key), unit = unit_text(key);
      std::string what = "missing; required";
      if (!unit.empty()) what += ", in " + unit;
      if (!key.choices.empty()) what += ": " + range;
      report(place, direct ? join(shown, leaf) : key.path, what + " (" + key.help + ")");
    }
    if (table.empty() && !seen.count("bodies"))
      report(place, "bodies", "missing; required, a list of at least one body");
  }

  Problems& problems_;
  PlacedScene out_;
};

}  // namespace

std::string PlacedScene::place(const std::string& key) const {
  for (std::string path = key;;) {
    const auto it = places.find(path);
    if (it != places.end()) return it->second;
    const std::size_t end = path.find_last_of(".[");
    path = end == std::string::npos ? "" : path.substr(0, end);
  }
}

bool PlacedScene::good(std::initializer_list<std::string> keys) const {
  return std::none_of(keys.begin(), keys.end(), [this](const std::string& key) {
    for (std::string path = key; !path.empty();) {
      if (bad.count(path)) return true;
      const std::size_t end = path.find_last_of(".[");
      path = end == std::string::npos ? "" : path.substr(0, end);
    }
    return false;
  });
}

PlacedScene validate(const Node& root, Problems& problems) { return Validator(problems).run(root); }

}  // namespace pbf::inline scene_module
