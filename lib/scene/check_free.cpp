// Rules for free bodies.
#include "lib/scene/free_start.h"
#include "lib/scene/scene_rules.h"

namespace pbf::scene_module {
namespace {

class FreeChecker : public SceneRules {
 public:
  using SceneRules::SceneRules;

  void run() {
    for (std::size_t k = 0; k < s_.obstacles.size(); ++k) {
      const Obstacle& o = s_.obstacles[k];
      if (!o.free) continue;
      check_others(o);
      check_start(*o.free);
      if (!good(o.shape)) continue;
      if (!o.may_be_free()) {
        add_at(block_of_free(o),
               "a {} has no end, and no mass; give a box, sphere, cylinder, capsule or mesh to "
               "what the fluid moves",
               std::visit([](const auto& keys) { return std::string(keys.word); }, o.shape));
        continue;
      }
      const bool sized = good_obstacle(o) && !o.surface_file() && has_size(o);
      check_mass(o, sized);
      if (sized && has_frame()) check_place(k);
    }
  }

 private:
  std::string block_of_free(const Obstacle& o) const { return block_of(name(o.free->density)); }

  /// What does not go with free bodies.
  void check_others(const Obstacle& o) {
    const std::string block = block_of_free(o);
    if (o.motion)
      add_at(block, "is given beside motion, which says where the obstacle is; remove one of them");
    if (s_.tank_motion)
      add_at(block,
             "does not go with tank_motion: free bodies do not feel the forces in a tank that "
             "moves; remove one of them");
    if (good(s_.domain.periodic) && !s_.domain.periodic.empty())
      add_at(block,
             "does not go with domain.periodic: obstacles have no images beyond periodic faces; "
             "remove one of them");
  }

  void check_start(const FreeBody& f) {
    must_lie_flat(f.velocity, f.velocity);
    if (good(f.angular) && flat() && (f.angular[0] != 0 || f.angular[2] != 0))
      add(f.angular, "with dimensions: 2 nothing turns but about y; give [0, 1, 0] times a number");
  }

  /// sized: whether the volume is known, that of a mesh only when its file is read.
  void check_mass(const Obstacle& o, bool sized) {
    const FreeBody& f = *o.free;
    if (!good(f.density, f.mass)) return;
    if (bool(f.density) == bool(f.mass)) {
      add_at(block_of_free(o), "a free body needs {}",
             f.mass ? "density or mass, not both; remove one"
                    : "density (kg/m^3) or mass (kg); give one");
      return;
    }
    if (!good(s_.fluid.rest_density, s_.dimensions) || (f.mass && !sized)) return;
    if (f.density)
      add_text(f.density, light_text(s_, o));
    else
      add_text(f.mass, light_text(s_, o));
  }

  /// Whether domain and spacing were read without a problem.
  bool has_frame() const {
    if (!good(s_.domain.min, s_.domain.max, s_.domain.open, s_.domain.periodic, s_.dimensions,
              s_.fluid.spacing, s_.fluid.smoothing_ratio))
      return false;
    return s_.domain.max[0] > s_.domain.min[0] && s_.domain.max[1] > s_.domain.min[1] &&
           s_.domain.max[2] > s_.domain.min[2];
  }
  /// Whether it is well formed: other rules tell what is not.
  bool has_size(const Obstacle& o) const { return moments_of(s_, o).volume > 0; }

  /// Those whose places are known before files are read (lib/run/free_starts.h has the others). Of
  /// two free bodies the later one is told.
  void check_place(std::size_t k) {
    std::vector<NamedSolid> others;
    for (std::size_t i = 0; i < s_.obstacles.size(); ++i) {
      const Obstacle& o = s_.obstacles[i];
      if (i != k && !(o.free && i > k) && !o.motion && !o.surface_file() && good(o.name) &&
          good_obstacle(o))
        others.push_back(named_solid(s_, i));
    }
    const Obstacle& body = s_.obstacles[k];
    const std::string text = free_start_text(s_, body, named_solid(s_, k).solid, others);
    if (!text.empty()) add_at(block_of_free(body), "{}", text);
  }

  void add_text(const auto& member, const std::string& text) {
    if (!text.empty()) add(member, "{}", text);
  }
};

}  // namespace

void check_free(const PlacedScene& placed, Problems& problems) {
  FreeChecker(placed, problems).run();
}

}  // namespace pbf::scene_module
