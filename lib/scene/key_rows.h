// Functions that write the rows of a table of keys. Only the files with rows include this header.
#pragma once

#include <algorithm>
#include <cmath>
#include <tuple>
#include <type_traits>
#include <utility>

#include "lib/scene/keys.h"

namespace pbf::scene_module {

/// The first two arguments of a row, the path of a member and its accessor: MEMBER(Scene,
/// output->every) has the path "output.every".
#define MEMBER(Struct, member) \
#member, +[](const Object& o) -> auto& { return std::any_cast<Struct*>(o)->member; }
/// The same for an entry of a list: MEMBER_OF(bodies, Body, min) is "bodies[].min".
#define MEMBER_OF(list, Struct, member) #list "[]." MEMBER(Struct, member)

/// "a->b" is "a.b" in the file.
std::string path_of(std::string member);

/// The row of a member, by its type. `values`: number(), one_of() (enums, lists of words) or plain.
template <class Member>
Key key(const char* member, Member& (*get)(const Object&), auto values, const char* help,
        auto... traits) {
  Key row{path_of(member), help, [get](const Object& o) -> Field {
            Member& m = get(o);
            if constexpr (std::is_enum_v<Member>)
              return ChoiceField{&m, [&m] { return static_cast<int>(m); },
                                 [&m](int i) { m = static_cast<Member>(i); }};
            else
              return &m;
          }};
  values(row);
  (traits(row), ...);
  return row;
}

inline auto number(const char* unit, Range range) {
  return [=](Key& row) { row.unit = std::string(unit), row.range = range; };
}
/// The words of an enum in its order, or the words that a list may hold.
inline auto one_of(std::vector<std::string> words) {
  return [=](Key& row) { row.choices = words; };
}
/// A switch, text, or a list of names.
inline void plain(Key&) {}
inline void required(Key& row) { row.required = true; }
inline void automatic(Key& row) { row.automatic = true; }
inline void is_kind(Key& row) { row.is_kind = true; }
/// Only entries of these kinds have the key.
auto of(auto... kinds) {
  return [=](Key& row) { row.kinds = ((1u << static_cast<unsigned>(kinds)) | ...); };
}
/// A trait with a value of the row.
template <auto member>
auto trait(auto value) {
  return [=](Key& row) { row.*member = value; };
}
/// With dimensions: 2, the y of a vector that is given by two numbers.
inline auto flat(FlatY y) { return trait<&Key::flat>(y); }
/// A corner of a box, which may also be given by `center` and `size`.
inline void by_center(Key& row) { row.by_center = true; }
/// The path of a file, relative to the scene file.
inline void names_file(Key& row) { row.names_file = true; }
inline auto form(const KeyTable& (*table)()) { return trait<&Key::form>(table); }
inline auto renamed(const char* path) { return trait<&Key::was>(path); }
inline auto scaled(double (*at_level)(double, int)) { return trait<&Key::at_level>(at_level); }
inline double linear(double x, int level) { return std::ldexp(x, -level); }
inline double quadratic(double x, int level) { return std::ldexp(x, -2 * level); }
/// For a factor that each step applies.
inline double root(double x, int level) { return std::pow(x, std::ldexp(1, -level)); }
/// For a key or a block.
inline auto effect(Effect effect) {
  return [=](auto& row) { row.effect = effect; };
}
/// For a key or a block whose numbers are not rounded at random: the reason.
inline auto exact(const char* why) {
  return [=](auto& row) { row.exact = why; };
}
/// The value in a scene file without the key, in words.
inline auto usually(const char* what) { return trait<&Key::usually>(what); }
/// This value turns the feature off, and is not rounded.
inline auto off_at(double value) { return trait<&Key::off>(value); }

/// A block that is a std::optional.
template <class Member>
Block optional_block(const char* member, Member& (*get)(const Object&), const char* help,
                     auto... traits) {
  Block block{path_of(member), help, [get](const Object& o) { return get(o) ? 1 : 0; },
              [get](const Object& o, std::size_t n) {
                auto& m = get(o);
                if (n == 0)
                  m.reset();
                else if (!m)
                  m.emplace();
              }};
  block.optional = true;
  (traits(block), ...);
  return block;
}
inline void on_by_default(Block& block) { block.on_by_default = true; }

/// A block that is a std::vector of structs. `list`: the texts of List.
template <class Entry>
Block list_block(const char* member, std::vector<Entry>& (*get)(const Object&), const char* help,
                 List list, auto... traits) {
  list.address = [get](const Object& o) { return &get(o); };
  static Entry standard{};
  list.standard = object(standard);
  Block block{path_of(member) + "[]", help, [get](const Object& o) { return get(o).size(); },
              [get](const Object& o, std::size_t n) { get(o).assign(n, Entry{}); },
              [get](const Object& o, std::size_t i) { return object(get(o)[i]); }};
  block.list = std::move(list);
  (traits(block), ...);
  return block;
}

// The rows of entries that are of one of several kinds; `held`: the variant (lib/scene/kinds.h).

/// The row of the word that decides which other keys an entry has.
template <class Entry, class Any>
Key kind_row(const char* path, const std::string& help, Any Entry::*held) {
  Key row{path, help, [held](const Object& holder) -> Field {
            Any& kind = std::any_cast<Entry*>(holder)->*held;
            return ChoiceField{address_of_word(kind), [&kind] { return int(kind.index()); },
                               [&kind](int wanted) {
                                 if (wanted == int(kind.index())) return;
                                 int k = 0;
                                 for_each_kind<Any>([&](const auto& keys) {
                                   if (k++ == wanted) kind = keys;
                                 });
                               }};
          }};
  for_each_kind<Any>([&](const auto& keys) { row.choices.push_back(keys.word); });
  required(row), is_kind(row);
  return row;
}

/// The row of a key of the kind with this bit. Entries of other kinds have the field `others`. If
/// that is empty, reads give the default and writes are lost.
template <class Kind, class Entry, class Any, class Member, class Holder>
Key row_of(const std::string& path, Any Entry::*held, const KindKey<Member, Holder>& key,
           unsigned bit, std::function<Field(const Object&)> others) {
  Key row{path, key.help, [=, member = key.member](const Object& holder) -> Field {
            if (Kind* kind = std::get_if<Kind>(&(std::any_cast<Entry*>(holder)->*held)))
              return &(kind->*member);
            if (others) return others(holder);
            static thread_local Kind standard;
            standard = {};
            return &(standard.*member);
          }};
  if constexpr (!std::is_same_v<Member, std::string> && !std::is_same_v<Member, bool>)
    number(key.unit, key.range)(row);
  row.most = key.most, row.required = key.required, row.kinds = bit, row.flat = key.flat;
  row.by_center = key.by_center, row.names_file = key.file, row.usually = key.usually;
  return row;
}

/// Adds the row of a key of some kinds. One of that path becomes the row of their kinds too, with
/// the later field. y of two numbers may be that of the plane for the later kinds alone;
/// Error(internal) where they differ in anything else.
void add_kind_row(std::vector<Key>& rows, Key row);

/// Adds the rows of all kinds for which wanted(kind).
template <class Entry, class Any, class Wanted>
void add_kind_rows(std::vector<Key>& rows, const std::string& entry, Any Entry::*held,
                   const Wanted& wanted) {
  unsigned bit = 1;
  for_each_kind<Any>([&]<class Kind>(const Kind& kind) {
    const auto add = [&](const auto& key) {
      const std::string path = entry + "." + key.name;
      const auto there = std::ranges::find(rows, path, &Key::path);
      add_kind_row(
          rows, row_of<Kind>(path, held, key, bit, there == rows.end() ? nullptr : there->field));
    };
    if (wanted(kind)) std::apply([&](const auto&... key) { (add(key), ...); }, Kind::keys());
    bit *= 2;
  });
}

}  // namespace pbf::scene_module
