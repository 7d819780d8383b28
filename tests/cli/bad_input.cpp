// Every wrong input ends in one message that names what is wrong, and in the documented exit code.
#include <unistd.h>

#include "tests/support/catch.h"
#include "tests/support/process.h"

using namespace pbf::test;

namespace {

struct Case {
  std::string what;
  std::vector<std::string> args;
  int code;
  std::vector<std::string> fragments;  // of stderr
};

std::vector<Case> cases() {
  const std::string box = "bodies=[{shape: block, min: [0, 0, 0], max: ";
  return {
      {"missing scene", {"run", "none.yaml"}, 2, {"none.yaml", "No such file"}},
      {"not YAML", {"run", "broken.yaml"}, 2, {"broken.yaml:", "YAML"}},
      {"empty file", {"run", "empty.yaml"}, 2, {"empty.yaml", "empty", "config --example"}},
      {"binary file", {"run", "binary.yaml"}, 2, {"binary.yaml", "is not plain text"}},
      {"a folder as scene", {"run", "folder"}, 2, {"folder", "no run.vtkhdf in this folder"}},
      {"zero particles",
       {"run", "tiny.yaml", "--set", box + "[0.01, 0.4, 0.4]}]"},
       2,
       {"bodies", "no particle", "fluid.spacing"}},
      {"10^12 particles",
       {"run", "tiny.yaml", "--set", "fluid.spacing=4e-5"},
       2,
       {"1e+12 particles", "2147483647", "fluid.spacing"}},
      {"negative spacing",
       {"run", "tiny.yaml", "--set", "fluid.spacing=-0.1"},
       2,
       {"fluid.spacing", "-0.1", "out of range"}},
      {"inverted box",
       {"run", "tiny.yaml", "--set", "domain.max=[1, 1, -1]"},
       2,
       {"domain.max", "inverted"}},
      {"body outside the box",
       {"run", "tiny.yaml", "--set", box + "[0.4, 0.4, 1.4]}]"},
       2,
       {"bodies", "outside the domain", "1.4"}},
      {"nan", {"run", "tiny.yaml", "--set", "time.step=.nan"}, 2, {"time.step"}},
      {"unknown key",
       {"run", "tiny.yaml", "--set", "solver.iteratons=3"},
       2,
       {"solver.iteratons", "unknown key", "solver.iterations"}},
      {"--set without a value", {"run", "tiny.yaml", "--set", "name"}, 2, {"key.path=value"}},
      {"folder below a file",
       {"run", "tiny.yaml", "--out", "tiny.yaml/out"},
       5,
       {"tiny.yaml/out", "--out"}},
      {"a file as folder",
       {"run", "tiny.yaml", "--out", "empty.yaml"},
       5,
       {"empty.yaml", "not a folder"}},
      {"existing folder",
       {"run", "tiny.yaml", "--out", "folder"},
       2,
       {"folder", "--overwrite", "without a run"}},
      {"resume in a folder of other files",
       {"run", "tiny.yaml", "--out", ".", "--resume"},
       2,
       {"holds no run", "--out"}},
      {"resume and overwrite",
       {"run", "tiny.yaml", "--resume", "--overwrite"},
       2,
       {"--overwrite", "--resume"}},
      {"unknown backend",
       {"run", "tiny.yaml", "--backend", "vulkan"},
       2,
       {"vulkan", "cpu", "cuda"}},
      {"unknown precision",
       {"run", "tiny.yaml", "--precision", "half"},
       2,
       {"half", "float", "double"}},
      {"no thread", {"run", "tiny.yaml", "--threads", "0"}, 2, {"--threads", "4096"}},
      {"negative threads", {"run", "tiny.yaml", "--threads", "-2"}, 2, {"--threads", "4096"}},
      {"negative wall time",
       {"run", "tiny.yaml", "--max-walltime", "-1"},
       2,
       {"--max-walltime", "-1"}},
      {"log into no folder",
       {"run", "tiny.yaml", "--log-json", "none/x"},
       5,
       {"--log-json", "none"}},
      {"unknown option", {"run", "tiny.yaml", "--fast"}, 2, {"--fast", "pbf run --help"}},
      {"no scene", {"run"}, 2, {"SCENE", "pbf run --help"}},
      {"unknown command", {"simulate"}, 2, {"simulate", "unknown command", "run plan"}},
      {"no command", {}, 2, {"subcommand", "pbf --help"}},
      {"plan of nothing", {"plan", "none.yaml"}, 2, {"none.yaml"}},
      {"render of no file", {"render", "none.h5"}, 5, {"none.h5"}},
      {"render of a scene", {"render", "tiny.yaml"}, 5, {"tiny.yaml"}},
  };
}

}  // namespace

TEST_CASE("every wrong input gets its exit code and a message that names it") {
  const Scratch folder;
  folder.write("tiny.yaml", tiny_scene());
  folder.write("broken.yaml", "domain: {min: [0, 0\n");
  folder.write("empty.yaml", "");
  folder.write("binary.yaml", std::string("\x7f\x45\x4c\x46\x00\xff\xfe", 7));
  std::filesystem::create_directory(folder / "folder");
  for (const Case& c : cases()) {
    INFO(c.what);
    const Outcome o = pbf::test::pbf(c.args, folder.path());
    CAPTURE(o.out, o.err);
    CHECK(o.code == c.code);
    CHECK(o.out.empty());
    CHECK(o.err.rfind("pbf: error: ", 0) == 0);
    for (const auto& f : c.fragments) {
      CAPTURE(f);
      CHECK(o.err.find(f) != std::string::npos);
    }
    CHECK_FALSE(std::filesystem::exists(folder / "out"));  // what cannot run leaves nothing behind
  }
  CHECK(std::filesystem::is_empty(folder / "folder"));
}

TEST_CASE(
    "asking for CUDA where there is no GPU or no CUDA in the build exits 4, and runs nothing") {
  const Scratch folder;
  const std::string scene = folder.write("tiny.yaml", tiny_scene());
  const Outcome o = pbf::test::pbf({"run", scene, "--backend", "cuda"}, folder.path());
  CHECK(o.code == 4);
  CHECK(o.err.find("--backend cpu") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(folder / "out"));
}

TEST_CASE("a folder without the right to write exits 5 and names the folder") {
  if (geteuid() == 0) PBF_SKIP("root may write everywhere");
  const Scratch folder;
  const std::string scene = folder.write("tiny.yaml", tiny_scene());
  std::filesystem::create_directory(folder / "locked");
  std::filesystem::permissions(folder / "locked", std::filesystem::perms::owner_read);
  const Outcome o = pbf::test::pbf({"run", scene, "--out", "locked/run"}, folder.path());
  std::filesystem::permissions(folder / "locked", std::filesystem::perms::owner_all);
  CHECK(o.code == 5);
  CHECK(o.err.find("locked") != std::string::npos);
}

TEST_CASE("results that cannot be written to a full disk exit 5") {
  if (access("/dev/full", W_OK) != 0) PBF_SKIP("no /dev/full");
  const Scratch folder;
  // The shell redirects; the program itself only sees a stdout that is full.
  const std::string command =
      std::string(PBF_BINARY) + " config --example >/dev/full 2>" + (folder / "err").string();
  const int status = std::system(command.c_str());
  CHECK(WEXITSTATUS(status) == 5);
  CHECK(read_text(folder / "err").find("standard output") != std::string::npos);
}

TEST_CASE("a reader of the output that goes away early is no error") {
  const Scratch folder;
  const std::string command = "{ " + std::string(PBF_BINARY) + " config --example; echo $? >" +
                              (folder / "code").string() + "; } 2>" + (folder / "err").string() +
                              " | true";
  CHECK(std::system(command.c_str()) == 0);
  CHECK(read_text(folder / "code") == "0\n");
  CHECK(read_text(folder / "err").empty());
}
