// Keys of free bodies: obstacles that the fluid moves.
#include "lib/scene/key_rows.h"

namespace pbf::scene_module {

#define OBSTACLE(member) MEMBER_OF(obstacles, Obstacle, member)

KeyRows free_rows() {
  return {
      {optional_block(OBSTACLE(free),
                      "The fluid and gravity move the obstacle: give its density or its mass.")},
      {key(OBSTACLE(free->density), number("kg/m^3", {1e-9, 1e12}),
           "Density of the body, the same everywhere in it; auto: from its mass.", automatic),
       key(OBSTACLE(free->mass), number("kg", {1e-30, 1e30}),
           "Mass of the body, in two dimensions per m of width (kg/m); auto: from its density.",
           automatic),
       key(OBSTACLE(free->lock), one_of({kLockNames.begin(), kLockNames.end()}),
           "What it is kept from, as a list: motion along the axes x, y, z of the scene, and turns "
           "about them, rx, ry, rz."),
       key(OBSTACLE(free->velocity), number("m/s", kRate),
           "Velocity of its center of mass at the start.", flat(FlatY::zero)),
       key(OBSTACLE(free->angular), number("degrees/s", {-1e9, 1e9}),
           "Angular velocity at the start: a rotation about this vector (right-hand rule) at the "
           "rate of its length.")}};
}

}  // namespace pbf::scene_module
