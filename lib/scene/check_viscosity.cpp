// Rules for viscosity and friction.
#include "lib/scene/scene_rules.h"
#include "lib/scene/viscosity.h"

namespace pbf::scene_module {
namespace {

/// Below it there are too few neighbors for a viscosity of a physical unit, and fluid behind a wall
/// is out of sight. Scenes without fluid.mass have more.
constexpr double kLeastRatio = 1.5;

class ViscosityChecker : public SceneRules {
 public:
  using SceneRules::SceneRules;

  void run() {
    check_faces();
    const bool kinematic = s_.viscosity && s_.viscosity->kinematic;
    if (kinematic && !good(s_.viscosity->kinematic)) return;
    if (kinematic && good(s_.viscosity->xsph) && s_.viscosity->xsph != 0)
      add(s_.viscosity->kinematic,
          "is all the viscosity there is, and viscosity.xsph is {}; give one of them, or xsph: 0",
          s_.viscosity->xsph);
    check_friction();
    const bool used = kinematic || has_friction(s_);
    if (!used || !good(s_.fluid.spacing, s_.fluid.smoothing_ratio)) return;
    if (s_.fluid.smoothing_ratio < kLeastRatio)
      return add(s_.fluid.smoothing_ratio,
                 "is {}: with so few neighbors {} has no meaning; give at least {}",
                 s_.fluid.smoothing_ratio,
                 std::string(kinematic ? "viscosity.kinematic" : "friction"), kLeastRatio);
    if (kinematic) check_step();
  }

 private:
  void check_faces() {
    if (!good(s_.domain.friction_on, s_.domain.open, s_.domain.periodic)) return;
    for (const std::string& face : s_.domain.friction_on) {
      const int axis = face[0] - 'x';
      if (flat() && axis == 1)
        add(s_.domain.friction_on, "{}: with dimensions: 2 there is no wall along y; remove it",
            face);
      else if (!s_.domain.has_wall(axis, face.ends_with("max")))
        add(s_.domain.friction_on, "{} is no wall ({}); remove it", face,
            std::string(s_.domain.is_periodic(axis) ? "domain.periodic" : "domain.open"));
    }
    if (s_.domain.friction_on.empty() && good(s_.domain.friction, s_.dimensions) &&
        s_.domain.friction > 0 && !has_wall_friction(s_))
      add(s_.domain.friction, "is {}, and no face of the domain is a wall; remove it",
          s_.domain.friction);
    if (!s_.domain.friction_on.empty() && good(s_.domain.friction) && s_.domain.friction == 0)
      add(s_.domain.friction_on, "names faces, and domain.friction is 0; give it, 1 for no slip");
  }

  /// A surface holds fluid by its viscosity.
  void check_friction() {
    if (s_.viscosity &&
        !(good(s_.viscosity->xsph) && s_.viscosity->xsph == 0 && !s_.viscosity->kinematic))
      return;
    constexpr const char* kNoViscosity =
        "is {}, and walls hold fluid by its viscosity, of which there is none; give viscosity, "
        "{{kinematic: 1.0e-06}} for water";
    if (good(s_.domain.friction) && s_.domain.friction > 0)
      add(s_.domain.friction, kNoViscosity, s_.domain.friction);
    for (const Obstacle& o : s_.obstacles)
      if (good(o.friction) && o.friction > 0) add(o.friction, kNoViscosity, o.friction);
  }

  void check_step() {
    if (!good(s_.time.step, s_.solver.kernels, s_.dimensions, s_.fluid.mass, s_.domain.min,
              s_.domain.max, s_.fluid.rest_density))
      return;
    const double longest = longest_viscous_step(s_);
    if (s_.time.step <= longest * (1 + 1e-9)) return;
    add(s_.viscosity->kinematic,
        "{} m^2/s moves momentum farther in time.step ({} s) than {} sweeps over the neighbors "
        "reach; lower time.step to {} s, raise fluid.spacing, or lower it to {} m^2/s",
        *s_.viscosity->kinematic, s_.time.step, kMostSweeps, rounded_down(longest),
        rounded_down(*s_.viscosity->kinematic * longest / s_.time.step));
  }
  static double rounded_down(double x) { return std::stod(fmt::format("{:.3g}", 0.995 * x)); }
};

}  // namespace

void check_viscosity(const PlacedScene& placed, Problems& problems) {
  ViscosityChecker(placed, problems).run();
}

}  // namespace pbf::scene_module
