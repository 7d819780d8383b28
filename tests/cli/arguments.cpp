// Arguments that nobody takes: what may have been meant.
#include "tests/support/catch.h"
#include "tests/support/process.h"

using namespace pbf::test;

TEST_CASE("arguments: unknown options, commands, second scenes and forgotten --set are explained") {
  struct Case {
    std::vector<std::string> args;
    std::string message;
  };
  const std::vector<Case> cases{
      {{"run", "a.yaml", "--thread", "4"},
       "--thread: pbf run has no such option; did you mean --threads?\nSee pbf run --help"},
      {{"run", "a.yaml", "--output=x"},
       "--output=x: pbf run has no such option; did you mean --out?"},
      {{"run", "a.yaml", "-j", "4"}, "-j: pbf run has no such option; did you mean --threads?"},
      {{"run", "a.yaml", "--overwite"}, "did you mean --overwrite?"},
      {{"run", "a.yaml", "--max_walltime", "4"}, "did you mean --max-walltime?"},
      {{"run", "a.yaml", "--fast"}, "--fast: pbf run has no such option\nSee pbf run --help"},
      {{"run", "a.yaml", "b.yaml"},
       "b.yaml: pbf run takes one file; pbf batch runs many: all scenes of a folder, or a text "
       "file that names one per line\nSee pbf run --help"},
      {{"plan", "a.yaml", "b.yaml"}, "b.yaml: pbf plan takes one file; pbf batch runs many"},
      {{"run", "a.yaml", "time.step=1"},
       "time.step=1: not expected here; did you mean --set time.step=1?"},
      {{"run", "a.yaml", "--set", "time.step", "=", "1"},
       "=: not expected here; a setting is one word without spaces, KEY.PATH=VALUE\n"},
      {{"config", "a.yaml"}, "a.yaml: pbf config takes no file, only options\n"},
      {{"info", "x"}, "x: pbf info takes no file, only options\n"},
      {{"config", "--example", "--schema"},
       "give one of [--example,--markdown,--schema,--stages]\n"},
      {{"run", "a.yaml", "--out", ""}, "--out: is empty; give a name\n"},
      {{"rnu", "a.yaml"}, "rnu: unknown command, did you mean pbf run?; the commands are run"},
      {{"a.yaml"}, "a.yaml: unknown command, did you mean pbf run a.yaml?"},
      {{"simulate"}, "simulate: unknown command; the commands are run"},
      {{"--vesion"}, "the commands are run"},
  };
  const Scratch folder;
  for (const Case& c : cases) {
    const Outcome o = pbf::test::pbf(c.args, folder.path());
    CAPTURE(c.args, o.err);
    CHECK(o.code == 2);
    CHECK(o.err.rfind("pbf: error: ", 0) == 0);
    CHECK(o.err.find(c.message) != std::string::npos);
  }
}

TEST_CASE("arguments: --help is help wherever it stands, also where an option wants a value") {
  const Scratch folder;
  for (const Args& args :
       {Args{"stability", "--map", "--help"}, Args{"run", "a.yaml", "--out", "-h"},
        Args{"plan", "--set", "--help"}, Args{"bench", "--n", "x", "--help"}}) {
    const Outcome o = pbf::test::pbf(args, folder.path());
    CAPTURE(args, o.err);
    CHECK(o.code == 0);
    CHECK(has(o.out, "Usage: pbf " + args[0] + " [OPTIONS]"));
  }
}

TEST_CASE("arguments: a file that another command takes is told by its kind") {
  const Scratch folder;
  folder.write("tiny.yaml", tiny_scene());
  folder.write("study.yaml", "scene: tiny.yaml\ngrid: [{time.step: [0.01]}]\n");
  folder.write("list.txt", "tiny.yaml\n");
  const auto error = [&](std::vector<std::string> args) {
    const Outcome o = pbf::test::pbf(args, folder.path());
    return std::to_string(o.code) + " " + o.err;
  };
  CHECK(error({"run", "study.yaml"}) ==
        "2 pbf: error: study.yaml: is a study, expected a scene; pbf study study.yaml takes it\n");
  CHECK(error({"plan", "list.txt"}) ==
        "2 pbf: error: list.txt: is a list of runs, expected a scene; pbf batch list.txt takes "
        "it\n");
  CHECK(error({"study", "tiny.yaml"}) ==
        "2 pbf: error: tiny.yaml: is a scene, expected a study; pbf run tiny.yaml takes it\n");
}

TEST_CASE("ranges are written alike, and the help of each says in which steps they go") {
  const Scratch folder;
  const auto help = [&](const char* command) {
    std::string text = pbf::test::pbf({command, "--help"}, folder.path()).out;
    std::string one_line;
    for (const char c : text)
      if (c != '\n' && (c != ' ' || (!one_line.empty() && one_line.back() != ' ')))
        one_line += c;
      else if (!one_line.empty() && one_line.back() != ' ')
        one_line += ' ';
    return one_line;
  };
  CHECK(has(help("batch"), "FIRST:LAST:COUNT in equal steps, both ends included"));
  CHECK(has(help("batch"), "pbf stability take equal ratios"));
  CHECK(has(help("stability"), "FIRST:LAST:COUNT in equal ratios, both ends included"));
  CHECK(has(help("stability"), "--grid of pbf batch takes equal steps"));
}
