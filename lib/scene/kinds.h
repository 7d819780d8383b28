// The kinds of the entries of a list: structs in a std::variant, each with a word and keys of its
// own (shapes of obstacles, kinds of gauges). lib/scene/key_rows.h makes their rows.
#pragma once

#include <string>
#include <variant>

namespace pbf::inline scene_module {

/// Calls f with each kind of a variant, all defaults, in the order of the list.
template <class Any, class F>
void for_each_kind(F&& f) {
  [&]<class... Kind>(const std::variant<Kind...>*) {
    (f(Kind{}), ...);
  }(static_cast<const Any*>(nullptr));
}

/// The name of the kind in scenes.
template <class... Kind>
const char* word(const std::variant<Kind...>& kind) {
  return std::visit([](const auto& keys) { return keys.word; }, kind);
}

/// The address that stands for the word in names of keys. It is not that of the variant, which is
/// also the address of a key of the kind.
template <class... Kind>
const void* address_of_word(const std::variant<Kind...>& kind) {
  return reinterpret_cast<const char*>(&kind) + 1;
}

}  // namespace pbf::inline scene_module
