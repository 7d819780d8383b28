// plan, render, info, config and the help texts.
#include <sstream>

#include "lib/io/run_file.h"
#include "tests/support/catch.h"
#include "tests/support/process.h"

using namespace pbf::test;
namespace fs = std::filesystem;

TEST_CASE("the help of every command has an example, and the main help the exit codes") {
  const Scratch folder;
  const Outcome main = pbf::test::pbf({"--help"}, folder.path());
  CHECK(main.code == 0);
  for (const char* part : {"Exit codes", "  75 ", "Example: pbf run"}) CHECK(has(main.out, part));
  for (const char* command : {"run", "plan", "render", "config", "study", "stability", "info"}) {
    CAPTURE(command);
    CHECK(has(main.out, std::string("\n  ") + command + " "));
    const Outcome o = pbf::test::pbf({command, "--help"}, folder.path());
    CHECK(o.code == 0);
    CHECK(has(o.out, "Example"));
    CHECK(has(o.out, std::string("\n  pbf ") + command));
  }
}

TEST_CASE("config --example prints the reference scene of the repository, which pbf accepts") {
  const Scratch folder;
  const Outcome o = pbf::test::pbf({"config", "--example"}, folder.path());
  CHECK(o.code == 0);
  CHECK(o.out == read_text(fs::path(PBF_SOURCE_DIR) / "configs/reference.yaml"));
  CHECK(pbf::test::pbf({"plan", folder.write("r.yaml", o.out)}, folder.path()).code == 0);
}

TEST_CASE("config --schema prints a JSON Schema with the keys of a scene") {
  const Scratch folder;
  const Outcome o = pbf::test::pbf({"config", "--schema"}, folder.path());
  CHECK(o.code == 0);
  CHECK(o.out.rfind("{", 0) == 0);
  CHECK(has(o.out, "\"smoothing_ratio\""));
}

TEST_CASE("config --stages prints the list of stages that the plots read") {
  const Scratch folder;
  const Outcome o = pbf::test::pbf({"config", "--stages"}, folder.path());
  CHECK(o.code == 0);
  CHECK(o.out == read_text(fs::path(PBF_SOURCE_DIR) / "tools/pbf_tools/data/stages.json"));
  CHECK(has(o.out, "\"group\": \"grid/neighbors\""));
}

TEST_CASE("info names version, libraries and devices") {
  const Scratch folder;
  const Outcome o = pbf::test::pbf({"info"}, folder.path());
  CHECK(o.code == 0);
  for (const char* part : {"commit ", "HDF5 ", "yaml-cpp ", "cpu ", "threads ", "cuda "})
    CHECK(has(o.out, part));
  const Outcome version = pbf::test::pbf({"--version"}, folder.path());
  CHECK(o.out.rfind(version.out.substr(0, version.out.find('\n')), 0) == 0);
}

TEST_CASE("plan says first what is asked first, and lists arrays only when it is asked to") {
  const Scratch folder;
  const std::string scene =
      folder.write("s.yaml", tiny_scene("threads: 1\nrender: {every: 0.05, size: [320, 240]}\n"));
  const std::vector<std::string> nothing{"PBF_CALIBRATION=" + (folder / "none.csv").string()};
  const auto plan = [&](const Args& more) {
    Args args{"plan", scene};
    args.insert(args.end(), more.begin(), more.end());
    return pbf::test::pbf(args, folder.path(), nothing);
  };
  const Outcome text = plan({});
  REQUIRE(text.code == 0);
  std::istringstream lines(text.out);
  std::vector<std::string> head(6);
  for (std::string& line : head) std::getline(lines, line);
  CAPTURE(text.out);
  CHECK(has(head[0], ": 64 particles, spacing d = "));
  CHECK(has(head[0], " m, smoothing length h = "));
  CHECK(has(head[1], "  time      0.1 s in 20 updates of 0.005 s; dt sqrt(g/h) = "));
  CHECK(has(head[1], "(time.step: auto takes 0.03 at most)"));
  CHECK(has(head[2], "  run time  below 0.1 s for the updates"));
  CHECK(has(head[3], " MiB on the host; cpu float, 1 thread"));
  CHECK(has(head[4], "  disk      "));
  CHECK(has(head[4], "run.vtkhdf"));
  CHECK_FALSE(has(text.out, "emitted position"));
  CHECK(has(text.out, "--arrays lists every array"));
  // Warnings come before the rest.
  const Outcome warned = plan({"--set", "output.every=5", "--set", "render=off"});
  CHECK(has(warned.out, "\nwarnings\n"));
  CHECK(warned.out.find("\nwarnings\n") < warned.out.find("\nfiles\n"));
  const Outcome arrays = plan({"--arrays"});
  CHECK(has(arrays.out, "emitted position"));
  CHECK(has(arrays.out, "program and libraries"));
  CHECK_FALSE(has(arrays.out, "--arrays lists"));
  for (const char* other : {"--json", "--resolved"}) CHECK(plan({"--arrays", other}).code == 2);
  // Without a calibration there is no guess for a device.
  const Outcome device = plan({"--set", "backend=cuda"});
  CHECK(has(device.out, "  run time  not known; pbf bench --calibrate --backend cuda measures"));
  CHECK(has(device.out, " on the device; cuda float\n"));
  CHECK(has(plan({"--set", "backend=cuda", "--json"}).out, "\"run_time_s\":null"));
}

TEST_CASE("plan runs nothing, names what is left out, and prints a scene that resolves to itself") {
  const Scratch folder;
  const std::string scene = folder.write("tiny.yaml", tiny_scene());
  const Outcome text = pbf::test::pbf({"plan", scene}, folder.path());
  CHECK(text.code == 0);
  CHECK(has(text.out, "64 particles"));
  CHECK(has(text.out, "left out"));
  CHECK(has(text.out, "no key viscosity"));
  const Outcome with =
      pbf::test::pbf({"plan", scene, "--set", "viscosity.xsph=0.1"}, folder.path());
  CHECK_FALSE(has(with.out, "no key viscosity"));
  CHECK(pbf::test::pbf({"plan", scene, "--json"}, folder.path()).out.rfind("{", 0) == 0);
  const Outcome resolved = pbf::test::pbf({"plan", scene, "--resolved"}, folder.path());
  const std::string again = folder.write("again.yaml", resolved.out);
  CHECK(pbf::test::pbf({"plan", again, "--resolved"}, folder.path()).out == resolved.out);
  CHECK_FALSE(fs::exists(folder / "out"));
}

TEST_CASE("a scene too large for the memory of any machine exits 4 before anything is made") {
  const Scratch folder;
  const std::string scene = folder.write("tiny.yaml", tiny_scene());
  // 2.1e9 particles can be numbered; with 4188 neighbors each they need 40 TB.
  const Outcome o = pbf::test::pbf(
      {"run", scene, "--set", "fluid.spacing=0.00031", "--set", "fluid.smoothing_ratio=10"},
      folder.path());
  CAPTURE(o.err);
  CHECK(o.code == 4);
  CHECK(has(o.err, "memory"));
  CHECK(has(o.err, "fluid.spacing"));
  CHECK_FALSE(fs::exists(folder / "out"));
}

#ifdef PBF_HAS_RENDER
TEST_CASE("pictures are drawn by a run and, later, from its file", "[slow]") {
  const Scratch folder;
  const std::string scene = folder.write(
      "tiny.yaml", tiny_scene("render: {every: 0.04, size: [64, 48], color: density}\n"));
  const Outcome run = pbf::test::pbf(
      {"run", scene, "--out", "o", "--set", "output.fields=[velocity]"}, folder.path());
  if (run.code == 4) {  // pictures are the one feature whose library is looked for at run time
    REQUIRE(has(run.err, "OSMesa"));
    PBF_SKIP("no off-screen GL library");
  }
  CAPTURE(run.err);
  REQUIRE(run.code == 0);
  for (const char* name : {"frame_000000.png", "frame_000002.png", "frame_000004.png"})
    CHECK(fs::file_size(folder / "o/frames" / name) > 100);
  CHECK(std::distance(fs::directory_iterator(folder / "o/frames"), {}) == 3);
  const pbf::RunReader reader((folder / "o/run.vtkhdf").string());
  CHECK(reader.fields() == std::vector<std::string>{"velocity"});  // density was for pictures only

  const auto render = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"render", "o/run.vtkhdf"});
    return pbf::test::pbf(more, folder.path());
  };
  const Outcome drawn = render({"--frames", "1:-1:2", "--color", "speed", "--range", "0,2",
                                "--size", "80x60", "--camera", "position=3,-3,2;fov=40"});
  CAPTURE(drawn.err);
  CHECK(drawn.code == 0);
  CHECK(fs::exists(folder / "o/render/frame_000001.png"));
  CHECK(fs::exists(folder / "o/render/frame_000003.png"));
  CHECK(std::distance(fs::directory_iterator(folder / "o/render"), {}) == 2);
  // The same number is the same moment.
  CHECK(render({"--frames", "2", "--color", "speed", "--out", "again"}).code == 0);
  CHECK(pbf::test::pbf({"run", scene, "--out", "fast", "--set", "render.color=speed", "--set",
                        "output.fields=[velocity]"},
                       folder.path())
            .code == 0);
  CHECK(read_text(folder / "again/frame_000002.png") ==
        read_text(folder / "fast/frames/frame_000002.png"));

  // In the other style too.
  CHECK(
      render({"--frames", "4", "--style", "surface", "--color", "speed", "--out", "again"}).code ==
      0);
  CHECK(pbf::test::pbf({"run", scene, "--out", "water", "--set", "render.style=surface", "--set",
                        "render.color=speed", "--set", "output.fields=[velocity]"},
                       folder.path())
            .code == 0);
  CHECK(read_text(folder / "again/frame_000004.png") ==
        read_text(folder / "water/frames/frame_000004.png"));
  CHECK(read_text(folder / "again/frame_000004.png") !=
        read_text(folder / "fast/frames/frame_000004.png"));

  const std::vector<std::pair<std::vector<std::string>, std::string>> bad{
      {{"--color", "density"}, "density"}, {{"--frames", "9"}, "0 to 5"},
      {{"--frames", "4:2"}, "--frames"},   {{"--frames", "a"}, "--frames"},
      {{"--size", "80"}, "--size"},        {{"--size", "8x8"}, "--size"},
      {{"--range", "2,1"}, "--range"},     {{"--range", "nan,1"}, "quantile"},
      {{"--range", "0"}, "quantile"},      {{"--camera", "fov=500"}, "fov"},
      {{"--camera", "zoom=2"}, "zoom"},    {{"--color", "pressure"}, "pressure"},
      {{"--style", "foam"}, "foam"}};
  for (const auto& [args, fragment] : bad) {
    CAPTURE(args);
    auto all = args;
    if (args[1] != "density") all.insert(all.end(), {"--out", "p"});
    const Outcome o = render(all);
    CHECK(o.code == 2);
    CHECK(has(o.err, fragment));
  }
}

TEST_CASE("run and render draw the same bytes: frame, range, name and moving solids") {
  const Scratch folder;
  const std::string moving =
      folder.write("moving.yaml",
                   "name: Rührer @ 1 Hz, Ø 水\n"
                   "domain: {min: [0, 0, 0], max: [0.8, 0.6, 2]}\n"
                   "fluid: {spacing: 0.05}\n"
                   "bodies:\n"
                   "  - {shape: block, min: [0, 0, 0], max: [0.8, 0.6, 0.2]}\n"
                   "  - {shape: file, path: drops.csv}\n"
                   "obstacles:\n"
                   "  - {name: blade, shape: box, min: [0.2, 0.2, 0.1], max: [0.5, 0.3, 0.3],\n"
                   "     motion: {kind: velocity, angular: [0, 0, 180]}}\n"
                   "tank_motion: {kind: sine, axis: [0, 1, 0], amplitude: 3, period: 1}\n"
                   "time: {step: 0.004, end: 0.2}\n"
                   "output: {every: 0.04}\n"
                   "render: {every: 0.04, size: [320, 240], camera: {orbit: 40}}\n");
  folder.write("drops.csv", "x,y,z\n0.2,0.2,0.7\n0.6,0.3,0.8\n");
  const Outcome drawn =
      pbf::test::pbf({"run", moving, "--out", "o", "--threads", "1"}, folder.path());
  CAPTURE(drawn.err);
  if (drawn.code == 4) {
    REQUIRE(has(drawn.err, "OSMesa"));
    PBF_SKIP("no off-screen GL library");
  }
  REQUIRE(drawn.code == 0);
  fs::remove(folder / "drops.csv");  // the run file is enough
  const Outcome again = pbf::test::pbf({"render", "o/run.vtkhdf"}, folder.path());
  CAPTURE(again.err);
  REQUIRE(again.code == 0);
  for (int k = 0; k <= 5; ++k) {
    const std::string name = "frame_00000" + std::to_string(k) + ".png";
    CAPTURE(name);
    REQUIRE(fs::exists(folder / "o/frames" / name));
    CHECK(read_text(folder / "o/frames" / name) == read_text(folder / "o/render" / name));
  }
}
#endif

TEST_CASE("a start too dense for the memory of any machine exits 4 before anything is made",
          "[slow]") {
  const Scratch folder;
  const std::string scene = folder.write(
      "s.yaml",
      "domain: {min: [0, 0, 0], max: [1, 1, 1]}\n"
      "fluid: {spacing: 0.05}\n"
      "bodies:\n"
      "  - {shape: random_box, min: [0.4, 0.4, 0.4], max: [0.42, 0.42, 0.42], count: 2000000}\n"
      "time: {step: 0.001, end: 1}\n");
  const Outcome o = pbf::test::pbf({"run", scene}, folder.path());
  CAPTURE(o.err);
  CHECK(o.code == 4);
  CHECK(has(o.err, "about 2000000 neighbors"));
  CHECK_FALSE(fs::exists(folder / "out"));
  CHECK(has(pbf::test::pbf({"plan", scene}, folder.path()).out, "\nstart: about 2000000"));
}

TEST_CASE("whole numbers on the command line are read as people write them, or refused", "[slow]") {
  const Scratch folder;
  folder.write("tiny.yaml", tiny_scene());
  folder.write("study.yaml", "scene: tiny.yaml\n");
  const std::vector<std::vector<std::string>> commands{
      {"bench", "--warmup", "0", "--updates", "1", "--n", "100", "--repeats"},
      {"bench", "--warmup", "0", "--repeats", "1", "--n", "100", "--updates"},
      {"bench", "--updates", "1", "--repeats", "1", "--n", "100", "--warmup"},
      {"bench", "--updates", "1", "--repeats", "1", "--warmup", "0", "--n"},
      {"bench", "--updates", "1", "--repeats", "1", "--n", "100", "--threads"},
      {"run", "tiny.yaml", "--threads"},
      {"plan", "tiny.yaml", "--threads"},
      {"run", "tiny.yaml", "--max-walltime"},
      {"batch", "tiny.yaml", "--list", "--jobs"},
      {"batch", "tiny.yaml", "--list", "--only"},
      {"study", "study.yaml", "--list", "--repeats"},
      {"compare", "tiny.yaml", "--between", "cpu:float,cpu:float", "--seed"},
      {"compare", "tiny.yaml", "--between", "cpu:float,cpu:float", "--members"},
      {"stability", "--jobs"},
      {"stability", "--map", "time.step,gravity", "--limit"},
      {"stability", "--map", "time.step,gravity", "--iterations"}};
  for (const auto& command : commands)
    for (const char* value : {"1.5", "-1", "99999999999999999999", "", "0x10", "nan", "1 "}) {
      const bool real = command.back() == "--max-walltime" || command.back() == "--limit";
      if (real && std::string(value) == "1.5") continue;
      auto args = command;
      args.back() += "=";
      args.back() += value;
      if (real && args.back().find("999") != std::string::npos) continue;
      CAPTURE(args);
      const Outcome o = pbf::test::pbf(args, folder.path());
      CAPTURE(o.out, o.err);
      CHECK(o.code == 2);
      CHECK(has(o.err, command.back()));
    }
  const Outcome eight =
      pbf::test::pbf({"batch", "tiny.yaml", "--list", "--jobs", "1e1"}, folder.path());
  CHECK(eight.code == 0);
  const Outcome ten = pbf::test::pbf({"bench", "--updates", "010", "--repeats", "1", "--warmup",
                                      "0", "--n", "1e2", "--csv", "b.csv"},
                                     folder.path());
  CAPTURE(ten.err);
  CHECK(ten.code == 0);
  const std::string csv = read_text(folder / "b.csv");
  CHECK(has(csv, ",start,0,10,1,"));  // updates, not eight in octal
}

TEST_CASE("a map over a key of whole numbers runs whole numbers, and refuses others") {
  const Scratch folder;
  folder.write("tiny.yaml", tiny_scene());
  const auto map = [&](const char* x) {
    return pbf::test::pbf({"stability", "tiny.yaml", "--map", "measure_every,time.step", "--x", x,
                           "--y", "0.005", "--iterations", "1", "--quiet"},
                          folder.path());
  };
  const Outcome bad = map("1.5,2");
  CHECK(bad.code == 2);
  CHECK(has(bad.err, "measure_every: 1.5 is not a whole number"));
  const Outcome range = map("1:4:5");  // 1 1.4 2 2.8 4
  CAPTURE(range.out, range.err);
  CHECK(range.code == 0);
  CHECK(has(range.out, "4 runs:"));
}

TEST_CASE("plan --threads plans the run of so many threads, as run --threads would make it") {
  const Scratch folder;
  folder.write("s.yaml", tiny_scene("threads: 1\n"));
  const auto plan = [&](const Args& more) {
    Args args{"plan", "s.yaml", "--json"};
    args.insert(args.end(), more.begin(), more.end());
    return pbf::test::pbf(args, folder.path());
  };
  const Outcome given = plan({"--threads", "7"}), set = plan({"--set", "threads=7"});
  CHECK(given.code == 0);
  CHECK(given.out == set.out);
  CHECK(given.out != plan({}).out);
  CHECK(plan({"--set", "threads=2", "--threads", "7"}).out == set.out);  // the option comes last
  CHECK(has(pbf::test::pbf({"plan", "s.yaml", "--threads", "7"}, folder.path()).out, "7 threads"));
}
