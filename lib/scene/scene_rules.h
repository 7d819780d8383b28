// Base class of the rules between keys. Keys are named by their members; their paths come from the
// table.
#pragma once

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <string>

#include "lib/scene/keys.h"
#include "lib/scene/number.h"
#include "lib/scene/validate.h"

namespace pbf::scene_module {

inline constexpr const char* kAxes[] = {"x", "y", "z"};

/// For texts: a number as in scene files, everything else as it is.
template <class T>
decltype(auto) shown(const T& value) {
  if constexpr (std::is_same_v<T, double>)
    return to_text(value);
  else
    return (value);
}

class SceneRules {
 public:
  SceneRules(const PlacedScene& placed, Problems& problems)
      : p_(placed),
        s_(placed.scene),
        names_(scene_table().names(object(placed.scene))),
        problems_(problems) {}

 protected:
  /// For texts: to so many digits.
  static double rounded(double x, int digits = 4) {
    return std::stod(fmt::format("{:.{}g}", x, digits));
  }
  const std::string& name(const auto& member) const { return names_.at(&member); }
  template <class... Kind>
  const std::string& name(const std::variant<Kind...>& kind) const {
    return names_.at(address_of_word(kind));
  }
  /// Whether all of these were read without a problem.
  bool good(const auto&... members) const { return p_.good({name(members)...}); }
  /// The same for all that the shape of an obstacle needs.
  bool good_obstacle(const Obstacle& o) const {
    return good(o.shape) &&
           std::visit(
               [&]<class Shape>(const Shape& keys) {
                 const Matrix3 axes = keys.axes();  // NaN if a direction has length 0
                 return std::isfinite(axes[0][0]) &&
                        std::apply([&](const auto&... key) { return good(keys.*key.member...); },
                                   Shape::keys());
               },
               o.shape);
  }
  template <class T>
  using Shown = decltype(shown(std::declval<const T&>()));
  template <class... T>
  void add_at(const std::string& path, fmt::format_string<Shown<T>...> text, const T&... values) {
    const auto format = [&](const auto&... as_shown) {
      return fmt::vformat(text, fmt::make_format_args(as_shown...));
    };
    problems_.add(p_.place(path), path, format(shown(values)...));
  }
  template <class... T>
  void add(const auto& member, fmt::format_string<Shown<T>...> text, const T&... values) {
    add_at(name(member), text, values...);
  }
  /// "is 2, below time.step (3 s)", followed by `rest`.
  void add_below(const auto& member, double value, const auto& other, const char* rest) {
    const std::string& unit = scene_table().find_key(name(other))->unit;
    add(member, "is {}, below {} ({}{}{}){}", value, name(other), double(other),
        unit.empty() ? "" : " ", unit, rest);
  }
  void add_below(const auto& member, const auto& other, const char* rest) {
    add_below(member, double(member), other, rest);
  }
  bool flat() const { return good(s_.dimensions) && s_.dimensions == 2; }
  /// With dimensions: 2 a vector has no y component; `remedy` in addition to 0.
  void must_lie_flat(const auto& member, const Double3& v, const char* remedy = "") {
    if (good(member) && flat() && v[1] != 0)
      add(member, "its y component is {}, with dimensions: 2 nothing moves along y; give 0{}", v[1],
          remedy);
  }
  /// Names of the entries of a list: different, and none of `taken` or with a slash.
  void check_names(const auto& list, const char* of, const char* what, const auto& taken,
                   const char* by) {
    std::map<std::string, std::size_t> seen;
    for (std::size_t k = 0; k < list.size(); ++k) {
      const std::string& is = list[k].name;
      if (!good(is)) continue;
      if (is.empty() || is.find('/') != is.npos || is == "." || is == "..")
        add(is, "\"{}\" cannot name {}; give a word without \"/\"", is, what);
      else if (std::ranges::count(taken, is) > 0)
        add(is, "is {}; choose another", by);
      else if (const auto [first, fresh] = seen.try_emplace(is, k); !fresh)
        add(is, "is also the name of {}[{}]; choose another", of, first->second);
    }
  }

  /// Whether max > min along every axis; otherwise adds a problem.
  bool above(const Double3& min, const Double3& max) {
    bool ok = true;
    for (int a = 0; a < 3; ++a)
      if (!(max[a] > min[a])) {
        add(max,
            "{} is {}, not above {} ({}): the box is {}; give the lower corner as min, the upper "
            "as max",
            kAxes[a], max[a], name(min), min[a], max[a] < min[a] ? "inverted" : "empty");
        ok = false;
      }
    return ok;
  }

  const PlacedScene& p_;
  const Scene& s_;
  const std::map<const void*, std::string> names_;
  Problems& problems_;
};

/// Parts of check_scene().
void check_obstacles(const PlacedScene& placed, Problems& problems);
void check_motions(const PlacedScene& placed, Problems& problems);
void check_waves(const PlacedScene& placed, Problems& problems);
void check_free(const PlacedScene& placed, Problems& problems);
void check_gauges(const PlacedScene& placed, Problems& problems);
void check_emitters(const PlacedScene& placed, Problems& problems);
void check_periodic(const PlacedScene& placed, Problems& problems);
void check_viscosity(const PlacedScene& placed, Problems& problems);
void check_sponges(const PlacedScene& placed, Problems& problems);
void check_compare(const PlacedScene& placed, Problems& problems);
void check_summary(const PlacedScene& placed, Problems& problems);

}  // namespace pbf::scene_module
