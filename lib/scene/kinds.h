// Properties of a key's numbers, and the kinds of the entries of a list: structs in a std::variant,
// each with a word and keys of its own (shapes of obstacles, kinds of gauges). key_rows.h makes
// their rows.
#pragma once

#include <limits>
#include <string>
#include <variant>

namespace pbf::scene_module {

/// Allowed values of every number of a key.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool above_min = false;  ///< min itself is not allowed
  bool below_max = false;  ///< max itself is not allowed
  bool operator==(const Range&) const = default;
};

// Bounds that only prevent overflow in float arithmetic: boxes from 1e-6 m to 1e6 m, up to a
// million box lengths from the origin.
inline constexpr Range kCoordinate{-1e12, 1e12};
inline constexpr Range kLength{1e-9, 1e9};
inline constexpr Range kSeconds{1e-12, 1e9};
inline constexpr Range kRate{-1e12, 1e12};

/// The y of a vector that is given by x and z only (`dimensions: 2`).
enum class FlatY {
  none,    ///< three numbers are required
  bottom,  ///< defines the lower y of the domain: 0
  top,     ///< defines its upper y: a spacing above the lower
  low,     ///< the domain's lower y
  high,    ///< the domain's upper y
  middle,  ///< the plane
  zero,
};

/// A key of one of the kinds. Kinds with keys of the same name share a row of the table.
template <class Member, class Holder>
struct KindKey {
  Member Holder::*member;
  const char *name, *unit;
  Range range;
  const char* help;
  bool required = true;
  FlatY flat = FlatY::none;
  bool by_center = false;         ///< a corner of a box, which center and size may give as well
  std::size_t most = 0;           ///< largest length of a list of numbers
  bool file = false;              ///< the path of a file
  const char* usually = nullptr;  ///< what an absent number means, in words
};
/// clang before version 17 does not deduce the types of aggregates by itself
/// (tests/regression/fuzz).
template <class Member, class Holder>
KindKey(Member Holder::*, const char*, const char*, Range, const char*, bool = true,
        FlatY = FlatY::none, bool = false, std::size_t = 0, bool = false, const char* = nullptr)
    -> KindKey<Member, Holder>;

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
