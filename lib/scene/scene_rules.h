// Base class of the rules between keys. Keys are named by their members; their paths come from the
// table.
#pragma once

#include <map>
#include <string>

#include "lib/scene/keys.h"
#include "lib/scene/number.h"
#include "lib/scene/validate.h"

namespace pbf::inline scene_module {

inline constexpr const char* kAxes[] = {"x", "y", "z"};

class SceneRules {
 public:
  SceneRules(const PlacedScene& placed, Problems& problems)
      : p_(placed),
        s_(placed.scene),
        names_(scene_table().names(object(placed.scene))),
        problems_(problems) {}

 protected:
  const std::string& name(const auto& member) const { return names_.at(&member); }
  template <class... Kind>
  const std::string& name(const std::variant<Kind...>& kind) const {
    return names_.at(address_of_word(kind));
  }
  /// Whether all of these were read without a problem.
  bool good(const auto&... members) const { return p_.good({name(members)...}); }
  void add_at(const std::string& path, const std::string& what) {
    problems_.add(p_.place(path), path, what);
  }
  void add(const auto& member, const std::string& what) { add_at(name(member), what); }
  /// "is 2, below time.step (3 s)", followed by `rest`.
  void add_below(const auto& member, const auto& other, const std::string& rest) {
    const std::string& unit = scene_table().find_key(name(other))->unit;
    add(member, "is " + to_text(member) + ", below " + name(other) + " (" + to_text(other) +
                    (unit.empty() ? "" : " " + unit) + ")" + rest);
  }
  bool flat() const { return good(s_.dimensions) && s_.dimensions == 2; }

  /// Whether max > min along every axis; otherwise adds a problem.
  bool above(const Double3& min, const Double3& max) {
    bool ok = true;
    for (int a = 0; a < 3; ++a)
      if (!(max[a] > min[a])) {
        add(max, std::string(kAxes[a]) + " is " + to_text(max[a]) + ", not above " + name(min) +
                     " (" + to_text(min[a]) + "): the box is " +
                     (max[a] < min[a] ? "inverted" : "empty") +
                     "; give the lower corner as min, "
                     "the upper as max");
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
void check_gauges(const PlacedScene& placed, Problems& problems);

}  // namespace pbf::inline scene_module
