// pbf batch --slurm: a script that runs every run as a task, and nothing else.
#include <sys/stat.h>
#include <sys/wait.h>

#include <cstdlib>
#include <sstream>

#include "tests/support/catch.h"
#include "tests/support/process.h"

using namespace pbf::test;
namespace fs = std::filesystem;

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
