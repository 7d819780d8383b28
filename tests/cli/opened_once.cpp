// A run opens each particle file of its scene once, whatever it asks of the particles.
#include <sys/inotify.h>
#include <unistd.h>

#include <cstddef>
#include <vector>

#include "lib/io/particle_file.h"
#include "tests/support/catch.h"
#include "tests/support/process.h"

using namespace pbf::test;

namespace {

/// How often a file is opened, by any process and under any name. Between two openings it must be
/// read or closed: the system merges equal events.
class Opened {
 public:
  explicit Opened(const std::string& path) : fd_(inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {
    REQUIRE(inotify_add_watch(fd_, path.c_str(), IN_OPEN | IN_ACCESS | IN_CLOSE) >= 0);
  }
  ~Opened() { close(fd_); }
  Opened(const Opened&) = delete;
  int times() {
    alignas(inotify_event) char bytes[1 << 14];
    int n = 0;
    for (ssize_t size; (size = read(fd_, bytes, sizeof bytes)) > 0;)
      for (ssize_t at = 0; at < size;) {
        const auto* event = reinterpret_cast<const inotify_event*>(bytes + at);
        n += (event->mask & IN_OPEN) != 0;
        at += ssize_t(sizeof *event + event->len);
      }
    return n;
  }

 private:
  int fd_;
};

pbf::Particles four(double z) {
  pbf::Particles p;
  for (const double x : {0.3, 0.4, 0.5, 0.6}) p.position.push_back({x, 0.5, z});
  p.velocity.resize(4);
  return p;
}

}  // namespace

TEST_CASE("a particle file of a run is opened once, CSV and HDF5, with and without an obstacle") {
  const Scratch folder;
  const std::string csv =
      folder.write("a.csv", "x,y,z\n0.3,0.5,0.2\n0.4,0.5,0.2\n0.5,0.5,0.2\n0.6,0.5,0.2\n");
  const std::string h5 = (folder / "b.h5").string();
  pbf::write_particle_file(h5, four(0.3));
  const std::string obstacle = GENERATE(
      "", "obstacles: [{name: solid, shape: box, min: [0.8, 0.8, 0.8], max: [0.9, 0.9, 0.9]}]\n");
  folder.write("s.yaml",
               "domain: {min: [0, 0, 0], max: [1, 1, 1]}\nfluid: {spacing: 0.1}\n"
               "bodies: [{shape: file, path: a.csv}, {shape: file, path: b.h5}]\n"
               "time: {step: 0.005, end: 0.02}\noutput: {every: 0.02}\n" +
                   obstacle);
  Opened opened_csv(csv), opened_h5(h5);
  const Outcome o = run_scene(folder, "out");
  CAPTURE(o.err, obstacle);
  REQUIRE(o.code == 0);
  CHECK(opened_csv.times() == 1);
  CHECK(opened_h5.times() == 1);
  REQUIRE(pbf::test::pbf({"plan", "s.yaml"}, folder.path()).code == 0);
  CHECK(opened_csv.times() == 1);
  CHECK(opened_h5.times() == 1);
  // What counts is what is opened: the same watch sees a second reader.
  read_text(csv);
  read_text(csv);
  CHECK(opened_csv.times() == 2);
}

TEST_CASE("a table of motion is opened once, and the run file has the SHA-256 of what was read") {
  const Scratch folder;
  const std::string table = folder.write("m.csv", "t,x,y,z\n0,0,0,0\n1,0.1,0,0\n");
  folder.write(
      "s.yaml",
      tiny_scene("obstacles: [{name: solid, shape: sphere, center: [0.5, 0.5, 0.9], radius: "
                 "0.2, motion: {kind: file, path: m.csv}}]\n"));
  Opened opened(table);
  const Outcome o = run_scene(folder, "out");
  CAPTURE(o.err);
  REQUIRE(o.code == 0);
  CHECK(opened.times() == 1);
  folder.write("sums", read_text(folder / "out/scene.resolved.yaml"));
  CHECK(shell("sed -n 's/^# \\([0-9a-f]\\{64\\}  \\)/\\1/p' sums | sha256sum --quiet -c -",
              folder.path())
            .code == 0);
}
