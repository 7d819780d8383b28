// The table of keys of a scene file. One table drives validation, --set, the reference scene, the
// resolved scene and the JSON Schema.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "lib/scene/scene.h"

namespace pbf::inline scene_module {

/// A field that is one word of Key::choices; get and set speak of its index.
struct ChoiceField {
  std::function<int()> get;
  std::function<void(int)> set;
};

/// Where a key's value lives in a Scene or Body.
using Field =
    std::variant<double*, std::optional<double>*, int*, std::int64_t*, std::uint64_t*, bool*,
                 std::string*, std::vector<std::string>*, Double3*, std::optional<Double3>*,
                 std::optional<std::array<double, 2>>*, std::array<int, 2>*, ChoiceField>;

/// Allowed values of every number of a key.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool above_min = false;  ///< min itself is not allowed
  bool below_max = false;  ///< max itself is not allowed
};

struct Key {
  std::string path;  ///< "fluid.spacing"; of a body "bodies[].min"
  std::string help;  ///< one sentence or two, without unit, range and default
  std::string unit;  ///< "m"; empty: not a number, or dimensionless ("1" is written for those)
  Range range;
  std::vector<std::string> choices;  ///< words allowed (ChoiceField), or elements (lists of words)
  bool required = false;
  bool automatic = false;  ///< `auto` is allowed: an absent optional, or 0 of a plain number
  unsigned shapes = 0;     ///< bodies: bit 1 << Shape of every shape that has this key
  std::function<Field(Scene&, Body&)> field;
  std::string was{};  ///< its path in earlier versions; empty: the same

  std::string block() const;  ///< "fluid", "" for the top level, "bodies[]"
  std::string leaf() const;   ///< "spacing"
};

/// A mapping in the scene file.
struct Block {
  std::string path;  ///< "solver", "render.camera"; "bodies[]" stands for one entry of the list
  std::string help;
  bool optional = false;  ///< absent or `off`: the feature is off; {} or `on`: on, all defaults
  std::function<bool(const Scene&)> present;
  std::function<void(Scene&, bool)> set_present;
  bool on_by_default = false;  ///< optional, but on where the scene does not mention it
};

/// All keys, in the order of the reference scene. The top level's keys come with block "".
const std::vector<Key>& scene_keys();
/// All blocks, a parent before its children.
const std::vector<Block>& scene_blocks();
/// Names of the shapes, by Shape.
const std::vector<std::string>& shape_names();

const Key* find_key(const std::string& path);
/// The key that had this path in earlier versions, or null.
const Key* find_renamed(const std::string& path);
const Block* find_block(const std::string& path);
/// Whether a block and those that it stands in are there.
bool is_present(const Scene& scene, const std::string& block);

/// Default scene with every optional block present: what defaults are taken from.
Scene scene_with_all_blocks();

/// Nearest path of the table to a misspelt one (of the same body shape list "bodies[]" too), or
/// empty when nothing is near.
std::string nearest_path(const std::string& path);

/// "m" or "1"; empty for words and text.
std::string unit_text(const Key& key);
/// "> 0 .. 1.0e+09", "consistent | paper"; empty when anything goes.
std::string range_text(const Key& key);
/// YAML text of the key's value in a scene or body.
std::string value_text(const Key& key, const Scene& scene, const Body& body);

}  // namespace pbf::inline scene_module
