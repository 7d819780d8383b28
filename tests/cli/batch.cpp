// pbf batch: which runs it makes, what it skips, and that being killed changes nothing.
#include <sys/stat.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <random>
#include <sstream>
#include <thread>

#include "tests/catch.h"
#include "tests/cli/process.h"

using namespace pbf::test;
namespace fs = std::filesystem;

namespace {

/// A summary without its last column, the seconds; the folder of the batch is no part of it.
std::string summary(const fs::path& folder) {
  std::istringstream lines(read_text(folder / "summary.csv"));
  std::string all;
  for (std::string line; std::getline(lines, line);) all += line.substr(0, line.rfind(',')) + "\n";
  return all;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++n;
  return n;
}

}  // namespace

TEST_CASE("a batch of 12 runs killed at random and rerun has the summary of the undisturbed one") {
  const Scratch folder;
  folder.write("s.yaml",
               "name: s\n"
               "domain: {min: [0, 0, 0], max: [1, 0.6, 1]}\n"
               "fluid: {spacing: 0.06}\n"
               "bodies: [{shape: block, min: [0, 0, 0], max: [0.4, 0.6, 0.6]}]\n"
               "time: {step: 0.002, end: 0.3}\n"
               "checkpoint: {every: 0.03}\n"
               "output: {every: 0.02}\n");
  std::vector<std::string> args{"batch",     "s.yaml",
                                "--jobs",    "3",
                                "--grid",    "solver.iterations=1,2,4",
                                "--grid",    "solver.kernels=consistent,paper",
                                "--grid",    "time.step=0.002,0.003",
                                "--threads", "1",
                                "--out"};
  auto undisturbed = args, killed = args;
  undisturbed.push_back("a");
  killed.push_back("b");
  const Outcome whole = pbf::test::pbf(undisturbed, folder.path());
  CAPTURE(whole.err);
  REQUIRE(whole.code == 0);
  CHECK(has(whole.out, "12 runs: 12 finished, 0 failed, 0 to go on with"));
  const auto seed = std::random_device{}();
  std::mt19937 random(seed);
  CAPTURE(seed);
  int kills = 0, code = -1;
  for (int round = 0; round < 60 && code != 0; ++round) {
    Process batch(killed, folder.path());
    if (kills < 6) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20 + random() % 250));
      batch.send(kills % 2 ? SIGTERM : SIGKILL);  // the runs of a killed batch get SIGTERM
    }
    code = batch.wait().code;
    if (code == 128 + SIGKILL || code == 75 || code == 128 + SIGTERM) ++kills;
    if (code != 0) std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  CHECK(code == 0);
  CHECK(kills >= 3);
  CHECK(summary(folder / "b") == summary(folder / "a"));
  CHECK(count(summary(folder / "a"), ",finished,") == 12);
  CHECK(has(summary(folder / "a"), "s_iterations=4_kernels=paper_step=0.003,s.yaml,"));
  // Once more: nothing is run.
  const auto time =
      fs::last_write_time(folder / "b/s_iterations=1_kernels=paper_step=0.002/run.vtkhdf");
  CHECK(pbf::test::pbf(killed, folder.path()).code == 0);
  CHECK(fs::last_write_time(folder / "b/s_iterations=1_kernels=paper_step=0.002/run.vtkhdf") ==
        time);
}

TEST_CASE("a batch over a folder tells which runs failed and why, and finishes the others") {
  const Scratch folder;
  fs::create_directory(folder / "scenes");
  folder.write("scenes/good.yaml", tiny_scene());
  folder.write("scenes/bad.yaml", tiny_scene("solver: {iteratons: 3}\n"));
  folder.write("scenes/cuda.yaml", tiny_scene("backend: cuda\n"));
  folder.write("scenes/notes.txt", "not a scene");
  const Outcome o = pbf::test::pbf({"batch", "scenes"}, folder.path());
  CAPTURE(o.err);
  CHECK(o.code == 6);
  CHECK(has(o.out, "3 runs: 1 finished, 2 failed"));
  const std::string table = read_text(folder / "out/batch_scenes/summary.csv");
  CHECK(has(table, "good,scenes/good.yaml,,0,finished,,"));
  CHECK(has(table, "bad,scenes/bad.yaml,,2,bad input,"));
  CHECK(has(table, "did you mean solver.iterations?"));
  CHECK(has(table, "cuda,scenes/cuda.yaml,,4,unavailable,"));
  CHECK(fs::exists(folder / "out/batch_scenes/good/DONE"));
}

TEST_CASE("a batch of a list takes the settings of its lines, and wrong lists are told by line") {
  const Scratch folder;
  folder.write("tiny.yaml", tiny_scene());
  folder.write(
      "list.txt",
      "# two of them\ntiny.yaml time.end=0.05\n\n  tiny.yaml solver.iterations=2 # more\n");
  const Outcome o = pbf::test::pbf(
      {"batch", "list.txt", "--list", "--grid", "bodies[0].velocity=[0,0,1],[0,0,2]"},
      folder.path());
  CHECK(o.code == 0);
  CHECK(has(o.out, "4 runs"));
  CHECK(has(o.out, "  2  tiny_iterations=2_velocity=-0-0-1"));
  CHECK(pbf::test::pbf({"batch", "list.txt", "--quiet"}, folder.path()).code == 0);
  CHECK(fs::exists(folder / "out/batch_list/tiny_end=0.05/DONE"));
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong{
      {{"none.txt"}, "none.txt: cannot be opened"},
      {{"."}, ""},
      {{"tiny.yaml", "--grid", "solver.iterations"}, "expected KEY=V1,V2"},
      {{"tiny.yaml", "--grid", "solver.iterations=1,,2"}, "empty value"},
      {{"tiny.yaml", "--only", "1"}, "--only 1"},
      {{"bad.txt"}, "bad.txt:2: \"iterations\" is not key.path=value"}};
  folder.write("bad.txt", "tiny.yaml\ntiny.yaml iterations 3\n");
  for (auto [args, text] : wrong) {
    if (text.empty()) continue;
    args.insert(args.begin(), "batch");
    const Outcome e = pbf::test::pbf(args, folder.path());
    CAPTURE(e.err);
    CHECK(e.code == 2);
    CHECK(has(e.err, text));
  }
}

TEST_CASE(
    "a limit of a batch that passes before a run listens to signals stops it like any other") {
  const Scratch folder;
  folder.write("tiny.yaml", tiny_scene());
  for (const char* limit : {"0.003", "0.006", "0.012", "0.024"}) {
    CAPTURE(limit);
    const Outcome o = pbf::test::pbf(
        {"batch", "tiny.yaml", "--set", "time.end=9000", "--out", "o", "--max-walltime", limit},
        folder.path());
    CHECK(o.code == 75);
    CHECK_FALSE(has(read_text(folder / "o/summary.csv"), "killed by"));
  }
}

TEST_CASE("a run whose file is not its own is not called finished, and is made again") {
  const Scratch folder;
  folder.write("tiny.yaml", tiny_scene());
  const std::vector<std::string> batch{"batch", "tiny.yaml", "--out", "o", "--threads", "1"};
  auto collect = batch;
  collect.emplace_back("--collect");
  REQUIRE(pbf::test::pbf(batch, folder.path()).code == 0);
  const std::string good = read_text(folder / "o/tiny/run.vtkhdf");
  REQUIRE(pbf::test::pbf({"run", "tiny.yaml", "--quiet", "--out", "y", "--set", "time.end=0.05"},
                         folder.path())
              .code == 0);
  std::string why;
  SECTION("garbage") {
    folder.write("o/tiny/run.vtkhdf", "garbage");
    why = "DONE is there, but o/tiny/run.vtkhdf: cannot read";
  }
  SECTION("empty") {
    folder.write("o/tiny/run.vtkhdf", "");
    why = "DONE is there, but o/tiny/run.vtkhdf: cannot read";
  }
  SECTION("truncated") {
    folder.write("o/tiny/run.vtkhdf", good.substr(0, good.size() / 2));
    why = "DONE is there, but o/tiny/run.vtkhdf: cannot read";
  }
  SECTION("missing") {
    fs::remove(folder / "o/tiny/run.vtkhdf");
    why = "DONE is there, but run.vtkhdf is missing";
  }
  SECTION("of a shorter run") {
    fs::copy_file(folder / "y/run.vtkhdf", folder / "o/tiny/run.vtkhdf",
                  fs::copy_options::overwrite_existing);
    why = "DONE is there, but the frames of run.vtkhdf end at update 10, the run at 20";
  }
  const Outcome seen = pbf::test::pbf(collect, folder.path());
  CAPTURE(seen.out, seen.err);
  CHECK(seen.code == 75);
  CHECK(has(seen.out, "1 runs: 0 finished, 0 failed, 1 to go on with"));
  CHECK(has(seen.err, why));
  CHECK(has(read_text(folder / "o/summary.csv"), "but "));
  const Outcome again = pbf::test::pbf(batch, folder.path());
  CAPTURE(again.err);
  CHECK(again.code == 0);
  CHECK(has(again.out, "1 finished"));
  CHECK(has(read_text(folder / "o/tiny/log.txt"), why));
  CHECK(pbf::test::pbf({"compare", "o/tiny/run.vtkhdf", "o/tiny/run.vtkhdf"}, folder.path()).code ==
        0);
  CHECK(pbf::test::pbf(collect, folder.path()).code == 0);
}

TEST_CASE("a run file of another scene in a finished run's folder is a failed run, and is kept") {
  const Scratch folder;
  folder.write("tiny.yaml", tiny_scene());
  const std::vector<std::string> batch{"batch", "tiny.yaml", "--out", "o", "--threads", "1"};
  auto collect = batch;
  collect.emplace_back("--collect");
  REQUIRE(pbf::test::pbf(batch, folder.path()).code == 0);
  REQUIRE(pbf::test::pbf({"run", "tiny.yaml", "--quiet", "--out", "x", "--set", "gravity=[0,0,-5]"},
                         folder.path())
              .code == 0);
  fs::copy_file(folder / "x/run.vtkhdf", folder / "o/tiny/run.vtkhdf",
                fs::copy_options::overwrite_existing);
  for (const auto& command : {collect, batch}) {
    const Outcome o = pbf::test::pbf(command, folder.path());
    CAPTURE(o.out, o.err);
    CHECK(o.code == 6);
    CHECK(has(o.out, "0 finished, 1 failed"));
    CHECK(has(o.err, "of another scene: gravity"));
  }
  CHECK(read_text(folder / "o/tiny/run.vtkhdf") == read_text(folder / "x/run.vtkhdf"));
}

TEST_CASE("a batch whose scenes have changed is not collected as finished") {
  const Scratch folder;
  folder.write("tiny.yaml", tiny_scene());
  REQUIRE(pbf::test::pbf({"batch", "tiny.yaml", "--out", "o"}, folder.path()).code == 0);
  const auto collect = [&](const char* key) {
    return pbf::test::pbf({"batch", "tiny.yaml", "--out", "o", "--collect", "--set", key},
                          folder.path());
  };
  CHECK(collect("threads=2").code == 0);  // no other run
  const Outcome other = collect("gravity=[0,0,-5]");
  CHECK(other.code == 6);
  CHECK(has(other.err, "is of another scene: gravity"));
  const Outcome longer = collect("time.end=0.2");
  CHECK(longer.code == 75);
}

TEST_CASE("the Slurm script of a batch runs every run as a task and requeues those that stop") {
  const Scratch folder;
  folder.write("tiny.yaml", tiny_scene());
  const Outcome o = pbf::test::pbf(
      {"batch", "tiny.yaml", "--grid", "solver.iterations=1,2", "--out", "o", "--slurm"},
      folder.path());
  REQUIRE(o.code == 0);
  CHECK(has(o.out, "#SBATCH --array=0-1\n"));
  const std::string script = folder.write("job.sh", o.out);
  // srun and scontrol as Slurm has them, as far as the script goes.
  folder.write("srun", "#!/bin/sh\nexec \"$@\"\n");
  folder.write("scontrol", "#!/bin/sh\necho \"$@\" >> requeued\n");
  for (const char* tool : {"srun", "scontrol"}) REQUIRE(chmod((folder / tool).c_str(), 0755) == 0);
  const auto task = [&](int k, const std::string& command) {
    const std::string line =
        "cd " + folder.path().string() + " && PATH=\"$PWD:$PATH\"" +
        " SLURM_ARRAY_JOB_ID=7 SLURM_CPUS_PER_TASK=1 SLURM_ARRAY_TASK_ID=" + std::to_string(k) +
        " " + command + " bash " + script + " 2>/dev/null";
    const int status = std::system(line.c_str());
    return WEXITSTATUS(status);
  };
  CHECK(task(0, "") == 0);
  CHECK(task(1, "") == 0);
  CHECK_FALSE(fs::exists(folder / "requeued"));
  CHECK_FALSE(fs::exists(folder / "o/summary.csv"));
  const Outcome all = pbf::test::pbf(
      {"batch", "tiny.yaml", "--grid", "solver.iterations=1,2", "--out", "o", "--collect"},
      folder.path());
  CHECK(all.code == 0);
  CHECK(count(read_text(folder / "o/summary.csv"), ",finished,") == 2);
  // A task that is stopped in time.
  std::string late = o.out;
  const std::string end = " --only ";
  late.replace(late.find(end + "\"$SLURM"), end.size(),
               " --set time.end=9000 --max-walltime 0.2 --only ");
  folder.write("job.sh", late);
  CHECK(task(1, "") == 75);
  CHECK(read_text(folder / "requeued") == "requeue 7_1\n");
}

TEST_CASE("whatever is in its words, the Slurm script runs one command and nothing else") {
  const Scratch folder;
  // Each word would make a file `owned` if the script let it.
  const std::vector<std::string> words{"a=b\ntouch owned #",
                                       "a=b\n#SBATCH --wrap=x\n touch owned",
                                       "a=b\r\ntouch owned",
                                       "a='; touch owned; '",
                                       "a='\n touch owned; '\n'",
                                       "a=\"; touch owned; \"",
                                       "a=$(touch owned)",
                                       "a=`touch owned`",
                                       "a=$HOME ~ * ? ! # & | ; < > ( ) { } [ ] \\ \\n",
                                       "a=\\'\n\\\\",
                                       "a=\t\x01\x7f\xC3\xA4"};
  folder.write("srun", "#!/bin/sh\nshift\nprintf '%s\\0' \"$@\" > words\n");
  REQUIRE(chmod((folder / "srun").c_str(), 0755) == 0);
  for (const std::string& word : words)
    for (const char* where : {"--set", "--grid", "--out", "INPUT"}) {
      CAPTURE(word, where);
      const std::string input = where == std::string("INPUT") ? "s " + word : "s";
      std::string name = input;  // a path has no slash here, and ends like a scene
      name += ".yaml";
      folder.write(name, tiny_scene());
      std::vector<std::string> args{"batch", name, "--slurm"};
      if (where != std::string("INPUT")) args.insert(args.end(), {where, word});
      if (where == std::string("--grid") && word.find(',') != std::string::npos) continue;
      const Outcome o = pbf::test::pbf(args, folder.path());
      CAPTURE(o.out, o.err);
      REQUIRE(o.code == 0);
      std::size_t directives = 0, lines = 0;
      std::istringstream text(o.out);
      for (std::string line; std::getline(text, line); ++lines)
        directives += line.rfind("#SBATCH", 0) == 0;
      CHECK(directives == 7);
      CHECK(lines == 18);
      const std::string script = folder.write("job.sh", o.out);
      const std::string run = "cd " + folder.path().string() +
                              " && rm -f words owned && PATH=\"$PWD:$PATH\" bash " + script +
                              " 2>errors";
      CHECK(std::system(run.c_str()) == 0);
      CHECK_FALSE(fs::exists(folder / "owned"));
      const std::string given = read_text(folder / "words");
      const std::string end = where == std::string("INPUT") ? name : word;
      CHECK(has(given, end + std::string(1, '\0')));
      fs::remove(folder / name);
    }
}
