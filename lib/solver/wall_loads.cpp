#include "lib/solver/wall_loads.h"

#include "lib/program/loads.h"
#include "lib/solver/params.h"

namespace pbf::inline solver_module {

const std::vector<LoadNumber>& load_numbers() {
  using L = const WallLoad&;
  static const std::vector<LoadNumber> numbers = {
      {"force_x", "N", [](L l) { return l.force[0]; }},
      {"force_y", "N", [](L l) { return l.force[1]; }},
      {"force_z", "N", [](L l) { return l.force[2]; }},
      {"torque_x", "N m", [](L l) { return l.torque[0]; }},
      {"torque_y", "N m", [](L l) { return l.torque[1]; }},
      {"torque_z", "N m", [](L l) { return l.torque[2]; }},
      {"force_peak", "N", [](L l) { return l.peak; }}};
  return numbers;
}

std::vector<WallLoad> wall_loads(const std::vector<Load>& loads, const Scene& scene,
                                 const Plan& plan) {
  std::vector<WallLoad> out;
  if (loads.empty()) return out;
  const auto& of = plan.axes.of;
  // A cross product changes its sign if the axes have the other handedness.
  const double hand = (of[1] - of[0] + 3) % 3 == 1 ? 1 : -1, h = scene.h();
  const auto add = [&](const std::string& name, const Load& load, const double(&middle)[3]) {
    WallLoad l{name};
    const double force = load.time > 0 ? plan.mass * h / load.time : 0;
    for (int k = 0; k < 3; ++k) {
      const int b = (k + 1) % 3, c = (k + 2) % 3;
      l.force[of[k]] = force * load.impulse[k];
      l.torque[of[k]] =
          hand * force * h *
          (load.moment[k] - middle[b] * load.impulse[c] + middle[c] * load.impulse[b]);
    }
    l.peak = plan.mass * h * load.peak;
    out.push_back(std::move(l));
  };
  const Box<double> box = make_params<double>(scene, plan).boundary;
  const double extent[3] = {box.extent.x, box.extent.y, box.extent.z};
  for (int face = 0; scene.domain.loads && face < 6; ++face) {
    const int axis = plan.axes.inside(face / 2), wall = 2 * axis + face % 2;
    if (!(box.walls >> wall & 1)) continue;
    double middle[3];
    for (int k = 0; k < 3; ++k) middle[k] = k != axis ? extent[k] / 2 : face % 2 ? extent[k] : 0;
    add(kFaceNames[std::size_t(face)], loads[std::size_t(wall)], middle);
  }
  for (std::size_t k = 0; k < scene.obstacles.size(); ++k) {
    if (!scene.obstacles[k].loads) continue;
    // The moment of a moving obstacle is already about its middle.
    const Vec3<double> center = scene.obstacles[k].motion ? Vec3<double>{} : plan.solids[k].center;
    add(scene.obstacles[k].name, loads[kFaceNames.size() + k], {center.x, center.y, center.z});
  }
  return out;
}

}  // namespace pbf::inline solver_module
