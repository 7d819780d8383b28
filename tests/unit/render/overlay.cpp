// Colour bar, numbers, time and font; drawn on the CPU, no OpenGL needed.
#include "lib/render/overlay.h"

#include "lib/render/font.h"
#include "tests/support/render_support.h"

using namespace pbf;
using namespace pbf_test;

namespace {

Image white(int width, int height) {
  return {width, height,
          std::vector<std::uint8_t>(3 * static_cast<std::size_t>(width) * height, 255)};
}

/// Number of dark pixels in [x0, x1) x [y0, y1).
int ink(const Image& image, double x0, double y0, double x1, double y1) {
  int dark = 0;
  for (int y = std::max(0, static_cast<int>(y0)); y < std::min(image.height, static_cast<int>(y1));
       ++y)
    for (int x = std::max(0, static_cast<int>(x0)); x < std::min(image.width, static_cast<int>(x1));
         ++x)
      dark += pixel(image, x, y)[1] < 128;
  return dark;
}

std::vector<std::string> labels(double low, double high) {
  std::vector<std::string> all;
  for (const auto& tick : ticks_of({low, high})) all.push_back(tick.label);
  return all;
}

using Labels = std::vector<std::string>;

}  // namespace

TEST_CASE("ticks are round numbers with the digits that they need", "[render]") {
  CHECK(labels(0, 4.43) == Labels{"0", "1", "2", "3", "4"});
  CHECK(labels(900, 1100) == Labels{"900", "950", "1000", "1050", "1100"});
  CHECK(labels(0, 1) == Labels{"0.0", "0.2", "0.4", "0.6", "0.8", "1.0"});
  CHECK(labels(-1, 1) == Labels{"-1.0", "-0.5", "0.0", "0.5", "1.0"});
  CHECK(labels(0, 1e-6) == Labels{"0e+00", "2e-07", "4e-07", "6e-07", "8e-07", "1e-06"});
  for (double low : {0.0, -3.7, 1e6, 0.123})
    for (double span : {1e-3, 0.7, 1.0, 2.4, 6.1, 9.9, 12345.0}) {
      const auto ticks = ticks_of({low, low + span});
      INFO(low << " + " << span);
      CHECK(ticks.size() >= 3);
      CHECK(ticks.size() <= 8);
      for (std::size_t i = 0; i < ticks.size(); ++i) {
        CHECK(ticks[i].value >= low - 1e-6 * span);
        CHECK(ticks[i].value <= low + span * (1 + 1e-6));
        CHECK(std::abs(std::stod(ticks[i].label) - ticks[i].value) < 1e-6 * span);
        if (i > 0) CHECK(ticks[i].label != ticks[i - 1].label);
      }
    }
}

TEST_CASE("the time has two decimals, or as many as it needs", "[render]") {
  CHECK(time_text(0) == "t = 0.00 s");
  CHECK(time_text(0.52) == "t = 0.52 s");
  CHECK(time_text(26 * 0.02f) == "t = 0.52 s");
  CHECK(time_text(0.5225) == "t = 0.5225 s");
  CHECK(time_text(12) == "t = 12.00 s");
  CHECK(time_text(2.5e-5) == "t = 2.50e-05 s");
}

TEST_CASE("the colour bar runs from the low to the high end of viridis", "[render]") {
  Image image = white(640, 360);
  draw_overlay(image, "speed", "m/s", {0, 4.43}, 0.52);
  const BarPlace bar = bar_place(640, 360, ticks_of({0, 4.43}));
  const int middle = static_cast<int>(0.5 * (bar.x0 + bar.x1));
  const double span = bar.y1 - bar.y0;
  for (double t : {0.02, 0.25, 0.5, 0.75, 0.98}) {
    const Rgb seen = pixel(image, middle, static_cast<int>(bar.y1 - t * span)), want = viridis(t);
    for (std::size_t k = 0; k < 3; ++k) CHECK(std::abs(seen[k] - want[k]) <= 3);
  }
}

TEST_CASE("every tick has a label beside it, and title, unit and time are written", "[render]") {
  Image image = white(640, 360);
  const auto ticks = ticks_of({0, 4.43});
  draw_overlay(image, "speed", "m/s", {0, 4.43}, 0.52);
  const BarPlace bar = bar_place(640, 360, ticks);
  const double text = bar.x1 + 5 * bar.dot;
  for (const auto& tick : ticks) {
    const double y = bar.y1 - tick.value / 4.43 * (bar.y1 - bar.y0);
    INFO("label " << tick.label);
    CHECK(ink(image, text, y - 5 * bar.dot, 640, y + 5 * bar.dot) > 4);
    CHECK(ink(image, text, y + 6 * bar.dot, 640, y + 10 * bar.dot) == 0);
  }
  CHECK(ink(image, 500, bar.y0 - 28 * bar.dot, 640, bar.y0 - 16 * bar.dot) > 30);
  CHECK(ink(image, 500, bar.y0 - 15 * bar.dot, 640, bar.y0 - 5 * bar.dot) > 15);
  CHECK(ink(image, 0, 0, 200, 40) > 30);
}

TEST_CASE("characters differ from each other and stay inside their width", "[render]") {
  std::vector<std::vector<std::uint8_t>> seen;
  // The letter O is left out: it is the figure 0.
  const std::string all =
      "0123456789ABCDEFGHIJKLMNPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz.,-+=()/:%*_?";
  for (char c : all) {
    Image image = white(40, 40);
    draw_text(image, std::string(1, c), 10, 10, 2, {0, 0, 0});
    INFO("character " << c);
    CHECK(ink(image, 0, 0, 40, 40) > 0);
    CHECK(ink(image, 0, 0, 9, 40) == 0);
    CHECK(ink(image, 11 + text_width(std::string(1, c), 2), 0, 40, 40) == 0);
    CHECK(std::find(seen.begin(), seen.end(), image.rgb) == seen.end());
    seen.push_back(image.rgb);
  }
}

TEST_CASE("a power is raised and text is clipped to the picture", "[render]") {
  Image image = white(60, 30);
  draw_text(image, "^3", 5, 10, 2, {0, 0, 0});
  CHECK(ink(image, 0, 0, 60, 10) > 0);
  CHECK(ink(image, 0, 18, 60, 30) == 0);
  Image small = white(8, 8);
  draw_text(small, "wider than the picture", -20, -3, 2, {0, 0, 0});
  draw_overlay(small, "density", "kg/m^3", {900, 1100}, 1);
  CHECK(small.rgb.size() == 3u * 8 * 8);
}
