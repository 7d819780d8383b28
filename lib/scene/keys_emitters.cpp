// Keys of emitters and sinks.
#include "lib/scene/key_rows.h"

namespace pbf::scene_module {

#define KEY(member) MEMBER(Scene, member)
#define EMITTER(member) MEMBER_OF(emitters, Emitter, member)
#define SINK(member) MEMBER_OF(sinks, Sink, member)
#define SPONGE(member) MEMBER_OF(damping, Sponge, member)

KeyRows emitter_rows() {
  return {
      {list_block(
           KEY(emitters), "Nozzles from which layers of particles come",
           {.entry_name = "emitter",
            .remark = "in the order of their columns in the log",
            .example = "{name: jet, shape: disc, center: [0.2, 0.5, 0.8], normal: [1, 0, "
                       "0], radius: 0.05, speed: 2}",
            .further = "{name: jet, shape: disc, center: [0.3, 0.5, 0.8], normal: [1, 0, 0], "
                       "radius: 0.05, speed: 2}"},
           exact("all solvers of a comparison emit the same particles")),
       list_block(KEY(sinks), "Boxes in which particles are removed",
                  {.entry_name = "sink",
                   .remark = "at the start of the update after they came in",
                   .example = "{name: drain, min: [0, 0, 0], max: [0.1, 1, 0.1]}"},
                  exact("all solvers of a comparison have the same boxes")),
       list_block(
           KEY(damping), "Sponges: zones in which velocities decay, so that waves end there",
           {.entry_name = "zone",
            .remark = "v becomes v/(1 + rate s^profile dt)",
            .example = "{name: end, min: [6, 0, 0], max: [8, 1, 1], toward: x_max, rate: 10}"})},
      {key(EMITTER(name), plain, "Name, in the columns of the log.", required),
       key(EMITTER(shape), one_of({"disc", "rectangle"}),
           "Shape of the opening; decides which keys it has. In two dimensions both are a line.",
           required, is_kind),
       key(EMITTER(center), number("m", kCoordinate), "Middle of the opening.", required,
           flat(FlatY::middle)),
       key(EMITTER(normal), number("", {-1e6, 1e6}),
           "The direction in which the particles leave, at right angles to the opening.", required,
           flat(FlatY::zero)),
       key(EMITTER(radius), number("m", kLength),
           "Radius of the disc; in two dimensions half the length of the line. Columns of "
           "particles, fluid.spacing apart, keep half a spacing from its rim.",
           required, of(NozzleShape::disc)),
       [] {
         Key row = key(EMITTER(size), number("m", {1e-9, 1e12}),
                       "Edges of the rectangle: the level one (along x where the normal is along "
                       "z), then the other. In two dimensions the length of the line, [size]. As "
                       "many columns as whole spacings fit.",
                       required, of(NozzleShape::rectangle));
         row.most = 2;
         return row;
       }(),
       key(EMITTER(speed), number("m/s", {0, 1e6}),
           "Speed at which the particles leave; auto: that of the file `path`.", automatic),
       key(EMITTER(path), plain,
           "CSV file of the speed, relative to the scene file, with the header t,V (s, m/s; linear "
           "between rows). Empty: the speed is constant.",
           of(NozzleShape::disc, NozzleShape::rectangle), names_file),
       key(EMITTER(start), number("s", {0, 1e9}), "When it begins."),
       key(EMITTER(end), number("s", kSeconds), "When it ends; auto: time.end.", automatic),
       key(SINK(name), plain, "Name, in the columns of the log.", required),
       key(SINK(min), number("m", kCoordinate),
           "Lower corner of the box. In place of min and max the box may have center, its middle, "
           "and size, its edges.",
           required, flat(FlatY::low), by_center),
       key(SINK(max), number("m", kCoordinate), "Upper corner of the box.", required,
           flat(FlatY::high), by_center),
       key(SPONGE(name), plain, "Name, for messages.", required),
       key(SPONGE(min), number("m", kCoordinate),
           "Lower corner of the zone. In place of min and max it may have center and size.",
           required, flat(FlatY::low), by_center),
       key(SPONGE(max), number("m", kCoordinate), "Upper corner of the zone.", required,
           flat(FlatY::high), by_center),
       key(SPONGE(toward), one_of({kFaceNames.begin(), kFaceNames.end()}),
           "The face of the zone towards which s grows from 0 to 1."),
       key(SPONGE(rate), number("1/s", {0, 1e12}),
           "Rate of the decay where s is 1. auto: 15 over the period of the first obstacle that "
           "oscillates.",
           automatic),
       key(SPONGE(profile), number("", {1, 4}), "The power of s, a whole number."),
       key(SPONGE(axes), one_of({"x", "y", "z"}), "Velocities along these axes decay."),
       key(KEY(capacity), number("", {0, 1073741823}),
           "Most particles at a time in a scene with emitters or sinks; more stop the run. auto: "
           "all that may ever be.",
           automatic, exact("the size of arrays"))}};
}

}  // namespace pbf::scene_module
