// Opening the GL library, and what the renderer refuses.
#include <fstream>

#include "tests/support/render_support.h"

using namespace pbf;
using namespace pbf_test;

namespace {

/// Names of the GL libraries that this process has mapped.
std::string mapped_gl() {
  std::ifstream maps("/proc/self/maps");
  std::string found, line;
  while (std::getline(maps, line))
    for (const char* name : {"OSMesa", "libEGL", "libGL", "libLLVM"})
      if (line.find(name) != std::string::npos) found += line + "\n";
  return found;
}

// Before main(), and so before any test has made a renderer.
const std::string at_start = mapped_gl();

}  // namespace

TEST_CASE("no GL library is loaded before the first renderer, one is after it", "[render]") {
  CHECK(at_start == "");
  PBF_NEEDS_GL();
  const Renderer renderer(front_view());
  CHECK(mapped_gl() != "");
  CHECK(renderer.backend() != "");
}

TEST_CASE("without a GL library the error names what was tried and what to install", "[render]") {
  const Environment any("PBF_GL", "");  // as if it were not set
  const GlLibraries none{{"libOSMesa-absent.so.8"}, {"libEGL-absent.so.1"}};
  const auto [code, text] = error_of([&] { GlContext context(0, none); });
  CHECK(code == 4);
  for (const char* part :
       {"libOSMesa-absent.so.8", "libEGL-absent.so.1", "libosmesa6", "libegl1", "libgl1-mesa-dri"})
    CHECK(text.find(part) != std::string::npos);
}

TEST_CASE("PBF_GL allows one way only, and only a known one", "[render]") {
  {
    const Environment set("PBF_GL", "directx");
    const auto [code, text] = error_of([] { GlContext context; });
    CHECK(code == 2);
    CHECK(text.find("osmesa, egl or egl-device") != std::string::npos);
  }
  const Environment set("PBF_GL", "osmesa");
  const auto [code, text] = error_of([] {
    GlContext(0, {{"libOSMesa-absent.so"}, {"libEGL.so.1"}});
  });
  CHECK(code == 4);
  CHECK(text.find("EGL") == std::string::npos);
}

TEST_CASE("the number of raster threads does not stay in the environment", "[render]") {
  if (std::getenv("LP_NUM_THREADS")) PBF_SKIP("LP_NUM_THREADS is set, and is kept as it is");
  error_of([] { GlContext(3, {{"libOSMesa-absent.so"}, {"libEGL-absent.so"}}); });
  CHECK(std::getenv("LP_NUM_THREADS") == nullptr);
}

TEST_CASE("a view that cannot be drawn is refused by the name of its key", "[render]") {
  const auto refused = [](auto change, const char* key) {
    View view = front_view();
    change(view);
    const auto [code, text] = error_of([&] { Renderer renderer(view); });
    INFO(text);
    CHECK(code == 2);
    CHECK(text.find(key) != std::string::npos);
  };
  refused([](View& v) { v.size = {0, 100}; }, "render.size");
  refused([](View& v) { v.range = {1, 1}; }, "render.range");
  refused([](View& v) { v.range = {0, HUGE_VAL}; }, "render.range");
  refused([](View& v) { v.radius = 0; }, "render.radius");
  refused([](View& v) { v.camera.fov = 180; }, "render.camera.fov");
}

TEST_CASE("a picture larger than the driver allows is refused with its limit", "[render]") {
  PBF_NEEDS_GL();
  View view = front_view();
  view.size = {200000, 100};
  const auto [code, text] = error_of([&] { Renderer renderer(view); });
  CHECK(code == 2);
  CHECK(text.find("render.size: 200000 x 100 is more than") != std::string::npos);
}

TEST_CASE("a snapshot without the field of the colour is refused by its name", "[render]") {
  PBF_NEEDS_GL();
  View view = front_view();
  view.color = ColorBy::speed;
  Renderer renderer(view);
  const auto [code, text] = error_of([&] { renderer.draw(snapshot({{0, 0, 0}}, {1})); });
  CHECK(code == 2);
  CHECK(text.find("needs the field velocity") != std::string::npos);
  CHECK(text.find("position, density") != std::string::npos);

  Snapshot ragged = snapshot({{0, 0, 0}}, {1});
  ragged.fields.push_back(field<float>("velocity", "m/s", 3, {1, 2}));
  CHECK(error_of([&] { renderer.draw(ragged); }).first == 2);
  CHECK(error_of([&] { renderer.draw(Snapshot{}); }).second.find("position") != std::string::npos);
}

TEST_CASE("EGL without a window draws the same picture as the first choice", "[slow][render]") {
  PBF_NEEDS_GL();
  const Snapshot s = snapshot({{0, 0, 0}, {0.6, 0.5, 0.4}, {-0.6, -0.3, 0.2}}, {0.1, 0.5, 0.9});
  Renderer first(front_view());
  if (first.backend().find("llvmpipe") == std::string::npos)
    PBF_SKIP("hardware rounds its own way: " << first.backend());
  const Environment set("PBF_GL", "egl");
  const auto [code, text] = error_of([] { GlContext context; });
  if (code == 4) PBF_SKIP("no EGL: " << text);
  CHECK(share_off(Renderer(front_view()).draw(s), first.draw(s)) <= 1e-3);
}
