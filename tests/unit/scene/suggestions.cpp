// What is suggested for keys and words that are not known: the right one, or nothing.
#include "lib/scene/suggest.h"

#include <algorithm>

#include "lib/scene/keys.h"
#include "lib/scene/shorthand.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

struct Suggested {
  std::string text, message;
};

/// What stands behind "unknown key" for a key of the table's path.
std::string suggested(const std::string& path) {
  const Suggestion s = suggest_key(scene_table(), path);
  std::string text;
  for (const std::string& key : s.keys) text += (text.empty() ? "" : " or ") + key;
  return s.keys.empty() ? s.note : text;
}

}  // namespace

TEST_CASE("suggestions: what other programs call a key") {
  const std::vector<Suggested> cases{
      {"dt", "time.step"},
      {"time.dt", "time.step"},
      {"timeStep", "time.step"},
      {"solver.time_step", "time.step"},
      {"time.duration", "time.end"},
      {"end_time", "time.end"},
      {"dx", "fluid.spacing"},
      {"particle_radius", "fluid.spacing"},
      {"fluid.particleRadius", "fluid.spacing"},
      {"fluid.density", "fluid.rest_density"},
      {"fluid.h", "fluid.smoothing_ratio"},
      {"fluid.viscosity", "viscosity"},
      {"viscosity.mu", "viscosity.kinematic"},
      {"viscosity.strength", "viscosity.xsph"},
      {"num_threads", "threads"},
      {"device", "backend"},
      {"bodies[].type", "bodies[].shape"},
      {"obstacles[].type", "obstacles[].shape"},
      {"obstacles[].motion.omega", "obstacles[].motion.angular"},
      {"solver.omega", "solver.sor"},
      {"output.interval", "output.every"},
      {"every", "output.every or checkpoint.every or render.every"},
      {"iterations", "solver.iterations"},
      {"iteratons", "solver.iterations"},
      {"camera", "render.camera"},
      {"Gravity", "gravity"},
      {"colour", "render.color"},
      {"solver.sovler", ""},  // what is around it is not meant
      {"solver.solver", ""},
      {"solver.solve", ""},
      {"time.tme", "obstacles[].motion.time"},
      {"domain.box", ""},
      {"fluid.fluids", ""},
      {"bodies[].bodies", ""},
      {"bodies[].particles", ""},
      {"obstacles[].obstacle", ""},
      {"obstacles[].motion.motions", ""},
      {"render.camera.rendr", ""},
      {"render.camera.camra", ""},
      {"solver.iteratons", "solver.iterations"},
      {"slover", "solver"},
      {"Base", "base"},
      {"extends", "a scene builds on another one with base: other.yaml at the top of its file"},
      {"output_dir",
       "the folder of a run is given on the command line: pbf run SCENE --out FOLDER"},
      {"output.folder",
       "the folder of a run is given on the command line: pbf run SCENE --out FOLDER"},
  };
  for (const Suggested& c : cases) {
    CAPTURE(c.text);
    CHECK(suggested(c.text) == c.message);
  }
}

TEST_CASE("suggestions: what obstacles and bodies do not have is said, no key of other blocks") {
  for (const char* key : {"density", "Rest_Density", "rhopbody", "free.relative_weight"})
    CHECK(suggested(std::string("obstacles[].") + key) == "obstacles[].free.density");
  for (const char* key : {"mass", "massbody", "weight", "free.weight"})
    CHECK(suggested(std::string("obstacles[].") + key) == "obstacles[].free.mass");
  for (const char* key : {"isDynamic", "floating", "rigid_body"})
    CHECK(suggested(std::string("obstacles[].") + key) == "obstacles[].free");
  CHECK(contains(suggested("obstacles[].inertia"), "follow from its shape"));
  CHECK(contains(suggested("obstacles[].free.inertia"), "follow from the shape"));
  CHECK(contains(suggested("obstacles[].free.friction"), "without friction and without bounce"));
  CHECK(suggested("obstacles[].free.omega") == "obstacles[].free.angular");
  CHECK(suggested("obstacles[].free.linearvelini") == "obstacles[].free.velocity");
  CHECK(suggested("obstacles[].free.translationDOF") == "obstacles[].free.lock");
  CHECK(suggested("floatings") == "obstacles");
  for (const char* key : {"material", "restitution"})
    CHECK(contains(suggested(std::string("obstacles[].") + key), "obstacles are rigid"));
  CHECK(suggested("obstacles[].no_slip") == "obstacles[].friction");
  for (const char* key : {"fixed", "static", "moving"})
    CHECK(contains(suggested(std::string("obstacles[].") + key), "stand still unless"));
  for (const char* key : {"velocity", "speed", "v"})
    CHECK(suggested(std::string("obstacles[].") + key) ==
          "obstacles[].motion.velocity or obstacles[].free.velocity");
  CHECK(suggested("obstacles[].angular_velocity") ==
        "obstacles[].motion.angular or obstacles[].free.angular");
  CHECK(suggested("obstacles[].motion.frequency") == "obstacles[].motion.period");
  CHECK(suggested("tank_motion.frequency") == "tank_motion.period");
  CHECK(suggested("obstacles[].motion.speed") == "obstacles[].motion.velocity");
  for (const char* key : {"density", "mass", "viscosity", "material"})
    CHECK(contains(suggested(std::string("bodies[].") + key), "all bodies are of one fluid"));
  CHECK(contains(suggested("bodies[].motion"), "solids that move as told are obstacles"));
  CHECK(suggested("domain.no_slip") == "domain.friction");
  CHECK(suggested("domain.walls") == "domain.open");
  CHECK(suggested("domain.pbc") == "domain.periodic");
  CHECK(suggested("viscosity.dynamic") == "viscosity.kinematic");
  CHECK(suggested("viscosity.kind") == "viscosity.kinematic");
  CHECK(contains(suggested("fluid.speed_of_sound"), "there is no equation of state"));
  CHECK(suggested("obstacles[].diameter") == "obstacles[].radius");
  CHECK(suggested("bodies[].diameter") == "bodies[].radius");
  CHECK(contains(suggested("bodies[].height"), "a cylinder the ends of its axis"));
  CHECK(contains(suggested("tank_motion.velocity"), "a tank swings"));
  // In other blocks these words mean what they did.
  CHECK(suggested("density") == "fluid.rest_density");
  CHECK(suggested("fluid.density") == "fluid.rest_density");
  CHECK(suggested("bodies[].v0") == "bodies[].velocity");
}

TEST_CASE("suggestions: walls by the names that people give them") {
  const std::vector<std::string> faces(kFaceNames.begin(), kFaceNames.end());
  CHECK(nearest_choice("bottom wall", faces) == "z_min");
  CHECK(nearest_choice("RIGHT_FACE", faces) == "x_max");
  CHECK(nearest_choice("ceiling", faces) == "z_max");
  CHECK(nearest_choice("north", faces) == "y_max");
  CHECK(nearest_choice("wall", faces) == "");
  CHECK(nearest_choice("side", faces) == "");
}

TEST_CASE("suggestions: nothing where nothing is near") {
  for (const char* path :
       {"qqqqqqqqqqqq", "gui", "mpi", "x", "", "foo", "solver.abc", "bodies[].size", "temperature",
        "solver.preconditioner", "fluid.name_of_it", "cfl_number", "logbook", "tes", "wind"})
    CHECK(suggested(path) == "");
}

TEST_CASE("suggestions: words") {
  using Words = std::vector<std::string>;
  CHECK(nearest_choice("gpu", Words{"cpu", "cuda"}) == "cuda");
  CHECK(nearest_choice("GPU", Words{"cpu", "cuda"}) == "cuda");
  CHECK(nearest_choice("CUDA", Words{"cpu", "cuda"}) == "cuda");
  CHECK(nearest_choice("cup", Words{"cpu", "cuda"}) == "cpu");
  CHECK(nearest_choice("opencl", Words{"cpu", "cuda"}) == "");
  CHECK(nearest_choice("hip", Words{"cpu", "cuda"}) == "");
  CHECK(nearest_choice("npu", Words{"cpu", "cuda"}) == "");
  CHECK(nearest_choice("single", Words{"float", "double"}) == "float");
  CHECK(nearest_choice("fp64", Words{"float", "double"}) == "double");
  CHECK(nearest_choice("half", Words{"float", "double"}) == "");
  CHECK(nearest_choice("box", Words{"block", "sphere", "random_box", "file"}) == "block");
  CHECK(nearest_choice("block", Words{"plane", "box", "sphere"}) == "box");
  CHECK(nearest_choice("cone", Words{"plane", "box", "sphere"}) == "");
  CHECK(nearest_word("", Words{"cpu", "cuda"}) == "");
  CHECK(nearest_word(std::string(5000, 'c'), Words{"cpu", "cuda"}) == "");
}

TEST_CASE("suggestions: every synonym leads to keys of the scene, and is none of its block's") {
  for (const KeySynonym& s : synonyms().keys) {
    CHECK((!s.keys.empty() || !s.note.empty()));
    for (const std::string& path : s.keys) {
      CAPTURE(path);
      const bool form = scene_table().find_key(path) == nullptr &&
                        gravity_table().find_key(path) != nullptr;  // of a mapping for a value
      const KeyTable& table = form ? gravity_table() : scene_table();
      const Key* key = table.find_key(path);
      const Block* block = scene_table().find_block(path);
      if (block == nullptr) block = scene_table().find_block(path + "[]");
      CHECK((key != nullptr || block != nullptr));
      for (const std::string& word : s.written) {
        CAPTURE(word);
        CHECK(word.find_first_of("_- ABCDEFGHIJKLMNOPQRSTUVWXYZ") == std::string::npos);
        const std::string in = !s.in.empty() ? s.in : key ? key->block->path : block->parent->path;
        CHECK(table.find_key(join(in, word)) == nullptr);
      }
    }
  }
}

TEST_CASE("suggestions: in messages, with the entry of the list") {
  const std::string body = "shape: block, min: [0, 0, 0], max: [1, 1, 0.5]";
  const std::vector<Suggested> cases{
      {"dt: 0.01\n", "6:1: dt: unknown key, did you mean time.step?"},
      {"particle_radius: 0.01\n",
       "unknown key, did you mean fluid.spacing? It is the distance of neighboring particles, a "
       "particle's diameter"},
      {"output: {dir: out}\n", "output.dir: unknown key"},
      {"out: here\n", "out: unknown key; the folder of a run is given on the command line"},
      {"viscosity: 0.1\n",
       "viscosity: expected a block {xsph: ...}, got \"0.1\"; write viscosity: {xsph: 0.1} (Factor "
       "c, not a viscosity in Pa s or m^2/s; stable up to 1"},
      {"domain.open: top\n", "expected a list of words such as [z_max], got \"top\""},
      {"tank_motion: sin\n", "; write tank_motion: {kind: sine, ...}"},
      {"tank_motion: {kind: sine, axis: y, amplitude: 1, period: 2}\n",
       "tank_motion.axis: expected 3 numbers [x, y, z] or auto, got \"y\"; write [0, 1, 0]"},
      {"tank_motion: roll.csv\n", "; write tank_motion: {kind: file, path: roll.csv}"},
      {"fluid.viscosity: 0.001\n", "did you mean viscosity? It is a block at the top of the file"},
      {"domain.cyclic: [x]\n",
       "did you mean domain.periodic? It lists the axes whose faces are joined"},
      {"viscosity: 100\n", "got \"100\"; write {} or on"},  // out of its range
      {"output: 0.02\n", "write output: {every: 0.02}"},
      {"output: out/here\n", "expected a block {every: ...}, got \"out/here\"; write {} or on"},
      {"solver: {fused: yes}\n", "expected true or false, got \"yes\"; write true"},
      {"solver: {levels: true}\n", "\"true\" is not one of off, auto, on; did you mean on?"},
      {"domain.open: [top]\n", "did you mean z_max?"},
  };
  for (const Suggested& c : cases) {
    CAPTURE(c.text, parse_error(kMinimal + c.text));
    CHECK(contains(parse_error(kMinimal + c.text), c.message));
  }
  CHECK(contains(parse_error(with_bodies("[{" + body + "}, {" + body + ", vel: [1, 0, 0]}]")),
                 "bodies[1].vel: unknown key, did you mean bodies[1].velocity?"));
}

}  // namespace pbf::scene_test
