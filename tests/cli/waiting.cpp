// How many threads a run takes, and that those which wait leave the cores to others.
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>

#include "tests/support/catch.h"
#include "tests/support/process.h"

using namespace pbf::test;

namespace {

/// How often a waiting thread looks for work before it sleeps, as the OpenMP runtime itself says;
/// empty with a runtime that does not tell.
std::string spin_count(std::vector<std::string> environment) {
  const Scratch folder;
  environment.push_back("OMP_DISPLAY_ENV=verbose");
  const Outcome o = pbf::test::pbf({"--version"}, folder.path(), environment);
  REQUIRE(o.code == 0);
  const std::string name = "GOMP_SPINCOUNT = '";
  const std::size_t at = o.err.find(name);
  if (at == std::string::npos) return {};
  return o.err.substr(at + name.size(), o.err.find('\'', at + name.size()) - at - name.size());
}

/// This process, and all that it starts, on two cores (where it may use two), which as many busy
/// processes share, until the end.
class TwoBusyCores {
 public:
  TwoBusyCores() {
    sched_getaffinity(0, sizeof before_, &before_);
    cpu_set_t two;
    CPU_ZERO(&two);
    for (int c = 0; c < CPU_SETSIZE && CPU_COUNT(&two) < 2; ++c)
      if (CPU_ISSET(c, &before_)) CPU_SET(c, &two);
    sched_setaffinity(0, sizeof two, &two);
    for (pid_t& child : busy_) {
      child = fork();
      if (child != 0) continue;
      alarm(60);  // should this program be killed
      for (std::atomic<unsigned> turns{0};; ++turns) {
      }
    }
  }
  ~TwoBusyCores() {
    for (const pid_t child : busy_) {
      if (child <= 0) continue;
      kill(child, SIGKILL);
      waitpid(child, nullptr, 0);
    }
    sched_setaffinity(0, sizeof before_, &before_);
  }
  TwoBusyCores(const TwoBusyCores&) = delete;
  TwoBusyCores& operator=(const TwoBusyCores&) = delete;

 private:
  cpu_set_t before_{};
  std::array<pid_t, 2> busy_{};
};

}  // namespace

TEST_CASE("waiting threads sleep soon, by the runtime's own word, unless the user says otherwise") {
  const std::string count = spin_count({});
  if (count.empty()) PBF_SKIP("another compiler's runtime, which does not tell");
  CHECK(count == "1000");
  CHECK(spin_count({"GOMP_SPINCOUNT=7"}) == "7");
  CHECK(spin_count({"OMP_WAIT_POLICY=passive"}) == "0");
  CHECK(std::stod(spin_count({"OMP_WAIT_POLICY=active"})) > 1e6);
}

TEST_CASE("threads that wait for one whose core is taken use next to no CPU time", "[slow]") {
  const Scratch folder;
  const std::string scene = folder.write(
      "s.yaml",
      "domain: {min: [0, 0, 0], max: [2, 2, 2]}\n"
      "fluid: {spacing: 0.1}\n"
      "bodies: [{shape: block, min: [0, 0, 0], max: [1.6, 1.6, 1.6]}]\n"  // 4096 particles
      "guard: off\n"
      "measure_every: 100000\n"
      "time: {step: 0.002, end: 0.2}\n");
  const TwoBusyCores cores;
  const auto user_seconds = [&](int threads) {
    double seconds = 0;
    const Outcome o = Process({"run", scene, "--quiet", "--overwrite", "--out", "o", "--threads",
                               std::to_string(threads)},
                              folder.path())
                          .wait(&seconds);
    CAPTURE(o.err);
    CHECK(o.code == 0);
    return seconds;
  };
  const double one = user_seconds(1), two = user_seconds(2), four = user_seconds(4);
  CAPTURE(one, two, four);
  CHECK(two < 2 * one);
  CHECK(four < 3 * one);
}

TEST_CASE("a small scene runs on one thread unless threads are given, and plan and run say so") {
  const Scratch folder;
  const std::string scene = folder.write("tiny.yaml", tiny_scene());
  CHECK(has(pbf::test::pbf({"plan", scene}, folder.path()).out, "; cpu float, 1 thread"));
  CHECK(has(pbf::test::pbf({"plan", scene, "--json"}, folder.path()).out, "\"threads\":1,"));
  CHECK(has(pbf::test::pbf({"plan", scene, "--set", "threads=3"}, folder.path()).out,
            "; cpu float, 3 threads\n"));
  CHECK(has(pbf::test::pbf({"run", scene, "--out", "a"}, folder.path()).err, "float, 1 thread"));
  CHECK(has(pbf::test::pbf({"run", scene, "--out", "b", "--threads", "3"}, folder.path()).err,
            "float, 3 threads on"));
}
