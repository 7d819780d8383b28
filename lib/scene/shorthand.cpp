#include "lib/scene/shorthand.h"

#include <algorithm>

#include "lib/scene/number.h"
#include "lib/scene/value.h"

namespace pbf::scene_module {
namespace {

double number_at(Node& root, const std::string& path, double otherwise) {
  double found = otherwise;
  visit(root, path, [&](Node& value, Node&) {
    double v = 0;
    if (value.kind == Node::Kind::scalar && read_number(value.text, v) == NumberError::none)
      found = v;
  });
  return found;
}

/// Adds a corner with the place of `like`.
void append(Node& box, const char* corner, const Node& like, const std::vector<double>& numbers) {
  box.append(like.here(Node::Kind::scalar, corner), list_node(like, numbers));
}

/// The entry's bit in Key::kinds; all bits without kinds, none for an unknown word.
unsigned kind_of(Node& entry, const Key& key) {
  const Key* kind = key.block->kind;
  if (kind == nullptr) return ~0u;
  const Node* word = entry.find(kind->leaf());
  if (word == nullptr) return 0;
  const auto it = std::ranges::find(kind->choices, word->text);
  return it == kind->choices.end() ? 0 : 1u << (it - kind->choices.begin());
}
/// Whether the entry is of a kind that has this key.
bool has_key(Node& entry, const Key& key) { return (key.kinds & kind_of(entry, key)) != 0; }

/// The two or three numbers of `node`; empty, with an entry in `problems`, if they are wrong.
std::vector<double> numbers(const Key& like, const Node& node, const std::string& path, bool flat,
                            bool lengths, Problems& problems) {
  Key key = like;
  key.most = 3;
  if (lengths) key.range = {1e-9, 1e12};
  std::vector<double> values;
  std::string problem = read_field(key, node, &values);
  if (problem.empty() && values.size() != 3 && !(flat && values.size() == 2))
    problem = "expected 3 numbers [x, y, z]" + std::string(flat ? ", or [x, z]" : "") + ", got " +
              node.shown();
  if (problem.empty()) return values;
  problems.add(node.place(), path, problem);
  return {};
}

/// Replaces center and size of a box, if given, by min and max.
bool write_out_box(const Key& min, Node& entry, const std::string& path, bool flat,
                   Problems& problems) {
  Node *center = entry.find("center"), *size = entry.find("size");
  if (center == nullptr && size == nullptr) return true;
  for (const char* corner : {"min", "max"})
    if (entry.find(corner) != nullptr) {
      const char* given = size ? "size" : "center";
      problems.add(
          entry.find(given)->place(), path + "." + given,
          std::string("is given beside ") + corner + "; give center and size, or min and max");
      return false;
    }
  if (center == nullptr || size == nullptr) {
    const std::string missing = size ? "center" : "size";
    problems.add(entry.place(), path + "." + missing,
                 "missing; a box is given by center and size, or by min and max, in m");
    return false;
  }
  const std::vector<double> c = numbers(min, *center, path + ".center", flat, false, problems);
  const std::vector<double> s = numbers(min, *size, path + ".size", flat, true, problems);
  if (c.empty() || s.empty()) return false;
  if (c.size() != s.size()) {
    problems.add(size->place(), path + ".size",
                 "has " + std::to_string(s.size()) + " numbers, and center " +
                     std::to_string(c.size()) + "; give both two, or both three");
    return false;
  }
  std::vector<double> low(c), high(c);
  for (std::size_t a = 0; a < c.size(); ++a) low[a] -= 0.5 * s[a], high[a] += 0.5 * s[a];
  const Node at_center = *center, at_size = *size;
  entry.erase("center");
  entry.erase("size");
  append(entry, "min", at_center, low);
  append(entry, "max", at_size, high);
  return true;
}

/// Puts a placeholder in the place of a box that cannot be determined.
void put_any_box(Node& entry) {
  entry.erase("center");
  entry.erase("size");
  for (const char* corner : {"min", "max"})
    if (entry.find(corner) == nullptr) append(entry, corner, entry, {0, 0, 0});
}

}  // namespace

bool is_flat(Node& root) { return number_at(root, "dimensions", 3) == 2; }

Node list_node(const Node& like, const std::vector<double>& numbers) {
  Node list = like.here(Node::Kind::list);
  for (const double v : numbers) list.items.push_back(like.here(Node::Kind::scalar, to_text(v)));
  return list;
}

std::vector<std::string> write_out_boxes(const KeyTable& table, Node& root, Problems& problems) {
  const bool flat = is_flat(root);
  std::vector<std::string> bad;
  for (const Key& key : table.keys) {
    if (!key.by_center || key.leaf() != "min") continue;
    const Block& list = *key.block;
    Node* entries = root.find(list.leaf());
    if (entries == nullptr || entries->kind != Node::Kind::list) continue;
    for (std::size_t i = 0; i < entries->items.size(); ++i) {
      Node& entry = entries->items[i];
      const std::string path = list.entry_path(i);
      if (entry.kind != Node::Kind::map || !has_key(entry, key) ||
          write_out_box(key, entry, path, flat, problems))
        continue;
      put_any_box(entry);
      bad.insert(bad.end(), {path + ".min", path + ".max"});
    }
  }
  return bad;
}

void write_out_plane(const KeyTable& table, Node& root) {
  if (!is_flat(root)) return;
  const double thickness = number_at(root, "fluid.spacing", 1);
  double low = 0, high = thickness;
  // In the order of the table, where the domain comes first.
  for (const Key& key : table.keys) {
    if (key.flat == FlatY::none && !key.in_plane) continue;
    visit(root, key.path, [&](Node& value, Node& entry) {
      if (value.kind != Node::Kind::list || !has_key(entry, key)) return;
      FlatY rule = key.flat;
      if (key.in_plane & kind_of(entry, key)) rule = FlatY::middle;
      if (rule == FlatY::none) return;
      if (value.items.size() == 2) {
        const double y = rule == FlatY::zero                           ? 0
                         : rule == FlatY::low || rule == FlatY::bottom ? low
                         : rule == FlatY::high || rule == FlatY::top   ? high
                                                                       : 0.5 * (low + high);
        value.items.insert(value.items.begin() + 1,
                           value.items[0].here(Node::Kind::scalar, to_text(y)));
      }
      double given = 0;
      if (value.items.size() != 3 || value.items[1].kind != Node::Kind::scalar ||
          read_number(value.items[1].text, given) != NumberError::none)
        return;
      if (rule == FlatY::bottom) low = given, high = given + thickness;
      if (rule == FlatY::top) high = given;
    });
  }
}

std::vector<std::string> write_out(Node& root, Problems& problems) {
  if (root.kind != Node::Kind::map) return {};
  std::vector<std::string> bad = write_out_boxes(scene_table(), root, problems);
  if (!write_out_gravity(root, problems)) {
    root.erase("gravity");
    bad.push_back("gravity");
  }
  write_out_plane(scene_table(), root);
  return bad;
}

}  // namespace pbf::scene_module
