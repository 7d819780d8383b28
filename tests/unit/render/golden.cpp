// One small picture against a kept one. At most 0.1 % of the pixels may be off by more than 8:
// rasterisers differ in rounding at outlines, never in what is seen.
// PBF_UPDATE_GOLDEN=1 writes the kept picture anew; look at it before committing it.
#include <png.h>

#include "tests/support/render_support.h"

using namespace pbf;
using namespace pbf_test;

namespace {

Image read_png(const std::string& path) {
  png_image reader{};
  reader.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_file(&reader, path.c_str())) return {};
  reader.format = PNG_FORMAT_RGB;
  Image image{static_cast<int>(reader.width), static_cast<int>(reader.height),
              std::vector<std::uint8_t>(PNG_IMAGE_SIZE(reader))};
  if (!png_image_finish_read(&reader, nullptr, image.rgb.data(), 0, nullptr)) return {};
  return image;
}

/// A column that leans over a dry floor, with a few drops, faster to the front.
Snapshot leaning_column() {
  std::vector<double> position, velocity;
  const double d = 0.06;
  for (int k = 0; k < 12; ++k)
    for (int j = 0; j < 16; ++j)
      for (int i = 0; i < 12 + (k % 5) - k / 2; ++i) {
        const double x = (i + 0.5) * d, y = (j + 0.5) * d, z = (k + 0.5) * d;
        position.insert(position.end(), {x + 0.2 * z * z, y, z});
        velocity.insert(velocity.end(), {3 * x, 0, -z});
      }
  for (int i = 0; i < 12; ++i) {
    position.insert(position.end(),
                    {1.1 + 0.06 * i, 0.5 + 0.4 * std::sin(2.0 * i), 0.1 + 0.03 * i});
    velocity.insert(velocity.end(), {0.35 * i, 0, 0});
  }
  Snapshot s;
  s.time = 0.52;
  s.count = position.size() / 3;
  s.fields = {field("position", "m", 3, position), field("velocity", "m/s", 3, velocity)};
  return s;
}

void check_kept(const View& view, const std::string& name) {
  Renderer renderer(view);
  if (renderer.backend().find("llvmpipe") == std::string::npos)
    PBF_SKIP("no OpenGL of Mesa, for which the kept picture holds: " << renderer.backend());
  const Image image = renderer.draw(leaning_column());
  const std::string path = PBF_SOURCE_DIR "/tests/unit/render/golden/" + name + ".png";
  if (std::getenv("PBF_UPDATE_GOLDEN")) write_png(path, image);
  const Image kept = read_png(path);
  REQUIRE(kept.width == 320);
  const double off = share_off(image, kept);
  if (off > 1e-3) write_png(name + "_seen.png", image);
  INFO("the picture seen is in " << name << "_seen.png in the working folder");
  CHECK(off <= 1e-3);
}

Scene tank() {
  Scene scene;
  scene.name = "Säule";
  scene.domain.max = {2, 1, 1};
  scene.bodies.resize(1);
  scene.bodies[0].max = {0.7, 1, 0.7};
  scene.render = Render{};
  scene.render->radius = 0.03;
  scene.render->range = {0, 4};
  scene.render->size = {320, 180};
  return scene;
}

}  // namespace

TEST_CASE("a small dam break looks like the kept picture", "[render]") {
  PBF_NEEDS_GL();
  check_kept(view_of(tank(), 1), "leaning_column");
}

TEST_CASE("a small dam break among obstacles looks like the kept picture", "[render]") {
  PBF_NEEDS_GL();
  Scene scene = tank();
  scene.obstacles = {box_obstacle({1.1, -0.1, 0.1}, {1.6, 0.3, 0.3}, {0, 1, 0}, 20),
                     sphere_obstacle({1.4, 0.7, 0.25}, 0.2),
                     tube_obstacle(ObstacleShape::cylinder, {1.8, 0.8, 0}, {1.8, 0.8, 0.7}, 0.1),
                     plane_obstacle({1.7, 0, 0}, {-1, 0, 1})};
  check_kept(view_of(scene, 1), "obstacles");
}

TEST_CASE("a small dam break as one surface looks like the kept picture", "[render]") {
  PBF_NEEDS_GL();
  Scene scene = tank();
  scene.render->style = RenderStyle::surface;
  check_kept(view_of(scene, 1), "surface");
}
