#include "lib/scene/keys.h"

namespace pbf::inline scene_module {
namespace {

using Words = std::vector<std::string>;

// Bounds that hold off overflow in float arithmetic and nothing that anyone simulates: boxes from
// 1e-6 m to 1e6 m, up to a million box lengths from the origin.
constexpr Range kCoordinate{-1e12, 1e12};
constexpr Range kLength{1e-9, 1e9};
constexpr Range kSeconds{1e-12, 1e9};
constexpr Range kRate{-1e12, 1e12};

constexpr unsigned bit(Shape s) { return 1u << static_cast<unsigned>(s); }
constexpr unsigned kBox = bit(Shape::block) | bit(Shape::random_box);
constexpr unsigned kEveryShape = 15;

template <class Enum>
ChoiceField choice(Enum& e) {
  return {[&e] { return static_cast<int>(e); }, [&e](int i) { e = static_cast<Enum>(i); }};
}

/// Field of the scene, found by a callable that names it.
template <class Get>
std::function<Field(Scene&, Body&)> of_scene(Get get) {
  return [get](Scene& s, Body&) -> Field { return get(s); };
}
template <class Get>
std::function<Field(Scene&, Body&)> of_body(Get get) {
  return [get](Scene&, Body& b) -> Field { return get(b); };
}
#define SCENE(expression) of_scene([](Scene& s) { return expression; })
#define BODY(expression) of_body([](Body& b) { return expression; })

Key number(const char* path, const char* unit, Range range, const char* help,
           std::function<Field(Scene&, Body&)> field) {
  return {path, help, unit, range, {}, false, false, 0, std::move(field)};
}
Key words(const char* path, Words choices, const char* help,
          std::function<Field(Scene&, Body&)> field) {
  return {path, help, "", {}, std::move(choices), false, false, 0, std::move(field)};
}
Key required(Key key) {
  key.required = true;
  return key;
}
Key automatic(Key key) {
  key.automatic = true;
  return key;
}
Key renamed(const char* was, Key key) {
  key.was = was;
  return key;
}
Key shapes(unsigned mask, Key key) {
  key.shapes = mask;
  return key;
}

const Words kFloats{"float", "double"};

std::vector<Key> top_keys() {
  return {words("name", {}, "Name of the scene, for titles and logs.", SCENE(&s.name)),
          number("dimensions", "", {2, 3},
                 "2: the fluid lies in the x-z plane in the middle of the domain's y, whose extent "
                 "is the thickness of the slab, at most h, without walls. Bodies are cut by that "
                 "plane. 3: space.",
                 SCENE(&s.dimensions))};
}

std::vector<Key> domain_keys() {
  return {required(number("domain.min", "m", kCoordinate, "Lower corner of the box, [x, y, z].",
                          SCENE(&s.domain.min))),
          required(number("domain.max", "m", kCoordinate,
                          "Upper corner of the box; above domain.min along every axis.",
                          SCENE(&s.domain.max))),
          words("domain.open", {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"},
                "Faces of the box without a wall, as a list.", SCENE(&s.domain.open))};
}

std::vector<Key> fluid_keys() {
  return {
      number("fluid.rest_density", "kg/m^3", {1e-6, 1e9}, "Rest density rho0.",
             SCENE(&s.fluid.rest_density)),
      required(number("fluid.spacing", "m", kLength,
                      "Edge d of the rest lattice's cell: the distance of neighbouring particles "
                      "at rest. Halving it makes 8 times the particles, 4 in two dimensions.",
                      SCENE(&s.fluid.spacing))),
      number("fluid.smoothing_ratio", "", {1, 10},
             "Smoothing length over spacing, h/d. 2 gives about 33 neighbours, 12 in two "
             "dimensions. With fluid.mass: auto at least 1.6, in two dimensions 1.5: below, a pool "
             "packs itself into less than 0.97 of its volume.",
             SCENE(&s.fluid.smoothing_ratio)),
      automatic(number("fluid.mass", "kg", {0, 1e30, true},
                       "Mass of one particle. auto: rho0 d^3 (in two dimensions rho0 d^2 times "
                       "the thickness), with the density sum calibrated so that the rest lattice "
                       "has density rho0. A number is used as it is.",
                       SCENE(&s.fluid.mass)))};
}

std::vector<Key> body_keys() {
  return {
      required(shapes(kEveryShape, words("bodies[].shape", shape_names(),
                                         "Shape of the body; decides which keys it has.",
                                         BODY(choice(b.shape))))),
      required(shapes(kBox, number("bodies[].min", "m", kCoordinate, "Lower corner of the box.",
                                   BODY(&b.min)))),
      required(shapes(kBox, number("bodies[].max", "m", kCoordinate, "Upper corner of the box.",
                                   BODY(&b.max)))),
      required(shapes(bit(Shape::sphere), number("bodies[].center", "m", kCoordinate,
                                                 "Centre of the sphere.", BODY(&b.center)))),
      required(shapes(bit(Shape::sphere), number("bodies[].radius", "m", kLength,
                                                 "Radius of the sphere.", BODY(&b.radius)))),
      required(shapes(bit(Shape::random_box),
                      number("bodies[].count", "", {1, 2147483647},
                             "Number of particles, uniformly distributed.", BODY(&b.count)))),
      shapes(bit(Shape::random_box),
             number("bodies[].seed", "", {0, 9223372036854775807.0},
                    "Seed of the random numbers; the same seed gives the same particles.",
                    BODY(&b.seed))),
      required(shapes(bit(Shape::file),
                      words("bodies[].path", {},
                            "Particle file, relative to the scene file: CSV with the header x,y,z "
                            "or x,y,z,vx,vy,vz, or HDF5 with datasets position (N, 3) and, if "
                            "wanted, velocity (N, 3).",
                            BODY(&b.path)))),
      shapes(kEveryShape,
             number("bodies[].velocity", "m/s", kRate,
                    "Initial velocity, added to every particle of the body.", BODY(&b.velocity)))};
}

std::vector<Key> time_keys() {
  return {
      number("gravity", "m/s^2", kRate, "Acceleration of gravity, [x, y, z].", SCENE(&s.gravity)),
      required(number("time.step", "s", kSeconds,
                      "Time of one update, dt. About 0.03 sqrt(h/g) is safe.",
                      SCENE(&s.time.step))),
      required(number("time.end", "s", kSeconds,
                      "Time simulated, rounded to whole updates; at least time.step.",
                      SCENE(&s.time.end))),
      automatic(number("time.adaptive.step_min", "s", {0, 1e9, true},
                       "No step is shorter; at least time.step/1048576. auto: time.step/64.",
                       SCENE(&s.time.adaptive->step_min))),
      number("time.adaptive.cfl", "", {0, 1000, true},
             "The fastest particle moves by at most so many h in a step.",
             SCENE(&s.time.adaptive->cfl)),
      number("time.adaptive.force", "", {0, 1000, true},
             "A step is at most so many sqrt(h/a), a the acceleration of gravity or, if that is "
             "more, the change of the fastest speed between two measures over their time.",
             SCENE(&s.time.adaptive->force))};
}

std::vector<Key> solver_keys() {
  return {
      number("solver.iterations", "", {0, 100000},
             "Sweeps over the constraints per substep; with a tolerance, in a round of them.",
             SCENE(&s.solver.iterations)),
      number("solver.tolerance", "", {0, 1},
             "Rounds of sweeps are repeated while the mean compression that the last sweep found, "
             "before it moved the particles, is above this. 0: one round.",
             SCENE(&s.solver.tolerance)),
      number("solver.max_iterations", "", {1, 100000},
             "Sweeps per substep at most, in whole rounds, where there is a tolerance.",
             SCENE(&s.solver.max_iterations)),
      number("solver.substeps", "", {1, 1000},
             "Time steps of time.step/substeps that share one update's sort and neighbour lists, "
             "as long as little moves meanwhile (pbf plan says how many lists an update makes); "
             "viscosity and vorticity act once per update.",
             SCENE(&s.solver.substeps)),
      words("solver.method", {"jacobi", "chebyshev"},
            "jacobi: every sweep with omega = sor. chebyshev: omega follows Chebyshev's "
            "steps for eigenvalues from 1/2 to 3/2 of Jacobi's matrix, large ones first: less "
            "error for the same work from 2 iterations on.",
            SCENE(choice(s.solver.method))),
      words("solver.kernels", {"consistent", "paper"},
            "consistent: one kernel (Spiky) for density and its gradient. paper: Poly6 for the "
            "density, Spiky for the gradient (Macklin & Mueller 2013).",
            SCENE(choice(s.solver.kernels))),
      words("solver.constraint", {"one_sided", "two_sided"},
            "one_sided: only compression is corrected, C = max(rho/rho0 - 1, 0). two_sided: C = "
            "rho/rho0 - 1, which pulls particles together and needs `tensile` against clusters.",
            SCENE(choice(s.solver.constraint))),
      renamed("solver.relaxation", number("solver.cfm", "", {0, 1e12},
                                          "eps h^2, in the denominator of lambda (constraint force "
                                          "mixing, made dimensionless). "
                                          "Larger is softer.",
                                          SCENE(&s.solver.cfm))),
      renamed(
          "solver.step_length",
          automatic(number(
              "solver.sor", "", {0, 2, true},
              "Factor omega on the position change of one sweep (successive over-relaxation; below "
              "1 it "
              "under-relaxes). "
              "auto: min(1, (2.5 d/h)^2), in two dimensions min(1, (3 d/h)^(4/3)), since more "
              "neighbours need smaller steps, and less where the density is above rest_density.",
              SCENE(&s.solver.sor)))),
      words("solver.boundary", {"density", "clamp"},
            "density: walls count in the density like fluid behind them. clamp: particles are only "
            "put back into the box.",
            SCENE(choice(s.solver.boundary))),
      number(
          "solver.wall_margin", "m", {0, 1e9},
          "Distance to a wall at which particles are clamped. What is nearer at the start is put "
          "there; by more than half of fluid.spacing it is refused.",
          SCENE(&s.solver.wall_margin)),
      number("solver.velocity_damping", "", {0, 1},
             "Factor on every velocity, once per update. 1: no damping.",
             SCENE(&s.solver.velocity_damping)),
      number("solver.speed_limit", "h per update", {0, 1e6},
             "Particles that would move farther than this in time.step, however many steps that is "
             "(time.adaptive), are slowed down to it; how often is counted and reported. 0: no "
             "limit.",
             SCENE(&s.solver.speed_limit)),
      words(
          "solver.prestabilize", {},
          "Steps without time before the first update, while the compression of the start (blocks "
          "in corners, bodies that overlap) would add to the energy: they move particles and "
          "leave velocities alone. false: the start as it is given, as for a file that continues "
          "a run.",
          SCENE(&s.solver.prestabilize)),
      words("solver.fused", {}, "Density and lambda in one loop over the neighbours.",
            SCENE(&s.solver.fused)),
      words("solver.reproducible", {},
            "The GPU gives the CPU's results bit for bit, more slowly. The CPU always does.",
            SCENE(&s.solver.reproducible))};
}

std::vector<Key> force_keys() {
  return {
      number("tensile.k", "h^2", {0, 1000}, "Strength; 1.0e-03 to 1.0e-02 is useful.",
             SCENE(&s.tensile->k)),
      number("tensile.delta_q", "h", {0, 1, true, true},
             "Distance at which the artificial pressure has its strength.",
             SCENE(&s.tensile->delta_q)),
      number("tensile.n", "", {1, 16}, "Exponent.", SCENE(&s.tensile->n)),
      number("viscosity.xsph", "", {0, 10}, "Factor c; stable up to 1.", SCENE(&s.viscosity->xsph)),
      number("vorticity.epsilon", "1/s", {0, 1000},
             "Strength; acts up to twice the rate at which neighbours approach, so that it adds no "
             "more than the flow loses.",
             SCENE(&s.vorticity->epsilon)),
      number("measure_every", "", {1, 2147483647},
             "Updates between two measures (density error, energy, momentum, ...).",
             SCENE(&s.measure_every))};
}

std::vector<Key> guard_keys() {
  return {
      automatic(number("guard.speed", "m/s", {0, 1e30, true},
                       "Fastest speed allowed, in any update. auto: 10 times the sum of the "
                       "fastest speed at the start, that of a fall through the domain, and h "
                       "per update. With solver.speed_limit, only speeds at a measure count.",
                       SCENE(&s.guard->speed))),
      automatic(number("guard.energy", "", {0, 1e30, true},
                       "Growth of kinetic plus potential energy allowed, as a share of what "
                       "it was at the start above the floor and the motion of the whole. auto: "
                       "0.1, and more while a compressed start comes apart.",
                       SCENE(&s.guard->energy))),
      automatic(number("guard.neighbors", "", {0, 2147483647, true},
                       "Neighbours of one particle allowed. auto: 4 times the most at the start, "
                       "at least 16 times those at rest.",
                       SCENE(&s.guard->neighbors)))};
}

ChoiceField compression(Output& output) {
  return {[&output] { return output.gzip ? 1 : 0; }, [&output](int i) { output.gzip = i == 1; }};
}

std::vector<Key> output_keys() {
  return {number("output.every", "s", kSeconds,
                 "Time between frames, rounded to whole updates; at least time.step.",
                 SCENE(&s.output->every)),
          words("output.fields", {"velocity", "density"},
                "Fields besides position and id, as a list.", SCENE(&s.output->fields)),
          words("output.precision", kFloats, "Of floating-point fields in the file.",
                SCENE(choice(s.output->precision))),
          words("output.compression", {"none", "gzip"},
                "gzip: files about 1.45 times smaller, written more slowly.",
                SCENE(compression(*s.output))),
          number("checkpoint.every", "s", {1e-3, 1e9},
                 "Wall time between checkpoints, from which --resume goes on after a crash.",
                 SCENE(&s.checkpoint->every))};
}

std::vector<Key> render_keys() {
  return {
      number("render.every", "s", kSeconds,
             "Time between pictures, rounded to whole frames of `output`; not below output.every.",
             SCENE(&s.render->every)),
      number("render.size", "px", {16, 16384}, "Width and height of a picture.",
             SCENE(&s.render->size)),
      words("render.color", {"speed", "density", "id"}, "What colours the particles.",
            SCENE(choice(s.render->color))),
      automatic(number("render.range", "", {-1e30, 1e30},
                       "Ends of the colour bar, [low, high], in the unit of the field.",
                       SCENE(&s.render->range))),
      automatic(number("render.radius", "m", {0, 1e9, true},
                       "Drawn radius of a particle. auto: half the spacing.",
                       SCENE(&s.render->radius))),
      automatic(number("render.camera.position", "m", kCoordinate,
                       "Where the camera is. auto: outside the longest side; in two dimensions in "
                       "front of the plane.",
                       SCENE(&s.render->camera.position))),
      automatic(number("render.camera.target", "m", kCoordinate,
                       "What the camera looks at. auto: the centre of the domain.",
                       SCENE(&s.render->camera.target))),
      number("render.camera.fov", "deg", {1, 170}, "Vertical field of view.",
             SCENE(&s.render->camera.fov)),
      number("render.camera.orbit", "deg/s", {-36000, 36000},
             "Turn about the vertical axis per second of simulated time.",
             SCENE(&s.render->camera.orbit)),
      words("backend", {"cpu", "cuda"}, "Where the simulation runs.", SCENE(choice(s.backend))),
      words("precision", kFloats, "Of the computation.", SCENE(choice(s.precision))),
      automatic(number("threads", "", {1, 4096},
                       "CPU threads. auto: one below 4096 particles, else one for every 1024, at "
                       "most all that the process may use.",
                       SCENE(&s.threads)))};
}

#undef SCENE
#undef BODY

/// `at` gives the optional of a scene, const or not.
template <class At>
Block optional_block(const char* path, const char* help, At at) {
  return {path, help, true, [at](const Scene& s) { return at(s).has_value(); },
          [at](Scene& s, bool on) {
            if (!on)
              at(s).reset();
            else if (!at(s))
              at(s).emplace();
          }};
}
#define OPTIONAL(expression) \
  [](auto& s) -> auto& { return expression; }

Block on_by_default(Block block) {
  block.on_by_default = true;
  return block;
}

Block plain_block(const char* path, const char* help) {
  return {path, help, false, [](const Scene&) { return true; }, [](Scene&, bool) {}};
}

}  // namespace

const std::vector<Key>& scene_keys() {
  static const std::vector<Key> keys = [] {
    std::vector<Key> all;
    for (const auto& part :
         {top_keys(), domain_keys(), fluid_keys(), body_keys(), time_keys(), solver_keys(),
          force_keys(), guard_keys(), output_keys(), render_keys()})
      all.insert(all.end(), part.begin(), part.end());
    return all;
  }();
  return keys;
}

const std::vector<Block>& scene_blocks() {
  static const std::vector<Block> blocks{
      plain_block("", "A scene."),
      plain_block("domain", "The box that holds the fluid."),
      plain_block("fluid", "The fluid and its particles."),
      plain_block("bodies[]", "A body of fluid."),
      plain_block("time", "Step and end of the simulation."),
      optional_block(
          "time.adaptive",
          "Updates of 2^k steps of time.step/2^k, k chosen at every measure so that the "
          "flow keeps the limits below, or finer: where the guard would stop the run, it "
          "goes back to the last good state and goes on with half the step.",
          OPTIONAL(s.time.adaptive)),
      plain_block("solver", "The constraint solver."),
      optional_block("tensile", "Artificial pressure against clusters (s_corr).",
                     OPTIONAL(s.tensile)),
      optional_block("viscosity", "XSPH viscosity.", OPTIONAL(s.viscosity)),
      optional_block("vorticity", "Vorticity confinement.", OPTIONAL(s.vorticity)),
      on_by_default(optional_block(
          "guard", "Stops a run at a measure that makes no sense, and names the culprit.",
          OPTIONAL(s.guard))),
      optional_block("output", "Frames in run.vtkhdf.", OPTIONAL(s.output)),
      optional_block("checkpoint",
                     "The whole state, now and then and at the end. A run that a signal or the "
                     "wall-time limit stops saves it also without this block.",
                     OPTIONAL(s.checkpoint)),
      optional_block("render", "Pictures, drawn while the simulation runs.", OPTIONAL(s.render)),
      plain_block("render.camera", "The camera of the pictures.")};
  return blocks;
}

#undef OPTIONAL

bool is_present(const Scene& scene, const std::string& block) {
  for (std::size_t dot = block.find('.');; dot = block.find('.', dot + 1)) {
    const Block* part = find_block(block.substr(0, dot));
    if (part && !part->present(scene)) return false;
    if (dot == std::string::npos) return true;
  }
}

const std::vector<std::string>& shape_names() {
  static const Words names{"block", "sphere", "random_box", "file"};
  return names;
}

Scene scene_with_all_blocks() {
  Scene scene;
  for (const Block& block : scene_blocks()) block.set_present(scene, true);
  return scene;
}

}  // namespace pbf::inline scene_module
