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
#include <utility>
#include <variant>
#include <vector>

#include "lib/scene/kinds.h"
#include "lib/scene/scene.h"

namespace pbf::scene_module {

/// Pointer to a struct whose members are keys: the scene, or an entry of one of its lists.
using Object = std::any;
/// Accessors of the table serve for reading and writing. A function that takes an Object only reads
/// it, unless its comment says otherwise.
template <class T>
Object object(const T& holder) {
  return const_cast<T*>(&holder);
}

/// A field that is one word of Key::choices; get and set use its index.
struct ChoiceField {
  const void* address;
  std::function<int()> get;
  std::function<void(int)> set;
  operator const void*() const { return address; }  ///< of the member, as for other fields
};

/// Pointer or accessor to a key's value in an Object.
using Field = std::variant<double*, std::optional<double>*, int*, std::int64_t*, std::uint64_t*,
                           bool*, std::string*, std::vector<std::string>*, std::vector<double>*,
                           Double3*, std::optional<Double3>*, std::optional<std::array<double, 2>>*,
                           std::array<int, 2>*, ChoiceField>;

/// Whether the results of a run up to its end depend on a key, so that --resume refuses a change.
/// In increasing order.
enum class Effect {
  none,      ///< they do not
  adaptive,  ///< only with time.adaptive
  results,   ///< they do
};

struct Block;
struct KeyTable;

/// A struct of a scene that holds the keys of a block, and its path: "obstacles[1].motion".
struct Holder {
  Object object;
  std::string path;
};

struct Key {
  std::string path;  ///< "fluid.spacing"; in the entries of a list "bodies[].min"
  std::string help;  ///< one or two sentences without unit, range and default
  std::function<Field(const Object&)> field;
  std::string unit{};  ///< "m"; empty: not a number, or dimensionless (texts show "1")
  Range range{};
  std::size_t most = 0;                ///< largest length of a list of numbers; 0: no such list
  std::vector<std::string> choices{};  ///< allowed words, or elements of a list; empty: any
  bool required = false;
  bool automatic = false;  ///< `auto` is allowed: an absent optional, or 0 of a plain number
  bool is_kind = false;    ///< its word decides which other keys a block or an entry has
  unsigned kinds = ~0u;    ///< bit 1 << index of every kind that has this key
  FlatY flat = FlatY::none;
  unsigned in_plane = 0;    ///< bits as in `kinds`: for these kinds y is that of the plane
  bool by_center = false;   ///< a corner of a box, which center and size may give as well
  bool names_file = false;  ///< the path of a file, relative to the folder of the scene file
  /// Table of the mapping that may replace the value (as may then a single number); null: none.
  const KeyTable& (*form)() = nullptr;
  std::string was{};  ///< path in earlier versions; empty: the same
  /// The value with the same effect per time if the step is 2^-level as long; null: unchanged.
  double (*at_level)(double value, int level) = nullptr;
  Effect effect = Effect::results;  ///< at most that of its block
  /// Why the key's numbers are not rounded at random. By default (null here and in the block) they
  /// are, for the ensemble of `pbf compare`, as a solver of lower precision rounds them once.
  const char* exact = nullptr;
  /// Text on pages instead of the default, for a scene file without the key; null: the default.
  const char* usually = nullptr;
  /// The value that turns the feature off, which is not rounded; NaN: none, but 0 stays 0.
  double off = std::numeric_limits<double>::quiet_NaN();
  // Set by the table:
  const Block* block = nullptr;
  Object standard{};  ///< an object with its default

  std::string leaf() const;  ///< "spacing"
  /// For a kind: the words of these bits, "block, random_box".
  std::string kinds_text(unsigned kinds) const;
};

/// A list of structs, each a mapping in the scene file.
struct List {
  std::string entry_name{};  ///< "body", for messages
  std::size_t least = 0;     ///< fewest entries
  std::string unless{};   ///< a list that may stand in for these: with entries of it none is needed
  std::string remark{};   ///< further remark in the reference
  std::string example{};  ///< an entry, for messages
  std::string further{};  ///< a second entry in the reference scene; empty: none
  std::function<const void*(const Object&)> address{};  ///< of the member
  Object standard{};  ///< an entry with all defaults and with every block

  std::string least_text() const;  ///< "at least one", "at least 2"
};

/// A mapping in the scene file: always present, optional, or a list of mappings. Its keys are in
/// size() structs; unless it is a list, in the object of its parent. An optional block in the
/// entries of a list ("obstacles[].motion") has the entry as its object.
struct Block {
  std::string path;  ///< "solver", "render.camera"; "bodies[]" stands for one entry of the list
  std::string help;
  std::function<std::size_t(const Object&)> size = [](const Object&) { return 1; };
  /// List: sets the number of entries, all defaults. Otherwise 1 adds the block if it is absent.
  std::function<void(const Object&, std::size_t)> resize = [](const Object&, std::size_t) {};
  std::function<Object(const Object&, std::size_t)> entry = [](const Object& o, auto) { return o; };
  bool optional = false;  ///< absent or `off`: the feature is off; {} or `on`: on, all defaults
  bool on_by_default = false;  ///< optional, but on if the scene does not mention it
  Effect effect = Effect::results;
  const char* exact = nullptr;  ///< for all its keys, and for blocks in it
  std::optional<List> list{};
  // Set by the table:
  const Block* parent = nullptr;  ///< null at the top level
  std::vector<const Key*> keys{};
  const Key* kind = nullptr;  ///< decides which keys it, or an entry, has; null: all

  std::string leaf() const;                     ///< "camera", "bodies"
  std::string entry_path(std::size_t i) const;  ///< "bodies[1]"; the path if it is no list
  const Block* list_around() const;             ///< this list, or the one it is in; null: none
  /// Whether it and its parents are on. True for lists, false in entries (see holders()).
  bool is_present(const Object& object) const;
  std::vector<Holder> holders(const Object& object) const;  ///< that are present
  unsigned kind_of(const Object& holder) const;  ///< its bit in Key::kinds; all bits without kinds
};

/// Related rows, in the order of the reference scene; a block precedes its children.
struct KeyRows {
  std::vector<Block> blocks;
  std::vector<Key> keys;
};

/// All keys and blocks of a struct. The top level is block "", which has a row too.
struct KeyTable : KeyRows {
  /// `defaults`: of the struct, kept by the caller; all its optional blocks are made present.
  KeyTable(const std::vector<KeyRows>& parts, const Object& defaults);
  KeyTable(const KeyTable&) = delete;
  KeyTable& operator=(const KeyTable&) = delete;

  const Key* find_key(const std::string& path) const;
  /// The key that had this path in earlier versions; null if there is none.
  const Key* find_renamed(const std::string& path) const;
  const Block* find_block(const std::string& path) const;
  /// Whether the block cannot be empty when it is on: a list needs entries, another block needs a
  /// key of its own or of a block in it.
  bool has_required(const Block& block) const;
  /// Whether its parent is incomplete without it.
  bool is_required(const Block& block) const;
  void make_all_present(const Object& object) const;
  /// Paths of all members of the object by their addresses, with those in lists.
  std::map<const void*, std::string> names(const Object& object) const;
};

/// The table of Scene.
const KeyTable& scene_table();

/// "m" or "1"; empty for words and text.
std::string unit_text(const Key& key);
/// "> 0 .. 1.0e+09", "consistent | paper"; empty without limits.
std::string range_text(const Key& key);
/// A bound of the key's range, in plain digits if the key is a whole number.
std::string bound_text(const Key& key, double bound);
/// YAML text of the key's value in the object that holds it.
std::string value_text(const Key& key, const Object& holder);
/// The default for pages, "0.02" or "the name of the scene file". Not for a required key.
std::string default_text(const Key& key);
/// "fluid", "spacing" -> "fluid.spacing"; at the top level just the leaf.
std::string join(const std::string& block, const std::string& leaf);
/// The two parts of such a path.
std::string block_of(const std::string& path);
std::string leaf_of(const std::string& path);

// The functions of load.h and difference.h, for any struct with a table of keys.

/// `comments`: as in the reference scene.
std::string yaml_of(const KeyTable& table, const Object& object, bool comments);
/// JSON Schema of the struct's mapping, without the document around it.
std::string schema_of(const KeyTable& table);
/// "solver.iterations: 4 before, 8 now" for each difference. Ignores keys and blocks with less
/// effect than `least`, and the keys of a block that only one of the objects has. `sides`: words
/// for the two objects.
std::vector<std::string> differences(const KeyTable& table, const Object& before, const Object& now,
                                     Effect least,
                                     std::pair<const char*, const char*> sides = {"before", "now"});

}  // namespace pbf::scene_module
