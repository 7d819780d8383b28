// Keys of the initial state: box, fluid, bodies.
#include "lib/scene/key_rows.h"

namespace pbf::scene_module {

#define KEY(member) MEMBER(Scene, member)
#define BODY(member) MEMBER_OF(bodies, Body, member)

constexpr const char* kFrame = "coordinates count from it and the grid is laid by it";

KeyRows start_rows() {
  return {
      {{"", "A scene."},
       {"domain", "The box that holds the fluid."},
       {"fluid", "The fluid and its particles."},
       list_block(KEY(bodies), "Bodies of fluid",
                  {.entry_name = "body",
                   .least = 1,
                   .unless = "emitters",
                   .remark = "with emitters none is needed; ids count through them in this order",
                   .example = "{shape: block, min: [0, 0, 0], max: [1, 1, 1]}",
                   .further = "{shape: file, path: particles.csv, velocity: [0, 0, 0]}"},
                  exact("all solvers of a comparison start from the same particles"))},
      {key(KEY(name), plain,
           "Name of the scene, for titles and logs, and of the folder of its runs, out/NAME. That "
           "of a base is not taken.",
           effect(Effect::none), usually("that of the scene file, without .yaml")),
       key(KEY(dimensions), number("", {2, 3}),
           "2: the fluid lies in the x-z plane in the middle of the domain's y, whose extent is "
           "the thickness of the slab, at most h, without walls. Bodies are cut by that plane. "
           "Vectors may then be given by x and z, [x, z]: the slab is one spacing thick, from y = "
           "0 "
           "on, and all lies in it. 3: space."),
       key(KEY(domain.min), number("m", kCoordinate), "Lower corner of the box, [x, y, z].",
           required, flat(FlatY::bottom), exact(kFrame)),
       key(KEY(domain.max), number("m", kCoordinate),
           "Upper corner of the box; above domain.min along every axis.", required,
           flat(FlatY::top), exact(kFrame)),
       key(KEY(domain.open), one_of({kFaceNames.begin(), kFaceNames.end()}),
           "Faces of the box without a wall, as a list."),
       key(KEY(domain.periodic), one_of({"x", "y", "z"}),
           "Axes whose two faces are joined, as a list: what leaves through one face enters "
           "through "
           "the other. At least 3 h long, best a whole number of fluid.spacing."),
       key(KEY(domain.friction), number("", {0, 1}),
           "Friction of the walls, by the fluid's viscosity. 0: fluid slides along them. 1: no "
           "slip, as if the fluid went on behind the wall and moved with it. Between: that share "
           "of the force.",
           off_at(0)),
       key(KEY(domain.friction_on), one_of({kFaceNames.begin(), kFaceNames.end()}),
           "Faces that have the friction, as a list; []: all walls."),
       key(KEY(domain.loads), plain,
           "Sums the force and the torque of the fluid on each wall; columns load/x_min/force_x "
           "and so on of the log."),
       key(KEY(fluid.rest_density), number("kg/m^3", {1e-6, 1e9}), "Rest density rho0.",
           exact("the unit of densities")),
       key(KEY(fluid.spacing), number("m", kLength),
           "Edge d of the rest lattice's cell: the distance of neighboring particles at rest. "
           "Halving it makes 8 times the particles, 4 in two dimensions.",
           required, exact("the particles stand so far apart; h is rounded by smoothing_ratio")),
       key(KEY(fluid.smoothing_ratio), number("", {1, 10}),
           "Smoothing length over spacing, h/d. 2 gives about 33 neighbors, 12 in two "
           "dimensions. With fluid.mass: auto at least 1.6, in two dimensions 1.5: below, a pool "
           "packs itself into less than 0.97 of its volume."),
       key(KEY(fluid.mass), number("kg", {0, 1e30, true}),
           "Mass of one particle. auto: rho0 d^3 (in two dimensions rho0 d^2 times the "
           "thickness), with the density sum calibrated so that the rest lattice has density "
           "rho0. A number is used as it is.",
           automatic),
       key(BODY(shape), one_of({"block", "sphere", "random_box", "file", "cylinder", "mesh"}),
           "Shape of the body; decides which keys it has.", required, is_kind),
       key(BODY(min), number("m", kCoordinate),
           "Lower corner of the box. In place of min and max the box may have center, its middle, "
           "and size, its edges.",
           required, of(Shape::block, Shape::random_box), flat(FlatY::low), by_center),
       key(BODY(max), number("m", kCoordinate), "Upper corner of the box.", required,
           of(Shape::block, Shape::random_box), flat(FlatY::high), by_center),
       key(BODY(center), number("m", kCoordinate), "Centre of the sphere.", required,
           of(Shape::sphere), flat(FlatY::middle)),
       key(BODY(radius), number("m", kLength), "Radius.", required,
           of(Shape::sphere, Shape::cylinder)),
       key(BODY(from), number("m", kCoordinate),
           "One end of the cylinder's axis; the lattice lies along it. With dimensions: 2 it "
           "stands on the x-z plane, and the body is a disc.",
           required, of(Shape::cylinder), flat(FlatY::low)),
       key(BODY(to), number("m", kCoordinate), "The other end.", required, of(Shape::cylinder),
           flat(FlatY::high)),
       key(BODY(count), number("", {1, 2147483647}), "Number of particles, uniformly distributed.",
           required, of(Shape::random_box)),
       key(BODY(seed), number("", {0, 9223372036854775807.0}),
           "Seed of the random numbers; the same seed gives the same particles.",
           of(Shape::random_box)),
       key(BODY(path), plain,
           "Particle file, relative to the scene file: CSV with the header x,y,z or "
           "x,y,z,vx,vy,vz, or HDF5 with datasets position (N, 3) and, if wanted, velocity (N, "
           "3). Of a mesh: STL, binary or ASCII, or OBJ; its surface must be closed. The body is "
           "the lattice points inside, half a spacing from the lower corner of its box on.",
           required, of(Shape::file, Shape::mesh), names_file),
       key(BODY(scale), number("", {1e-12, 1e12}),
           "Meters per unit of the mesh's coordinates; 0.001 for millimeters.", of(Shape::mesh)),
       key(BODY(turn_axis), number("", {-1e6, 1e6}),
           "After scaling the mesh is turned about this axis through the origin.", of(Shape::mesh)),
       key(BODY(turn_angle), number("degrees", {-360, 360}),
           "By so much, counterclockwise seen from where the axis points.", of(Shape::mesh)),
       key(BODY(translate), number("m", kCoordinate), "Then the mesh is moved by this.",
           of(Shape::mesh), flat(FlatY::zero)),
       key(BODY(velocity), number("m/s", kRate),
           "Initial velocity, added to every particle of the body.", flat(FlatY::zero))}};
}

}  // namespace pbf::scene_module
