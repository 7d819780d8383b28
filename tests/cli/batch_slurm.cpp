// pbf batch --slurm: a script that runs every run as a task, and nothing else.
#include <sys/stat.h>
#include <sys/wait.h>

#include <cstdlib>
#include <sstream>

#include "tests/support/catch.h"
#include "tests/support/process.h"

using namespace pbf::test;
namespace fs = std::filesystem;

TEST_CASE("the Slurm script of a batch runs every run as a task and requeues those that stop",
          "[slow]") {
  const Scratch folder;
  folder.write("tiny.yaml", tiny_scene());
  const Outcome o = pbf::test::pbf(
      {"batch", "tiny.yaml", "--grid", "solver.iterations=1,2", "--out", "o", "--slurm"},
      folder.path());
  REQUIRE(o.code == 0);
  CHECK(has(o.out, "#SBATCH --array=0-1\n"));
  CHECK(has(o.out, "#SBATCH --cpus-per-task=4\n"));
  CHECK(has(o.out, "#SBATCH --time=1:00:00\n"));
  CHECK_FALSE(has(o.out, "gres"));
  const std::string script = folder.write("job.sh", o.out);
  // srun and scontrol as Slurm has them, as far as the script goes.
  folder.write("srun", "#!/bin/sh\n[ \"$SRUN_CPUS_PER_TASK\" = 1 ] && exec \"$@\"\n");
  folder.write("scontrol", "#!/bin/sh\necho \"$@\" >> requeued\n");
  folder.write("sbatch", "#!/bin/sh\necho \"$@\" >> submitted\necho '7;cluster'\n");
  for (const char* tool : {"srun", "scontrol", "sbatch"})
    REQUIRE(chmod((folder / tool).c_str(), 0755) == 0);
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
  // Given to bash, it submits itself and what collects.
  const std::string here = "cd " + folder.path().string() + " && PATH=\"$PWD:$PATH\" bash ";
  CHECK(std::system((here + "job.sh > said").c_str()) == 0);
  CHECK(read_text(folder / "submitted") ==
        "--parsable job.sh\n"
        "--dependency=afterany:7 --job-name=pbf-collect --array=0 --cpus-per-task=1 --time=10 "
        "job.sh collect\n");
  CHECK(std::system((here + "job.sh collect > said").c_str()) == 0);
  CHECK(has(read_text(folder / "said"), "2 runs: 2 finished"));
  folder.write("sbatch", "#!/bin/sh\nexit 3\n");
  CHECK(std::system((here + "job.sh > said").c_str()) != 0);
  CHECK(read_text(folder / "said").empty());
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

TEST_CASE("the Slurm script asks for the CPUs, the time, the memory and the GPU that are needed") {
  const Scratch folder;
  folder.write("tiny.yaml", tiny_scene());
  const auto script = [&](std::vector<std::string> more) {
    std::vector<std::string> args{"batch", "tiny.yaml", "--slurm"};
    args.insert(args.end(), more.begin(), more.end());
    return pbf::test::pbf(args, folder.path());
  };
  const auto memory = [](const Outcome& o) {
    REQUIRE(o.code == 0);
    return std::stol(o.out.substr(o.out.find("--mem=") + 6));
  };
  const Outcome o = script({"--threads", "7", "--time", "1-12"});
  CHECK(has(o.out, "#SBATCH --cpus-per-task=7\n"));
  CHECK(has(o.out, "#SBATCH --time=1-12\n#SBATCH --signal=TERM@120\n"));
  // The largest run of the grid decides; the forecast is that of pbf plan.
  const std::string fine = "fluid.spacing=0.004";
  const Outcome plan = pbf::test::pbf(
      {"plan", "tiny.yaml", "--set", fine, "--set", "threads=4", "--json"}, folder.path());
  const double bytes = std::stod(
      plan.out.substr(plan.out.find("\"host_peak\":") + std::string("\"host_peak\":").size()));
  const long asked = memory(script({"--grid", fine + ",0.1"}));
  CHECK(double(asked) * 1048576 > 1.2 * bytes);
  CHECK(double(asked) * 1048576 < 1.3 * bytes + 100e6);
  CHECK(asked > memory(script({})));
  CHECK(has(script({"--set", "backend=cuda"}).out, "#SBATCH --gres=gpu:1\n"));
  CHECK(has(script({"--set", "backend=cuda"}).out, " --gres=none \"$0\" collect"));
  for (const char* time : {"1", "2:30", "0:1:30"}) CHECK(script({"--time", time}).code == 0);
  CHECK(has(script({"--time", "2"}).out, "--signal=TERM@60\n"));
  for (const char* time : {"", "0", "0:59", "1h", "1-", "1:2:3:4", "-5", "1\n#SBATCH --wrap=x"}) {
    CAPTURE(time);
    const Outcome wrong = script({"--time", time});
    CHECK(wrong.code == 2);
    CHECK(wrong.out.empty());
  }
  // A run that cannot be is told before anything is queued.
  const Outcome bad = script({"--grid", "solver.iterations=2,-2"});
  CHECK(bad.code == 2);
  CHECK(bad.out.empty());
  CHECK(has(bad.err, "1 of 2 runs cannot start"));
}

TEST_CASE("the Slurm script of runs on ranks starts them with srun, which gives each its CPUs") {
  const Scratch folder;
  folder.write("tiny.yaml", tiny_scene());
  const auto script = [&](const char* ranks) {
    return pbf::test::pbf({"batch", "tiny.yaml", "--slurm", "--threads", "2", "--ranks", ranks},
                          folder.path());
  };
  const Outcome two = script("2");
  CHECK(has(two.out, "#SBATCH --cpus-per-task=2\n#SBATCH --ntasks=2\n#SBATCH --mem-per-cpu="));
  CHECK_FALSE(has(two.out, "--mem="));
  CHECK(has(two.out, "\nsrun --mpi=pmix "));
  CHECK(has(two.out, "--time=10 --ntasks=1 \"$0\" collect"));
  folder.write("tiny.yaml", tiny_scene("backend: cuda\n"));
  const Outcome gpus = script("2");
  CHECK(has(gpus.out, "#SBATCH --gpus-per-task=1\n"));
  CHECK_FALSE(has(gpus.out, "gres"));
  folder.write("tiny.yaml", tiny_scene());
  const Outcome one = script("1");
  CHECK(has(one.out, "#SBATCH --mem="));
  CHECK(has(one.out, "\nsrun /"));
  const Outcome many = script("999");
  CHECK(many.code == 2);
  CHECK(has(many.err, "too few for 999 ranks"));
  CHECK(many.out.empty());
}

TEST_CASE("whatever is in its words, the Slurm script runs one command and nothing else",
          "[slow]") {
  const Scratch folder;
  // Each word would make a file `owned` if the script let it.
  const std::vector<std::string> words{"name=b\ntouch owned #",
                                       "name=b\n#SBATCH --wrap=x\n touch owned",
                                       "name=b\r\ntouch owned",
                                       "name='; touch owned; '",
                                       "name='\n touch owned; '\n'",
                                       "name=\"; touch owned; \"",
                                       "name=$(touch owned)",
                                       "name=`touch owned`",
                                       "name=$HOME ~ * ? ! # & | ; < > ( ) { } [ ] \\ \\n",
                                       "name=\\'\n\\\\",
                                       "name=\t\x01\x7f\xC3\xA4"};
  int scripts = 0;
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
      if (o.code == 2 && where[0] == '-') {  // no name of a scene
        CHECK(o.out.empty());
        continue;
      }
      REQUIRE(o.code == 0);
      ++scripts;
      std::size_t directives = 0, lines = 0;
      std::istringstream text(o.out);
      for (std::string line; std::getline(text, line); ++lines)
        directives += line.rfind("#SBATCH", 0) == 0;
      CHECK(directives == 8);
      CHECK(lines == 29);
      const std::string script = folder.write("job.sh", o.out);
      const std::string run =
          "cd " + folder.path().string() +
          " && rm -f words owned && SLURM_ARRAY_TASK_ID=0 PATH=\"$PWD:$PATH\" bash " + script +
          " 2>errors";
      CHECK(std::system(run.c_str()) == 0);
      CHECK_FALSE(fs::exists(folder / "owned"));
      const std::string given = read_text(folder / "words");
      const std::string end = where == std::string("INPUT") ? name : word;
      CHECK(has(given, end + std::string(1, '\0')));
      fs::remove(folder / name);
    }
  CHECK(scripts >= 30);
}
