// Keys of a run: measurements, guard, files, pictures, machine.
#include "lib/scene/key_rows.h"

namespace pbf::scene_module {

#define KEY(member) MEMBER(Scene, member)

constexpr const char* kNoPhysics = "what is written, not what is computed";

KeyRows run_rows() {
  const std::vector<std::string> floats = words_of<Precision>();
  return {
      {optional_block(KEY(guard),
                      "Stops a run whose measurements are not physical, and names the cause.",
                      on_by_default, effect(Effect::adaptive)),
       optional_block(KEY(output), "Frames in run.vtkhdf.", exact(kNoPhysics)),
       optional_block(
           KEY(checkpoint),
           "Checkpoints: the complete state, at intervals and at the end, for --resume. A run that "
           "is stopped by a signal or the wall-time limit saves one even without this block.",
           effect(Effect::none)),
       optional_block(KEY(render), "Pictures, drawn while the simulation runs.", exact(kNoPhysics)),
       {"render.camera", "The camera of the pictures."}},
      {key(KEY(measure_every), number("", {1, 2147483647}),
           "Updates between two measurements (density error, energy, momentum, ...)."),
       key(KEY(summary_from), number("s", {0, 1e9}),
           "Readings of gauges and loads before this time do not count in summary.csv of a batch.",
           effect(Effect::none), exact(kNoPhysics)),
       key(KEY(summary), plain,
           "Columns of gauges and loads in summary.csv of a batch: gauge/H/max, gauge/U/x/mean, "
           "load/post/force_x/max_20ms, load/post/force_x/mean, load/post/impulse_x. Empty: all, "
           "where they are 200 at most.",
           effect(Effect::none)),
       key(KEY(guard->speed), number("m/s", {0, 1e30, true}),
           "Fastest speed allowed, in any update. auto: 10 times the sum of the fastest speed at "
           "the start, that of a fall through the domain, and h per update. With "
           "solver.speed_limit, only speeds at a measure count.",
           automatic),
       key(KEY(guard->energy), number("", {0, 1e30, true}),
           "Growth of kinetic plus potential energy allowed, relative to the energy at the start "
           "above the floor and in motion about the centre of mass. auto: 0.1, and more while a "
           "compressed start expands.",
           automatic),
       key(KEY(guard->neighbors), number("", {0, 2147483647, true}),
           "Neighbors of one particle allowed. auto: 4 times the most at the start, at least 16 "
           "times those at rest.",
           automatic),
       key(KEY(output->every), number("s", kSeconds),
           "Time between frames, rounded to whole updates; at least time.step."),
       key(KEY(output->gauges_every), number("s", kSeconds),
           "Time between two readings of the gauges, rounded to whole updates; at least time.step. "
           "auto: with the measures.",
           automatic),
       key(KEY(output->fields), one_of({"velocity", "density"}),
           "Fields besides position and id, as a list."),
       key(KEY(output->precision), one_of(floats),
           "Precision of the floating-point fields in the file."),
       key(KEY(output->compression), one_of({"none", "gzip"}),
           "gzip: files about 1.45 times smaller, written more slowly."),
       key(KEY(checkpoint->every), number("s", {1e-3, 1e9}),
           "Wall time between two checkpoints. After a crash --resume continues from the last "
           "one."),
       key(KEY(render->every), number("s", kSeconds),
           "Time between pictures, rounded to whole frames of `output`; not below output.every."),
       key(KEY(render->size), number("px", {16, 16384}), "Width and height of a picture."),
       key(KEY(render->style), one_of(words_of<RenderStyle>()),
           "How the fluid is drawn. surface: as one smooth surface of water, coloured as the "
           "spheres "
           "would be."),
       key(KEY(render->color), one_of(words_of<ColorBy>()),
           "What colours the particles. density: blue below rest_density, red above; compression: "
           "the density's excess over rest_density, relative."),
       key(KEY(render->range), number("", {-1e30, 1e30}),
           "Ends of the colour bar, [low, high], in the unit of the field. auto: of the speed from "
           "0 to what the energy of the start and the motions of obstacles and tank suggest; of "
           "the density 10 % about rest_density; of the compression from 0 to 1 %.",
           automatic),
       key(KEY(render->radius), number("m", {0, 1e9, true}),
           "Drawn radius of a particle. auto: half the spacing.", automatic),
       key(KEY(render->camera.position), number("m", kCoordinate),
           "Where the camera is. auto: outside the longest side, where it sees the floor and the "
           "height that the fluid and the obstacles may reach; in two dimensions in front of the "
           "plane.",
           automatic),
       key(KEY(render->camera.target), number("m", kCoordinate),
           "What the camera looks at. auto: with position: auto the middle of what it sees, else "
           "the "
           "centre of the domain.",
           automatic),
       key(KEY(render->camera.fov), number("deg", {1, 170}), "Vertical field of view."),
       key(KEY(render->camera.orbit), number("deg/s", {-36000, 36000}),
           "Turn about the vertical axis per second of simulated time."),
       key(KEY(backend), one_of(words_of<Backend>()), "Where the simulation runs.",
           effect(Effect::none)),
       key(KEY(precision), one_of(floats), "Precision of the computation."),
       key(KEY(threads), number("", {1, 4096}),
           "CPU threads. auto: one below 4096 particles, else one for every 1024, at most all "
           "that the process may use.",
           automatic, effect(Effect::none))}};
}

}  // namespace pbf::scene_module
