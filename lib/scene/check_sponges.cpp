// Rules for sponges.
#include <algorithm>

#include "kernels/pass_sponge.h"
#include "lib/scene/scene_rules.h"
#include "lib/scene/sponge.h"

namespace pbf::scene_module {
namespace {

class SpongeChecker : public SceneRules {
 public:
  using SceneRules::SceneRules;

  void run() {
    constexpr std::array<const char*, 0> none{};
    check_names(s_.damping, "damping", "a zone", none, "");
    if (s_.damping.size() > std::size_t(kMostSponges))
      add(s_.damping[std::size_t(kMostSponges)].name,
          "is the 9th zone, at most 8 are possible; remove some");
    for (const Sponge& k : s_.damping) check(k);
  }

 private:
  void check(const Sponge& k) {
    if (good(k.axes) && k.axes.empty())
      add(k.axes, "is empty, so nothing is damped; name some of x, y, z");
    if (good(k.rate, s_.obstacles) && !k.rate && !wave_period(s_))
      add(k.rate,
          "auto is 15 over the period of the first obstacle that oscillates, and none does; give "
          "a rate in 1/s");
    if (good(k.toward) && std::ranges::find(kFaceNames, k.toward) == kFaceNames.end())
      return add(k.toward, "is \"{}\", expected a face: x_min, x_max, y_min, y_max, z_min or z_max",
                 k.toward);
    if (good(k.toward) && flat() && k.toward[0] == 'y')
      add(k.toward, "{} is no wall with dimensions: 2; name another face", k.toward);
    if (!good(k.min, k.max) || !above(k.min, k.max) || !good(s_.domain.min, s_.domain.max)) return;
    for (std::size_t a = 0; a < 3; ++a)
      if (!(flat() && a == 1) && (k.max[a] <= s_.domain.min[a] || k.min[a] >= s_.domain.max[a]))
        return add(k.min, "the zone lies outside the domain along {}; move it in", kAxes[a]);
  }
};

}  // namespace

void check_sponges(const PlacedScene& placed, Problems& problems) {
  SpongeChecker(placed, problems).run();
}

}  // namespace pbf::scene_module
