// resolved_yaml, reference_yaml and json_schema speak of the same table as the loader.
#include <cmath>
#include <limits>

#include "lib/scene/keys.h"
#include "lib/scene/number.h"
#include "lib/scene/value.h"
#include "tests/support/catch.h"
#include "tests/support/flume.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

/// A scene in which no field has its default.
Scene unlike_default() {
  Scene s;
  s.dimensions = 2;
  s.name = "a \"quoted\\ name: # with, signs";
  s.domain = {{-1.0 / 3, -0.02, 1e-7}, {0.1 + 0.2, 0.06, 3}, {"x_min", "z_max"}};
  s.fluid = {998.2, 0.1 / 3, 3.1072325059538572, 1.0 / 30};
  Body block;
  block.min = {-0.3, -1, 0.5};
  block.max = {0.1, 1, 1.5};
  block.velocity = {-1e11, 0, 1.0 / 7};
  Body sphere;
  sphere.shape = Shape::sphere;
  sphere.center = {0, 0.1, 1};
  sphere.radius = 0.2;
  Body random;
  random.shape = Shape::random_box;
  random.min = {0, -5, 1};
  random.max = {0.1, 6, 2};
  random.count = 123456789;
  random.seed = 9223372036854775807u;
  Body file;
  file.shape = Shape::file;
  file.path = "odd name #1: [x].csv";
  Body drum;
  drum.shape = Shape::cylinder;
  drum.from = {0, -1.0 / 3, 1};
  drum.to = {0, 1.0 / 7, 1};
  drum.radius = 0.1;
  Body hull;
  hull.shape = Shape::mesh;
  hull.path = "odd name #3: hull.stl";
  hull.scale = 1e-3 / 7;
  hull.turn_axis = {0, -1.0 / 3, 1e5};
  hull.turn_angle = -30.0 / 7;
  hull.translate = {1.0 / 3, 0, -1e-7};
  s.bodies = {block, sphere, random, file, drum, hull};
  s.domain.loads = true;
  s.domain.friction = 1.0 / 3;
  s.domain.friction_on = {"z_min", "x_max"};
  Obstacle plane;
  plane.name = "odd name #1: [a], \"b\"";
  plane.shape = obstacle_keys::Plane{{1.0 / 3, 0, -1e-7}, {-1.0 / 7, 0, 1e5}};
  Obstacle box;
  box.name = "box";
  box.shape =
      obstacle_keys::Box{{-0.1, -5, 1.0 / 3}, {0.1 + 0.2, 6, 0.5}, {0, -1.0 / 3, 0}, -360.0 / 7};
  box.loads = true;
  box.friction = 1.0 / 7;
  Obstacle ball;
  ball.name = "x_minimum";
  ball.shape = obstacle_keys::Sphere{{1e-12, 0.02, 2.0 / 3}, 1.0 / 9};
  Obstacle cylinder;
  cylinder.name = "off";
  cylinder.shape = obstacle_keys::Cylinder{{{0.1, -1.0 / 3, 0.2}, {0.1, 1.0 / 3, 0.2}, 0.2}};
  Obstacle capsule;
  capsule.name = "7";
  capsule.shape = obstacle_keys::Capsule{{{0.1, -1.0 / 3, 0.2}, {-1e6, -1.0 / 3, 0.3}, 0.2}};
  capsule.loads = true;
  plane.motion =
      Motion{{}, {}, MotionKind::velocity, {1.0 / 3, 0, -2}, {0, 1e3 / 7, 0}, "", {}, {}};
  box.motion.emplace();
  box.motion->axis = Double3{0, -1.0 / 7, 0};
  box.motion->pivot = Double3{0.1, 0.2, 1.0 / 3};
  box.motion->amplitude = -30.0 / 7;
  box.motion->period = 1.0 / 3;
  box.motion->phase = 1.0 / 7;
  box.motion->ramp = 1e-7;
  ball.motion.emplace();
  ball.motion->kind = MotionKind::file;
  ball.motion->path = "odd name #2: {x}.csv";
  s.obstacles = {plane, box, ball, cylinder, capsule};
  Emitter jet;
  jet.name = "odd name #3: {e}";
  jet.center = {0.1, 0.02, 1.5};
  jet.normal = {-1.0 / 3, 0, 1e-7};
  jet.radius = 1.0 / 9;
  jet.speed = 1.0 / 7;
  jet.start = 1.0 / 3;
  jet.end = 1e3 / 7;
  Emitter slot;
  slot.name = "slot";
  slot.shape = NozzleShape::rectangle;
  slot.center = {0, 0.02, 1};
  slot.normal = {0, 0, -1e5};
  slot.size = {1.0 / 7};
  slot.path = "odd name #4: [v].csv";
  s.emitters = {jet, slot};
  Sponge end;
  end.name = "end", end.min = {-1.0 / 7, -0.02, 0.1}, end.max = {0.25, 0.06, 2};
  end.toward = "z_min", end.rate = 1.0 / 7, end.profile = 3, end.axes = {"z", "x"};
  s.damping = {end};
  Comparison c;
  c.name = "post", c.load = "z_min", c.component = "torque_y", c.data = "post.csv",
  c.column = "M_mNm";
  c.time_column = "T", c.time_scale = 0.5, c.scale = 1e-3, c.offset = 0.25, c.average = 0.02;
  c.between = {0.5, 0.75}, c.lag = "fit", c.lag_range = {-0.25, 0.5}, c.threshold = 0.125;
  Comparison front;
  front.log = "front_x", front.data = "other/run.vtkhdf", front.lag = "post";
  s.compare = {c, front};
  Sink drain;
  drain.name = "drain, \"b\"";
  drain.min = {-1.0 / 3, -1, 2};
  drain.max = {1.0 / 7, 1, 1e5};
  s.sinks = {drain};
  s.capacity = 123456789;
  s.gravity = {1.0 / 3, 0, 5e-300};
  s.time = {1.0 / 60, 500.0 / 60, AdaptiveTime{1e-4, 0.3, 0.2}, -1.0 / 7};
  s.time.order = TimeOrder::first;
  s.tank_motion.emplace();
  s.tank_motion->direction = Double3{-1.0 / 3, 0, 1e5};
  s.tank_motion->amplitude = 1.0 / 7;
  s.solver.iterations = 7;
  s.solver.substeps = 3;
  s.solver.tolerance = 0.001;
  s.solver.max_iterations = 24;
  s.solver.method = SolverMethod::chebyshev;
  s.solver.levels = LevelsMode::automatic;
  s.solver.kernels = KernelMode::paper;
  s.solver.constraint = ConstraintMode::two_sided;
  s.solver.cfm = 100.0 / 3;
  s.solver.sor = 0.7;
  s.solver.hyperviscosity = 0.2;
  s.solver.boundary = BoundaryMode::clamp;
  s.solver.wall_margin = 0.01;
  s.solver.velocity_damping = 0.999;
  s.solver.speed_limit = 0.25;
  s.solver.prestabilize = false;
  s.solver.fused = false;
  s.solver.reproducible = true;
  s.tensile = Tensile{0.01, 0.2, 6};
  s.viscosity = Viscosity{0, 1e-6 / 7};
  s.vorticity = Vorticity{2.5};
  s.settle = Settle{1.0 / 7, Double3{1.0 / 3, 0, -1e5}};
  s.measure_every = 17;
  s.summary_from = 1.0 / 7;
  s.summary = {"load/z_min/impulse_x", "load/7/force_z/mean"};
  s.guard = GuardSettings{1000.5, 0.25, 999};
  s.output = Output{1.0 / 30, 0.0375, {"density"}, Precision::dbl, Compression::gzip};
  s.render = Render{0.5,
                    {640, 480},
                    RenderStyle::surface,
                    ColorBy::density,
                    std::array<double, 2>{900, 1100},
                    0.02,
                    Camera{Double3{1, 2, 3}, Double3{4, 5, 6}, 60, -12.5}};
  s.backend = Backend::cuda;
  s.precision = Precision::dbl;
  s.threads = 12;
  return s;
}

/// Keys of which not every object has all.
bool of_list(const Key& key) { return key.block->list_around() || key.block->kind; }

/// Defaults alone, every optional block on.
Scene scene_with_all_blocks() {
  Scene scene;
  scene_table().make_all_present(object(scene));
  return scene;
}

}  // namespace

TEST_CASE("resolved scene: reads back to an equal scene, bit for bit") {
  const Scene plain = parse(kMinimal), other = unlike_default(), all = parse(reference_yaml()),
              periodic = parse(kMinimal, {"domain.periodic=[x, y]"});
  Scene files = parse(kMinimal);  // refused beside kernels: paper
  obstacle_keys::Mesh mesh;
  mesh.path = "odd: hull {1}.stl", mesh.translate = {1.0 / 3, -2, 1e-9}, mesh.scale = 1e-3 / 3;
  mesh.turn_axis = {1.0 / 7, 0, -1}, mesh.turn_angle = 100.0 / 3;
  obstacle_keys::Heights bed;
  bed.path = "../bed.csv", bed.translate = {0, 0, -1.0 / 3};
  files.obstacles.resize(2);
  files.obstacles[0].name = "hull", files.obstacles[0].shape = mesh;
  files.obstacles[1].name = "bed", files.obstacles[1].shape = bed;
  Scene sea =
      parse(flume_text("kind: irregular_waves, direction: [1, 0, 0], height: 0.06, period: 2"));
  Motion& m = *sea.obstacles[0].motion;
  m.height = 0.2 / 3, m.depth = 0.9 / 3.0000001, m.gain = 1.0 / 3, m.start = 1e-7;
  m.spectrum = WaveSpectrum::pierson_moskowitz, m.gamma = 10.0 / 3;
  m.band = std::array{0.2 / 3, 10.0 / 3}, m.seed = 9223372036854775807u, m.repeat = 1e3 / 7;
  m.amplitudes = WaveAmplitudes::random, m.ramp = 0;
  Scene group = parse(flume_text(
      "kind: focused_waves, direction: [1, 0, 0], crest: 0.06, period: 2, place: 6, time: 12"));
  Motion& f = *group.obstacles[0].motion;
  f.crest = 0.2 / 3, f.place = 20.0 / 3, f.time = 1e2 / 7, f.components = 7, f.phase = -1.0 / 3;
  Scene crests = parse(flume_text("kind: solitary_waves, direction: [1, 0, 0], heights: [0.06]"));
  Motion& c = *crests.obstacles[0].motion;
  c.heights = {0.2 / 3, 0.1 / 3}, c.times = {1.0 / 3, 1e2 / 7}, c.breaking = true;
  c.theory = SolitaryTheory::boussinesq;
  for (const Scene& s : {plain, other, all, periodic, files, sea, group, crests}) {
    const std::string text = resolved_yaml(s);
    CAPTURE(text);
    CHECK(parse(text) == s);
    CHECK(resolved_yaml(parse(text)) == text);
  }
  CHECK_FALSE(plain == other);
}

TEST_CASE("resolved scene: each key of the table makes a difference when it changes") {
  // unlike_default differs from the default in every key, so a key that the table forgets or maps
  // to the wrong field is seen here.
  Scene other = unlike_default();
  other.domain.periodic = {"z"};  // refused beside its obstacles and gravity
  const Scene defaults = scene_with_all_blocks();
  for (const Key& key : scene_table().keys) {
    if (of_list(key) || key.path == "name") continue;
    CAPTURE(key.path);
    CHECK(value_text(key, object(other)) != value_text(key, object(defaults)));
  }
}

TEST_CASE("resolved scene: absent blocks are written as off") {
  const std::string text = resolved_yaml(parse(kMinimal));
  for (const char* block : {"tensile", "viscosity", "vorticity", "output", "render"})
    CHECK(contains(text, std::string("\n") + block + ": off\n"));
  CHECK(contains(text, "\nguard:\n"));  // on where the scene does not mention it
  const std::string off = resolved_yaml(parse(kMinimal + "guard: off\n"));
  CHECK(contains(off, "\nguard: off\n"));
  CHECK_FALSE(parse(off).guard);
  CHECK_FALSE(contains(text, "camera"));
}

TEST_CASE("minimal scene: everything not given has the default of scene.h") {
  Scene s;
  s.domain = {{0, 0, 0}, {1, 1, 1}, {}};
  s.fluid.spacing = 0.1;
  s.bodies.resize(1);
  s.bodies[0].max = {1, 1, 0.5};
  s.time = {0.01, 1, {}};
  CHECK(parse(kMinimal) == s);
}

TEST_CASE("blocks given as {}: on, with the defaults of scene.h") {
  const Scene s = parse(kMinimal +
                        "tensile: {}\nviscosity: {}\nvorticity: {}\noutput: {}\n"
                        "render: {camera: {}}\n");
  CHECK(s.tensile == Tensile{});
  const Scene words = parse(kMinimal + "tensile: on\noutput: true\nvorticity: false\n");
  CHECK(words.tensile == Tensile{});
  CHECK(words.output == Output{});
  CHECK_FALSE(words.vorticity);
  CHECK(s.viscosity == Viscosity{});
  CHECK(s.vorticity == Vorticity{});
  CHECK(s.output == Output{});
  CHECK(s.render == Render{});
}

TEST_CASE("reference scene: the committed file is what the code writes") {
  CHECK(read_file(PBF_SOURCE_DIR "/configs/reference.yaml") == reference_yaml());
}

TEST_CASE("page of keys: the committed file is what the code writes, and has every key") {
  const std::string page = reference_markdown();
  CHECK(read_file(PBF_SOURCE_DIR "/configs/keys.md") == page);
  for (const Key& key : scene_table().keys) {
    CAPTURE(key.path);
    CHECK(contains(page, "\n| `" + key.leaf() + "` | "));
  }
}

TEST_CASE("reference scene: documents every key, and optional keys stand at their defaults") {
  const std::string text = reference_yaml();
  const Scene s = parse(text), defaults = scene_with_all_blocks();
  for (const Key& key : scene_table().keys) {
    CAPTURE(key.path);
    CHECK(contains(text, key.leaf() + ": "));
    CHECK_FALSE(key.help.empty());
    const bool numeric = !unit_text(key).empty();
    CHECK((!numeric || (std::isfinite(key.range.min) && std::isfinite(key.range.max))));
    if (!key.required && key.path != "name" && !of_list(key))
      CHECK(value_text(key, object(s)) == value_text(key, object(defaults)));
  }
  std::size_t start = 0;
  for (std::size_t end; (end = text.find('\n', start)) != std::string::npos; start = end + 1)
    CHECK((end - start <= 105));
}

TEST_CASE("table of keys: every default lies in its own range") {
  const Scene defaults = scene_with_all_blocks();
  for (const Key& key : scene_table().keys) {
    if (key.required) continue;
    Scene scene = scene_with_all_blocks();
    Body body;
    Obstacle obstacle;
    obstacle.motion.emplace();
    obstacle.free.emplace();
    Emitter emitter;
    Comparison comparison;
    Sponge sponge;
    scene_module::Gauge gauge;
    Node node;
    const Block* list = key.block->list_around();
    const bool of_body = list && list->path == "bodies[]", of_scene = !list,
               of_emitter = list && list->path == "emitters[]",
               of_comparison = list && list->path == "compare[]",
               of_sponge = list && list->path == "damping[]",
               of_gauge = list && list->path == "gauges[]";
    const std::string text = value_text(key, of_scene ? object(defaults) : key.standard);
    if (text[0] == '[') continue;  // lists: read back as part of the reference scene
    node.kind = Node::Kind::scalar;
    node.text = text;
    CAPTURE(key.path, text);
    CHECK(read_field(key, node,
                     key.field(of_scene        ? object(scene)
                               : of_body       ? object(body)
                               : of_emitter    ? object(emitter)
                               : of_comparison ? object(comparison)
                               : of_sponge     ? object(sponge)
                               : of_gauge      ? object(gauge)
                                               : object(obstacle)))
              .empty());
  }
}

TEST_CASE("schema: balanced JSON that has every key and refuses the others") {
  const std::string text = json_schema();
  int depth = 0, lowest = 1;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (in_string && text[i] == '\\')
      ++i;
    else if (text[i] == '"')
      in_string = !in_string;
    else if (!in_string && (text[i] == '{' || text[i] == '['))
      ++depth;
    else if (!in_string && (text[i] == '}' || text[i] == ']'))
      --depth;
    if (i + 2 < text.size()) lowest = std::min(lowest, depth);
  }
  CHECK(depth == 0);
  CHECK(lowest == 1);
  CHECK_FALSE(in_string);
  for (const Key& key : scene_table().keys)
    CHECK(contains(text, std::string("\"").append(key.leaf()).append("\": {")));
  std::size_t objects = 0, closed = 0;
  for (std::size_t p = 0; (p = text.find("\"type\": \"object\"", p)) != std::string::npos; ++p)
    ++objects;
  for (std::size_t p = 0;
       (p = text.find("\"additionalProperties\": false", p)) != std::string::npos; ++p)
    ++closed;
  CHECK(objects == closed);
  // One object for every shape of a body, of an emitter and of an obstacle, that it is free, each
  // kind of its motion, and every kind of a gauge; and what gravity may be.
  const auto kinds = [](const char* key) { return scene_table().find_key(key)->choices.size(); };
  CHECK(objects == scene_table().blocks.size() - 7 + kinds("bodies[].shape") +
                       kinds("emitters[].shape") +
                       kinds("obstacles[].shape") * (2 + kinds("obstacles[].motion.kind")) +
                       kinds("tank_motion.kind") + kinds("gauges[].kind") + 1);
}

TEST_CASE("numbers: the text of a double reads back to the same double") {
  for (double v : {0.0, 0.1, 1.0 / 3, 1e-5, 1e-4, 9999999.0, 1e7, 123456789.0, 1e22, 5e-300, 1e300,
                   -2.5, std::nextafter(1.0, 2.0), std::numeric_limits<double>::max(),
                   std::numeric_limits<double>::min()}) {
    double back = 0;
    CAPTURE(v, to_text(v));
    CHECK(read_number(to_text(v), back) == NumberError::none);
    CHECK(back == v);
  }
  CHECK(to_text(0.1) == "0.1");
  CHECK(to_text(1e-5) == "1.0e-05");  // YAML 1.1 takes 1e-05 for text
  CHECK(to_text(1000.0) == "1000");
}

}  // namespace pbf::scene_test
