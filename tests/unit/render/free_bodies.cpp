// Pictures of free bodies: they are drawn where the snapshot has them.
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "lib/render/reach.h"
#include "lib/scene/vector3.h"
#include "tests/support/render_support.h"

using namespace pbf;
using namespace pbf_test;

namespace {

/// A pool 0.5 m deep and a cube above it.
Scene pool_with_cube(double height) {
  Scene s;
  s.name = "cube";
  s.domain.max = {2, 1, 3};
  s.fluid.spacing = 0.05;
  s.bodies.resize(1);
  s.bodies[0].max = {2, 1, 0.5};
  s.obstacles = {box_obstacle({0.8, 0.3, height - 0.2}, {1.2, 0.7, height + 0.2}, {0, 0, 1}, 0)};
  s.obstacles[0].free.emplace().density = 500;
  s.render.emplace().size = {320, 240};
  s.render->color = ColorBy::compression;
  return s;
}

BodyMotion turned_cube() {
  BodyMotion m;
  m.middle = {0.6, 0.5, 0.9};
  const double c = std::cos(0.6), s = std::sin(0.6);
  m.turn = {Double3{c, 0, s}, Double3{0, 1, 0}, Double3{-s, 0, c}};
  return m;
}

Snapshot with_cube(const std::vector<BodyMotion>& bodies) {
  Snapshot s = snapshot({{0.1, 0.5, 0.1}}, {0.5});
  s.bodies = bodies;
  return s;
}

std::string file_bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

TEST_CASE("the solids of a view are where a frame has its free bodies", "[render]") {
  const View view = view_of(pool_with_cube(1.5), 1);
  REQUIRE(view.solids_at);
  const BodyMotion now = turned_cube();
  const Solid<double> moved = view.solids_at(7, {now})[0];
  CHECK(moved.center.x == Approx(0.6));
  CHECK(moved.center.z == Approx(0.9));
  // A corner of the cube, turned by hand, lies on the surface.
  const Double3 corner{0.2, 0.2, 0.2};
  const Double3 at = now.middle + Double3{dot(now.turn[0], corner), dot(now.turn[1], corner),
                                          dot(now.turn[2], corner)};
  CHECK(distance<3>(moved, Vec3<double>{at[0], at[1], at[2]}) == Approx(0).margin(1e-12));
  CHECK(view.solids_at(0, {})[0].center.z == Approx(1.5));  // and back at the start
}

TEST_CASE("a picture and one that a thread draws show a free body in its place", "[render]") {
  PBF_NEEDS_GL();
  const View view = view_of(pool_with_cube(1.5), 1);
  View there = view;
  there.solids = view.solids_at(0, {turned_cube()});
  there.solids_at = nullptr;
  Renderer follows(view), stands(there);
  const Snapshot snapshot = with_cube({turned_cube()});
  const Image moved = follows.draw(snapshot);
  CHECK(moved.rgb == stands.draw(snapshot).rgb);
  CHECK(share_off(moved, follows.draw(with_cube({}))) > 0.01);

  const auto folder =
      std::filesystem::temp_directory_path() / ("pbf_bodies_" + std::to_string(getpid()));
  {
    RenderThread thread(view);
    thread.into(folder.string());
    thread.draw(snapshot, 0);
    thread.finish();
  }
  write_png((folder / "own.png").string(), moved);
  CHECK(file_bytes(folder / "frame_000000.png") == file_bytes(folder / "own.png"));
  std::filesystem::remove_all(folder);
}

TEST_CASE("the frame holds a free body at its start, and what its fall throws up", "[render]") {
  const Double3 up{0, 0, 1};
  Scene standing = pool_with_cube(1);
  standing.obstacles.clear();
  const Reach without = reach_of(standing, up, 8000);
  const Reach low = reach_of(pool_with_cube(0.75), up, 8000),
              high = reach_of(pool_with_cube(2.5), up, 8000);
  CHECK(high.height >= 2.7);
  CHECK(low.height > without.height);
  CHECK(high.speed > 2 * low.speed);
  Scene held = pool_with_cube(2.5);
  held.obstacles[0].free->lock = {"z"};
  CHECK(reach_of(held, up, 8000).speed < 0.5 * high.speed);
}

TEST_CASE("whether a free body can fall is a question of the axis that is up", "[render]") {
  Scene s = pool_with_cube(1);
  s.domain.max = {3, 1, 2};
  s.gravity = {-9.81, 0, 0};
  s.bodies[0].max = {0.5, 1, 2};
  s.obstacles = {box_obstacle({2.3, 0.3, 0.8}, {2.7, 0.7, 1.2}, {0, 0, 1}, 0)};
  FreeBody& cube = s.obstacles[0].free.emplace();
  cube.density = 500;
  const auto speed = [&](std::vector<std::string> lock) {
    cube.lock = std::move(lock);
    return reach_of(s, {1, 0, 0}, 8000).speed;
  };
  CHECK(speed({"z"}) == speed({}));
  CHECK(speed({"x"}) < 0.5 * speed({}));
}
