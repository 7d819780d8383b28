// The kinds of the entries of a list: structs in a std::variant, each with a word and keys of its
// own (shapes of obstacles, kinds of gauges). key_rows.h makes their rows.
#pragma once

#include <string>
#include <variant>

#include "lib/scene/key_traits.h"

namespace pbf::scene_module {

/// A key of one of the kinds. Kinds with keys of the same name share a row of the table.
template <class Member, class Holder>
struct KindKey {
  Member Holder::*member;
  const char *name, *unit;
  Range range;
  const char* help;
  bool required = true;
  FlatY flat = FlatY::none;
  bool by_center = false;  ///< a corner of a box, which center and size may give as well
  std::size_t most = 0;    ///< largest length of a list of numbers
};

/// Calls f with each kind of a variant, all defaults, in the order of the list.
template <class Any, class F>
void for_each_kind(F&& f) {
  [&]<class... Kind>(const std::variant<Kind...>*) {
    (f(Kind{}), ...);
  }(static_cast<const Any*>(nullptr));
}

/// The address that stands for the word in names of keys. It is not that of the variant, which is
/// also the address of a key of the kind.
template <class... Kind>
const void* address_of_word(const std::variant<Kind...>& kind) {
  return reinterpret_cast<const char*>(&kind) + 1;
}

}  // namespace pbf::scene_module
