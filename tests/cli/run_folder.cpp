// pbf run: what a run leaves behind, and what happens to folders that are there already.
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <sstream>
#include <thread>

#include "lib/io/run_file.h"
#include "tests/support/catch.h"
#include "tests/support/process.h"

using namespace pbf::test;
namespace fs = std::filesystem;

TEST_CASE("a run leaves its file, resolved scene, log and DONE, and says so") {
  const Scratch folder;
  const std::string scene = folder.write("tiny.yaml", tiny_scene());
  const Outcome o =
      pbf::test::pbf({"run", scene, "--log-json", "m.json", "--threads", "1"}, folder.path());
  CAPTURE(o.err);
  REQUIRE(o.code == 0);
  const fs::path run = folder / "out/tiny";
  for (const char* name : {"run.vtkhdf", "scene.resolved.yaml", "log.txt", "DONE"}) {
    CAPTURE(name);
    CHECK(fs::is_regular_file(run / name));
  }
  CHECK_FALSE(fs::exists(run / "frames"));
  const pbf::RunReader reader((run / "run.vtkhdf").string());
  CHECK(reader.status() == "finished");
  CHECK(reader.times().size() == 6);  // 0, 0.02 ... 0.1
  CHECK(reader.frame(5).time == Approx(0.1));
  CHECK(reader.frame(5).count == 64);
  CHECK(reader.log_column("update") == std::vector<double>{0, 10, 20});
  CHECK(reader.info().overrides == std::vector<std::string>{"threads=1"});
  for (const char* part : {"particles           64", "updates             20", "lambda",
                           "particle-updates/s", "grid/neighbors", "peak memory", "out/tiny"})
    CHECK(has(o.out, part));
  for (const char* part :
       {"updates             20 (0.1 s simulated)\n", "a mean below 1 % is good",
        "  largest rise      ", "J at rest on the floor",
        "0 is good, above 1 % the method adds energy",
        "  densities                    0.000    0.0 %  in lambda, in one loop\n",
        "of the wall time"})
    CHECK(has(o.out, part));
  // One number for one thing: the seconds of a group are those of its stages.
  const auto after = [&](const std::string& word) {
    const std::size_t at = o.out.find(word);
    REQUIRE(at != std::string::npos);
    return std::stod(o.out.substr(at + word.size()));
  };
  CHECK(after("  grid/neighbors ") ==
        Approx(after("  grid ") + after(", neighbors ")).margin(0.0011));
  CHECK(has(read_text(run / "log.txt"), o.out));  // the summary, word for word
  CHECK(has(read_text(run / "log.txt"), o.err));
  const std::string json = read_text(folder / "m.json");
  CHECK(std::count(json.begin(), json.end(), '\n') == 3);
  CHECK(has(json, "{\"update\":20,"));
}

TEST_CASE("a run warns where fluid may have passed through fluid, and names the step that helps") {
  const Scratch folder;
  const std::string scene = folder.write(
      "balls.yaml",
      "domain: {min: [0, 0, 0], max: [3, 1, 1]}\n"
      "fluid: {spacing: 0.05}\n"
      "bodies:\n"
      "  - {shape: sphere, center: [1.25, 0.5, 0.5], radius: 0.2, velocity: [10, 0, 0]}\n"
      "  - {shape: sphere, center: [1.75, 0.5, 0.5], radius: 0.2, velocity: [-10, 0, 0]}\n"
      "gravity: [0, 0, 0]\n"
      "time: {step: 0.004, end: 0.06}\n");
  const auto run = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"run", scene, "--out", "balls", "--overwrite"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome o = pbf::test::pbf(words, folder.path());
    REQUIRE(o.code == 0);
    CHECK(has(read_text(folder / "balls/log.txt"), "pbf: warning: ") == has(o.err, "warning"));
    return o.err;
  };
  const std::string coarse = run({});
  CHECK(has(coarse, "fluid may have passed through fluid: "));
  CHECK(has(coarse, "; time.step 0.0"));
  CHECK(has(run({"--set", "time.step=0.001"}), "warning") == false);
}

TEST_CASE("the resolved scene of a run gives the same run again") {
  const Scratch folder;
  const std::string scene = folder.write("tiny.yaml", tiny_scene());
  REQUIRE(
      pbf::test::pbf({"run", scene, "--out", "a", "--set", "solver.iterations=2"}, folder.path())
          .code == 0);
  REQUIRE(pbf::test::pbf({"run", "a/scene.resolved.yaml", "--out", "b"}, folder.path()).code == 0);
  const pbf::RunReader a((folder / "a/run.vtkhdf").string()), b((folder / "b/run.vtkhdf").string());
  REQUIRE(a.frames() == b.frames());
  CHECK(a.frame(a.frames() - 1).fields[0].bytes == b.frame(b.frames() - 1).fields[0].bytes);
}

TEST_CASE("a scene without output and pictures writes no run file and no folder of pictures") {
  const Scratch folder;
  std::string text = tiny_scene();
  text.erase(text.find("output:"));
  const Outcome o =
      pbf::test::pbf({"run", folder.write("s.yaml", text), "--out", "o", "--quiet"}, folder.path());
  CHECK(o.code == 0);
  CHECK(o.err.empty());
  CHECK(fs::exists(folder / "o/DONE"));
  CHECK_FALSE(fs::exists(folder / "o/run.vtkhdf"));
  CHECK_FALSE(fs::exists(folder / "o/frames"));
  CHECK_FALSE(has(o.out, "download"));
}

TEST_CASE("the last state is written even when it falls between two frames") {
  const Scratch folder;
  const std::string scene = folder.write("tiny.yaml", tiny_scene());
  REQUIRE(pbf::test::pbf({"run", scene, "--out", "o", "--set", "output.every=0.03"}, folder.path())
              .code == 0);
  const pbf::RunReader reader((folder / "o/run.vtkhdf").string());
  CHECK(reader.times().size() == 5);  // 0, 0.03, 0.06, 0.09, 0.1
  CHECK(reader.times().back() == Approx(0.1));
}

TEST_CASE("option --overwrite replaces the files of pbf and leaves everything else") {
  const Scratch folder;
  const std::string scene = folder.write("tiny.yaml", tiny_scene());
  REQUIRE(pbf::test::pbf({"run", scene, "--out", "o"}, folder.path()).code == 0);
  fs::create_directories(folder / "o/frames/mine");
  folder.write("o/notes.md", "mine");
  folder.write("o/frames/frame_000007.png", "stale");
  folder.write("o/frames/sketch.png", "mine");
  const Outcome refused = pbf::test::pbf({"run", scene, "--out", "o"}, folder.path());
  CHECK(refused.code == 2);
  CHECK(fs::exists(folder / "o/frames/frame_000007.png"));
  REQUIRE(pbf::test::pbf({"run", scene, "--out", "o/", "--overwrite", "--set", "time.end=0.05"},
                         folder.path())
              .code == 0);
  CHECK(read_text(folder / "o/notes.md") == "mine");
  CHECK(read_text(folder / "o/frames/sketch.png") == "mine");
  CHECK(fs::is_directory(folder / "o/frames/mine"));
  CHECK_FALSE(fs::exists(folder / "o/frames/frame_000007.png"));
  CHECK(pbf::RunReader((folder / "o/run.vtkhdf").string()).times().back() == Approx(0.05));
}

TEST_CASE(
    "a file that only has the name of one of a run is never replaced, and the message names it") {
  for (const char* name : {"log.txt", "scene.resolved.yaml", "run.vtkhdf", "DONE", "checkpoint.h5",
                           "guard_scene.yaml", "frames/frame_000001.png"})
    for (const char* how : {"--overwrite", "--resume"}) {
      CAPTURE(name, how);
      const Scratch folder;
      folder.write("tiny.yaml", tiny_scene());
      fs::create_directories(folder / "mine/frames");
      folder.write(std::string("mine/") + name, "my own words");
      const Outcome o = pbf::test::pbf({"run", "tiny.yaml", "--out", "mine", how}, folder.path());
      CHECK(o.code == 2);
      CHECK(has(o.err, std::string("mine/") + name + ": a run would replace this file"));
      CHECK(has(o.err, "give another folder with --out"));
      CHECK(read_text(folder / "mine" / name) == "my own words");
    }
}

TEST_CASE("option --overwrite replaces a run whose log was removed") {
  const Scratch folder;
  const std::string scene = folder.write("tiny.yaml", tiny_scene());
  REQUIRE(pbf::test::pbf({"run", scene, "--out", "o"}, folder.path()).code == 0);
  fs::remove(folder / "o/log.txt");
  CHECK(pbf::test::pbf({"run", scene, "--out", "o", "--overwrite"}, folder.path()).code == 0);
  CHECK(fs::exists(folder / "o/log.txt"));
}

TEST_CASE("a run that was killed before the first line of its log is taken up and replaced") {
  for (const char* how : {"--overwrite", "--resume"})
    for (const char* left : {"scene.resolved.yaml", ".pbf-half"}) {
      CAPTURE(how, left);
      const Scratch folder;
      const std::string scene = folder.write("tiny.yaml", tiny_scene());
      REQUIRE(pbf::test::pbf({"run", scene, "--out", "full"}, folder.path()).code == 0);
      fs::create_directory(folder / "o");
      folder.write("o/log.txt", "");
      folder.write(std::string("o/") + left, read_text(folder / "full/scene.resolved.yaml"));
      const Outcome o = pbf::test::pbf({"run", scene, "--out", "o", how}, folder.path());
      CAPTURE(o.err);
      CHECK(o.code == 0);
      CHECK(fs::exists(folder / "o/DONE"));
    }
}

TEST_CASE("option --resume leaves a finished run untouched and starts one that is not there") {
  const Scratch folder;
  const std::string scene = folder.write("tiny.yaml", tiny_scene());
  REQUIRE(pbf::test::pbf({"run", scene, "--out", "o", "--resume"}, folder.path()).code == 0);
  const auto before = fs::last_write_time(folder / "o/run.vtkhdf");
  const Outcome again = pbf::test::pbf({"run", scene, "--out", "o", "--resume"}, folder.path());
  CHECK(again.code == 0);
  CHECK(again.out.empty());
  CHECK(has(again.err, "finished"));
  CHECK(fs::last_write_time(folder / "o/run.vtkhdf") == before);
}

namespace {

/// Far too many updates to finish, so that only being stopped ends it.
std::string endless(const Scratch& folder) {
  return folder.write("long.yaml", tiny_scene() + "measure_every: 1000000\n");
}
const std::vector<std::string> kEndless{"run",       "long.yaml", "--out", "o",
                                        "--threads", "1",         "--set", "time.end=100000"};

/// CPU time of a process outside the kernel.
double user_seconds(const Process& process) {
  const std::string text = read_text("/proc/" + std::to_string(process.id()) + "/stat");
  std::istringstream words(text.substr(text.rfind(')') + 1));
  std::string word;
  for (int field = 3; field <= 14; ++field) words >> word;  // proc(5)
  return word.empty() ? 0 : std::stod(word) / double(sysconf(_SC_CLK_TCK));
}
void wait_for(const fs::path& path) {
  wait_until([&] { return fs::exists(path); });
}

}  // namespace

TEST_CASE("SIGTERM and SIGINT end a run with exit code 75, a checkpoint and a readable file") {
  for (const int signal : {SIGTERM, SIGINT}) {
    CAPTURE(signal);
    const Scratch folder;
    endless(folder);
    auto args = kEndless;
    args.insert(args.end(), {"--log-json", "m.json", "--set", "measure_every=1"});
    Process run(args, folder.path());
    wait_until([&] { return has(read_text(folder / "m.json"), "{\"update\":1,"); });
    run.send(signal);
    const Outcome o = run.wait();
    CAPTURE(o.err);
    CHECK(o.code == 75);
    CHECK(has(o.err, "stopped early by SIG"));
    CHECK(has(o.err, "--resume"));
    CHECK_FALSE(fs::exists(folder / "o/DONE"));
    CHECK(fs::exists(folder / "o/checkpoint.h5"));
    const pbf::RunReader reader((folder / "o/run.vtkhdf").string());
    CHECK(reader.status() == "stopped");
    REQUIRE(reader.frames() >= 1);
    CHECK(reader.frame(reader.frames() - 1).count == 64);
    const auto sessions = reader.sessions();
    REQUIRE(sessions.size() == 1);
    CHECK(sessions[0].reason == (signal == SIGTERM ? "SIGTERM" : "SIGINT"));
    CHECK(sessions[0].ended >= sessions[0].started);
    CHECK(sessions[0].last_update > 0);
    CHECK(sessions[0].threads == 1);
  }
}

#ifdef PBF_HAS_RENDER
TEST_CASE("a run whose pictures cannot be drawn ends before its folder is made") {
  const Scratch folder;
  const std::string scene = folder.write("tiny.yaml", tiny_scene("render: {}\n"));
  const Outcome o =
      pbf::test::pbf({"run", scene, "--out", "o/"}, folder.path(), {"PBF_GL=directx"});
  CHECK(o.code == 2);
  CHECK(has(o.err, "PBF_GL is \"directx\""));
  CHECK_FALSE(fs::exists(folder / "o"));
  CHECK(pbf::test::pbf({"run", scene, "--out", "o/", "--set", "render=off"}, folder.path()).code ==
        0);
}
#endif

TEST_CASE("SIGUSR1 saves a checkpoint, and the run goes on") {
  const Scratch folder;
  endless(folder);
  Process run(kEndless, folder.path());
  wait_for(folder / "o/run.vtkhdf");
  run.send(SIGUSR1);
  wait_for(folder / "o/checkpoint.h5");
  run.send(SIGUSR1);
  wait_for(folder / "o/checkpoint_prev.h5");
  run.send(SIGTERM);
  CHECK(run.wait().code == 75);
}

TEST_CASE("a second signal ends a run at once", "[slow]") {
  const Scratch folder;
  // One update takes many seconds, so the first signal is still waiting for it.
  folder.write("slow.yaml", tiny_scene("solver: {iterations: 100000}\n"));
  Process run({"run", "slow.yaml", "--out", "o", "--threads", "1", "--set", "fluid.spacing=0.02",
               "--log-json", "m.json"},
              folder.path());
  wait_until([&] { return has(read_text(folder / "m.json"), "{\"update\":0,"); });
  const double before = user_seconds(run);
  wait_until([&] { return user_seconds(run) > before + 0.1; });  // that much only in the update
  run.send(SIGTERM);
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  CHECK(run.running());  // the first has not ended it
  // Two signals that come before the first is handled are one.
  wait_until([&] {
    run.send(SIGTERM);
    return !run.running();
  });
  CHECK(run.wait().code == 128 + SIGTERM);
}

TEST_CASE("a run that diverges exits 3, names update, stage and particle, and keeps what it has") {
  const Scratch folder;
  // Falls out of an open floor until the square of its speed overflows a float.
  const std::string scene = folder.write("tiny.yaml", tiny_scene("measure_every: 5\n"));
  const Outcome o = pbf::test::pbf(
      {"run", scene, "--out", "o", "--set", "domain.open=[z_min]", "--set", "gravity=[0, 0, -1e12]",
       "--set", "time.step=1e6", "--set", "time.end=1e9", "--set", "output.every=1e8"},
      folder.path());
  CAPTURE(o.err);
  CHECK(o.code == 3);
  for (const char* part : {"stopped by the guard: at update ", "stage predict", "particle 0 ",
                           "time.step", "iterations"})
    CHECK(has(o.err, part));
  CHECK(has(o.out, "not finite          64"));
  CHECK_FALSE(fs::exists(folder / "o/DONE"));
  CHECK(has(read_text(folder / "o/log.txt"), "pbf: error: stopped by the guard"));
  CHECK(pbf::RunReader((folder / "o/run.vtkhdf").string()).status() == "diverged");
}

TEST_CASE("option --max-walltime ends a run in time with exit code 75") {
  const Scratch folder;
  endless(folder);
  auto args = kEndless;
  args.insert(args.end(), {"--max-walltime", "0.3"});
  const Outcome o = pbf::test::pbf(args, folder.path());
  CHECK(o.code == 75);
  CHECK(has(o.err, "--max-walltime"));
  CHECK(pbf::RunReader((folder / "o/run.vtkhdf").string()).status() == "stopped");
}
