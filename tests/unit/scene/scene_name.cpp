// The name of a scene that says none: that of its file.
#include "lib/scene/scene_name.h"

#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "lib/scene/difference.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

LoadedScene loaded(const Folder& folder, const std::string& file, const std::string& text,
                   const std::vector<std::string>& set = {}) {
  return load_scene(folder.write(file, text), set);
}

}  // namespace

TEST_CASE("names: a scene without one is called as its file, and two of them apart") {
  const Folder folder;
  CHECK(loaded(folder, "tank.yaml", kMinimal).scene.name == "tank");
  CHECK(loaded(folder, "tank.yaml", kMinimal).named_by_file);
  CHECK(loaded(folder, "pool.yml", kMinimal).scene.name == "pool");
  CHECK(loaded(folder, "steep", kMinimal).scene.name == "steep");
  const LoadedScene named = loaded(folder, "a.yaml", kMinimal + "name: mine\n");
  CHECK(named.scene.name == "mine");
  CHECK_FALSE(named.named_by_file);
  CHECK(loaded(folder, "a.yaml", kMinimal, {"name=set"}).scene.name == "set");
}

TEST_CASE("names: what may not name a folder is left out of a file's name") {
  const Folder folder;
  CHECK(loaded(folder, "My tank (2).yaml", kMinimal).scene.name == "My-tank-2");
  CHECK(loaded(folder, "v1.2_h=3.yaml", kMinimal).scene.name == "v1.2_h=3");
  CHECK(loaded(folder, "Behälter.yaml", kMinimal).scene.name == "Beh-lter");
  CHECK(loaded(folder, "水.yaml", kMinimal).scene.name == "scene");
  CHECK(loaded(folder, ".yaml", kMinimal).scene.name == "scene");
  CHECK(loaded(folder, ".hidden.yaml", kMinimal).scene.name == "scene");
  CHECK(loaded(folder, "....yaml", kMinimal).scene.name == "scene");
  // Words that YAML reads as something else.
  CHECK(loaded(folder, "on.yaml", kMinimal).scene.name == "on");
  CHECK(loaded(folder, "null.yaml", kMinimal).scene.name == "null");
  CHECK(loaded(folder, "007.yaml", kMinimal).scene.name == "007");
  CHECK(parse(resolved_yaml(loaded(folder, "on.yaml", kMinimal).scene)).name == "on");
  CHECK(plain_name(std::string(400, 'x')).size() == 150);
  CHECK(plain_name("a" + std::string(200, '/') + "b") == "a-b");
  CHECK(plain_name("../..") == "..-..");
}

TEST_CASE("names: an empty one is still an error, and no file's name is taken in its place") {
  const Folder folder;
  CHECK(contains(error_of([&] { loaded(folder, "tank.yaml", kMinimal + "name: \"\"\n"); }),
                 "name: is empty, expected text"));
  CHECK(contains(error_of([&] { loaded(folder, "tank.yaml", kMinimal + "name:\n"); }),
                 "name: has no value"));
}

TEST_CASE("names: a scene on a base is called as its own file, whatever the base's name") {
  const Folder folder;
  folder.write("named.yaml", kMinimal + "name: tank\n");
  folder.write("plain.yaml", kMinimal);
  CHECK(loaded(folder, "steep.yaml", "base: named.yaml\n").scene.name == "steep");
  CHECK(loaded(folder, "steep.yaml", "base: plain.yaml\n").scene.name == "steep");
}

TEST_CASE("names: a scene from text or from a pipe is called scene") {
  CHECK(parse(kMinimal).name == "scene");
  const Folder folder;
  const std::string pipe = (folder.path / "pipe.yaml").string();
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  std::thread writer([&] { std::ofstream(pipe) << kMinimal; });
  const LoadedScene piped = load_scene(pipe, {});
  writer.join();
  CHECK(piped.scene.name == "scene");
  CHECK_FALSE(piped.named_by_file);
}

TEST_CASE("names: a scene that has moved to another file goes on with its run") {
  const Folder folder;
  const Scene before = loaded(folder, "tank.yaml", kMinimal).scene;
  const Scene now = loaded(folder, "pool.yaml", kMinimal).scene;
  CHECK(physics_difference(before, now) == "");
  CHECK(physics_difference(parse(kMinimal), now) == "");  // one recorded by an earlier version
}

}  // namespace pbf::scene_test
