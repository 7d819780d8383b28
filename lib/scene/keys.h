// The table of keys of a scene file. Validation, --set, the reference scene, the resolved scene,
// the JSON Schema, --resume and shorter time steps all use this one table.
#pragma once

#include <any>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "lib/scene/key_traits.h"
#include "lib/scene/scene.h"

namespace pbf::inline scene_module {

/// A struct whose members are keys, by pointer: the scene, or an entry of one of its lists.
using Object = std::any;
/// The accessors of the table are written once, for reading and writing; what takes an Object and
/// does not say that it changes it reads only.
template <class T>
Object object(const T& holder) {
  return const_cast<T*>(&holder);
}

/// A field that is one word of Key::choices; get and set speak of its index.
struct ChoiceField {
  const void* address;
  std::function<int()> get;
  std::function<void(int)> set;
  operator const void*() const { return address; }  ///< of the member, as of the other fields
};

/// Where a key's value lives in an Object.
using Field = std::variant<double*, std::optional<double>*, int*, std::int64_t*, std::uint64_t*,
                           bool*, std::string*, std::vector<std::string>*, std::vector<double>*,
                           Double3*, std::optional<Double3>*, std::optional<std::array<double, 2>>*,
                           std::array<int, 2>*, ChoiceField>;

/// Whether a change leaves the results of a run alone up to its end, so that --resume takes it.
/// In order: what is more than another counts where that counts.
enum class Effect {
  none,      ///< it does
  adaptive,  ///< it does without time.adaptive
  results,   ///< it does not
};

struct Block;
struct KeyTable;

/// A struct of a scene that has the keys of a block, and its path: "obstacles[1].motion".
struct Holder {
  Object object;
  std::string path;
};

struct Key {
  std::string path;  ///< "fluid.spacing"; of a list's entries "bodies[].min"
  std::string help;  ///< one sentence or two, without unit, range and default
  std::function<Field(const Object&)> field;
  std::string unit{};  ///< "m"; empty: not a number, or dimensionless ("1" is written for those)
  Range range{};
  std::size_t most = 0;                ///< numbers of a list that holds one or more
  std::vector<std::string> choices{};  ///< words allowed (ChoiceField), or elements of a list
  bool required = false;
  bool automatic = false;  ///< `auto` is allowed: an absent optional, or 0 of a plain number
  bool is_kind = false;    ///< the word that decides which other keys a block or an entry has
  unsigned kinds = ~0u;    ///< bit 1 << index of every kind that has this key
  FlatY flat = FlatY::none;
  unsigned in_plane = 0;    ///< bits as of `kinds`: of these kinds y is that of the plane
  bool by_center = false;   ///< a corner of a box that center and size may give as well
  bool names_file = false;  ///< a path, from the folder of the scene file
  /// The table of a mapping in whose place it may be given, or of one number; null: none.
  const KeyTable& (*form)() = nullptr;
  std::string was{};  ///< its path in earlier versions; empty: the same
  /// What becomes of it where the step is 2^-level as long, for the same effect per time; null: it
  /// stays.
  double (*at_level)(double value, int level) = nullptr;
  Effect effect = Effect::results;  ///< no more than its block's
  /// Numbers on which results depend are rounded at random for the ensemble of `pbf compare`, as a
  /// solver of lower precision rounds them once. Why this one is not; null: it is. Or its block's.
  const char* exact = nullptr;
  /// What pages say in place of the default of a scene without a file; null: that default.
  const char* usually = nullptr;
  /// The value that turns it off, which is not rounded; none: 0 stays 0.
  double off = std::numeric_limits<double>::quiet_NaN();
  // From the table:
  const Block* block = nullptr;
  Object standard{};  ///< where it has its default

  std::string leaf() const;  ///< "spacing"
  /// Of a kind: the words that the bits stand for, "block, random_box".
  std::string kinds_text(unsigned kinds) const;
};

/// A list of structs, each a mapping in the scene file.
struct List {
  std::string entry_name{};  ///< "body", for messages
  std::size_t least = 0;     ///< fewest entries
  std::string remark{};      ///< what else the reference says of the list
  std::string example{};     ///< an entry, for messages
  std::string further{};     ///< one that the reference shows besides those it has; empty: none
  std::function<const void*(const Object&)> address{};  ///< of the member
  Object standard{};  ///< an entry with all defaults, and every block in it

  std::string least_text() const;  ///< "at least one", "at least 2"
};

/// A mapping in the scene file that is always there, that may be absent, or a list of them: n
/// structs that have its keys, of which the first two are the object around them itself. One in a
/// list's entries ("obstacles[].motion") may be absent; its object is the entry.
struct Block {
  std::string path;  ///< "solver", "render.camera"; "bodies[]" stands for one entry of the list
  std::string help;
  std::function<std::size_t(const Object&)> size = [](const Object&) { return 1; };
  /// Of a list: so many entries, all defaults. Of others: 1 leaves what is there as it is.
  std::function<void(const Object&, std::size_t)> resize = [](const Object&, std::size_t) {};
  std::function<Object(const Object&, std::size_t)> entry = [](const Object& o, auto) { return o; };
  bool optional = false;  ///< absent or `off`: the feature is off; {} or `on`: on, all defaults
  bool on_by_default = false;  ///< optional, but on where the scene does not mention it
  Effect effect = Effect::results;
  const char* exact = nullptr;  ///< of all its keys, and of blocks in it
  std::optional<List> list{};
  // From the table:
  const Block* parent = nullptr;  ///< of the top level null
  std::vector<const Key*> keys{};
  const Key* kind = nullptr;  ///< decides which keys it, or an entry of it, has; null: all

  std::string leaf() const;                     ///< "camera", "bodies"
  std::string entry_path(std::size_t i) const;  ///< "bodies[1]"; without a list the path
  const Block* list_around() const;             ///< the list that it is, or is in; null: none
  /// With those around it; lists are, and what is in their entries is not: holders() has it.
  bool is_present(const Object& object) const;
  std::vector<Holder> holders(const Object& object) const;  ///< that are there
  unsigned kind_of(const Object& holder) const;  ///< its bit in Key::kinds; without kinds all
};

/// Rows that belong together, in the order of the reference scene, a block before its children.
struct KeyRows {
  std::vector<Block> blocks;
  std::vector<Key> keys;
};

/// All keys and blocks of a struct. The top level is block "", which is a row too.
struct KeyTable : KeyRows {
  /// `defaults`: of the struct, kept by the caller; every optional block of it is made present.
  KeyTable(const std::vector<KeyRows>& parts, const Object& defaults);
  KeyTable(const KeyTable&) = delete;
  KeyTable& operator=(const KeyTable&) = delete;

  const Key* find_key(const std::string& path) const;
  /// The key that had this path in earlier versions, or null.
  const Key* find_renamed(const std::string& path) const;
  const Block* find_block(const std::string& path) const;
  /// Whether the block must say something where it is on: a list entries, another block a key of
  /// its own or of a block in it.
  bool has_required(const Block& block) const;
  /// Whether what is around it must have it: nothing is complete without.
  bool is_required(const Block& block) const;
  void make_all_present(const Object& object) const;
  /// Paths of all members that the object has by their addresses, and those of its lists.
  std::map<const void*, std::string> names(const Object& object) const;
};

/// That of a Scene.
const KeyTable& scene_table();

/// "m" or "1"; empty for words and text.
std::string unit_text(const Key& key);
/// "> 0 .. 1.0e+09", "consistent | paper"; empty when anything goes.
std::string range_text(const Key& key);
/// An end of the key's range, in plain digits where the key is a whole number.
std::string bound_text(const Key& key, double bound);
/// YAML text of the key's value in the object that holds it.
std::string value_text(const Key& key, const Object& holder);
/// The default for pages, "0.02" or "the name of the scene file". Not of a required key.
std::string default_text(const Key& key);
/// "fluid", "spacing" -> "fluid.spacing"; of the top level the leaf.
std::string join(const std::string& block, const std::string& leaf);

// What load.h and difference.h do for scenes, for any struct with a table of keys.

/// `comments`: as in the reference scene.
std::string yaml_of(const KeyTable& table, const Object& object, bool comments);
/// JSON Schema of the struct's mapping, without the document around it.
std::string schema_of(const KeyTable& table);
/// "solver.iterations: 4 before, 8 now" for each; keys and blocks with less effect than `least` are
/// not looked at, nor are the keys of a block that is only in one of both.
std::vector<std::string> differences(const KeyTable& table, const Object& before, const Object& now,
                                     Effect least);

}  // namespace pbf::inline scene_module
