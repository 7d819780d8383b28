// Pictures drawn on a thread of their own.
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "tests/support/render_support.h"

using namespace pbf;
using namespace pbf_test;
namespace fs = std::filesystem;

namespace {

struct Folder {
  fs::path path;
  explicit Folder(const std::string& name)
      : path(fs::temp_directory_path() / ("pbf_" + name + "_" + std::to_string(getpid()))) {
    fs::remove_all(path);
  }
  ~Folder() { fs::remove_all(path); }
};

std::string bytes_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

Snapshot at(int i) {
  Snapshot s = snapshot({{0.2 * i - 0.5, 0, 0}}, {0.15 * i});
  s.time = 0.1 * i;
  return s;
}

}  // namespace

TEST_CASE("the thread writes every picture under its number, as the renderer draws it",
          "[render]") {
  PBF_NEEDS_GL();
  const Folder dir("thread");
  {
    RenderThread thread(front_view());
    thread.into((dir.path / "frames").string());
    for (int i = 0; i < 6; ++i) {
      Snapshot s = at(i);
      thread.draw(s, 7 * i);
      s.fields[0].bytes.assign(s.fields[0].bytes.size(), std::byte{0});  // it has its own copy
    }
    thread.finish();
    CHECK(thread.seconds() > 0);
    thread.finish();  // a second time does no harm
  }
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(dir.path / "frames"))
    names.insert(entry.path().filename().string());
  CHECK(names == std::set<std::string>{"frame_000000.png", "frame_000007.png", "frame_000014.png",
                                       "frame_000021.png", "frame_000028.png", "frame_000035.png"});
  Renderer renderer(front_view());
  for (int i = 0; i < 6; ++i) {
    const fs::path own = dir.path / "own.png";
    write_png(own.string(), renderer.draw(at(i)));
    char name[32];
    std::snprintf(name, sizeof name, "frame_%06d.png", 7 * i);
    INFO(name);
    CHECK(bytes_of(dir.path / "frames" / name) == bytes_of(own));
  }
}

TEST_CASE("the thread draws a surface as the renderer does", "[render]") {
  PBF_NEEDS_GL();
  const Folder dir("thread_surface");
  View view = front_view();
  view.style = RenderStyle::surface;
  RenderThread thread(view);
  thread.into(dir.path.string());
  for (int i = 0; i < 3; ++i) thread.draw(at(i), i);
  thread.finish();
  Renderer renderer(view);
  const fs::path own = dir.path / "own.png";
  for (const int i : {2, 0}) {
    write_png(own.string(), renderer.draw(at(i)));
    CHECK(bytes_of(dir.path / ("frame_00000" + std::to_string(i) + ".png")) == bytes_of(own));
  }
}

TEST_CASE("an error of the thread is thrown by the next call, once", "[render]") {
  PBF_NEEDS_GL();
  const Folder dir("thread_error");
  RenderThread thread(front_view());
  thread.into(dir.path.string());
  fs::remove_all(dir.path);
  thread.draw(at(0), 0);
  const auto [code, text] = error_of([&] {
    for (int i = 1; i < 5; ++i) thread.draw(at(i), i);
    thread.finish();
  });
  CHECK(code == 5);
  CHECK(text.find("frame_000000.png") != std::string::npos);
  CHECK_NOTHROW(thread.finish());
}

TEST_CASE("a missing field is refused by the call that brings it", "[render]") {
  PBF_NEEDS_GL();
  const Folder dir("thread_field");
  View view = front_view();
  view.color = ColorBy::speed;
  RenderThread thread(view);
  thread.into(dir.path.string());
  CHECK(error_of([&] { thread.draw(at(0), 0); }).first == 2);
  CHECK_NOTHROW(thread.finish());
}

TEST_CASE("a folder that cannot be made is an error at once", "[render]") {
  const Folder dir("thread_folder");
  std::ofstream(dir.path) << "a file where the folder should be";
  const auto [code, text] = error_of([&] {
    RenderThread thread(front_view());
    thread.into((dir.path / "frames").string());
  });
  CHECK(code == 5);
  CHECK(text.find("frames") != std::string::npos);
}

TEST_CASE("a thread that is never finished still writes what it was given", "[render]") {
  PBF_NEEDS_GL();
  const Folder dir("thread_drop");
  {
    RenderThread thread(front_view());
    thread.into(dir.path.string());
    thread.draw(at(1), 3);
  }
  CHECK(fs::exists(dir.path / "frame_000003.png"));
}
