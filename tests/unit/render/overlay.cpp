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

View bar_view(std::array<int, 2> size) {
  View view;
  view.name = "dam_break";
  view.domain_max = {1.6, 0.4, 1};
  view.range = {0, 4.43};
  view.size = size;
  return view;
}

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

TEST_CASE("the number of particles is written in groups of three", "[render]") {
  CHECK(particles_text(0) == "0 particles");
  CHECK(particles_text(1) == "1 particle");
  CHECK(particles_text(999) == "999 particles");
  CHECK(particles_text(31250) == "31 250 particles");
  CHECK(particles_text(123456789) == "123 456 789 particles");
}

TEST_CASE("the colour bar runs from the low to the high end of viridis", "[render]") {
  const View view = bar_view({640, 360});
  Image image = white(640, 360);
  draw_overlay(image, view, projection_of(view, 0), "m/s", 1000, 0.52);
  const TextBox bar = bar_place(view.size, ticks_of(view.range));
  const int middle = static_cast<int>(0.5 * (bar.x0 + bar.x1));
  const double span = bar.y1 - bar.y0;
  for (double t : {0.02, 0.25, 0.5, 0.75, 0.98}) {
    const Rgb seen = pixel(image, middle, static_cast<int>(bar.y1 - t * span)), want = viridis(t);
    for (std::size_t k = 0; k < 3; ++k) CHECK(std::abs(seen[k] - want[k]) <= 3);
  }
}

TEST_CASE("every tick has its number beside it, and title, unit, name and time are there",
          "[render]") {
  for (const std::array<int, 2>& size :
       {std::array{320, 240}, {640, 360}, {1280, 720}, {3840, 2160}}) {
    const View view = bar_view(size);
    const auto ticks = ticks_of(view.range);
    Image image = white(size[0], size[1]);
    draw_overlay(image, view, projection_of(view, 0), "m/s", 1000, 0.52);
    const TextBox bar = bar_place(size, ticks);
    const double em = text_size(size), text = bar.x1 + 0.5 * em;
    INFO("picture " << size[0] << " x " << size[1]);
    for (const auto& tick : ticks) {
      const double y = bar.y1 - tick.value / 4.43 * (bar.y1 - bar.y0);
      INFO("label " << tick.label);
      CHECK(ink(image, text, y - 0.5 * em, size[0], y + 0.5 * em) > 0.05 * em * em);
      CHECK(ink(image, text, y + 0.6 * em, size[0], y + 0.9 * em) == 0);
    }
    const double column = std::min(bar.x0, size[0] - 0.8 * em - text_width("speed", em)) - 1;
    // From the top: name, time, a gap, title, unit, a gap, the bar.
    CHECK(ink(image, column, bar.y0 - 3.3 * em, size[0], bar.y0 - 2.2 * em) > 0.3 * em * em);
    CHECK(ink(image, column, bar.y0 - 1.9 * em, size[0], bar.y0 - 0.9 * em) > 0.2 * em * em);
    CHECK(ink(image, 0, 0, size[0] / 2.0, 2 * em) > 0.4 * em * em);
    CHECK(ink(image, 0, 2.1 * em, size[0] / 2.0, 3.4 * em) > 0.4 * em * em);
    CHECK(em >= 11);
    CHECK(em >= 0.02 * std::min(size[1], size[0] / 2));
  }
}

TEST_CASE("no text is cut by the edge of the picture, whatever its size and contents", "[render]") {
  for (const std::array<int, 2>& size : {std::array{16, 16},
                                         {64, 48},
                                         {100, 400},
                                         {320, 240},
                                         {400, 120},
                                         {1280, 720},
                                         {1279, 333},
                                         {3840, 2160}})
    for (const char* name : {"dam_break",
                             "ein Name, der länger ist als jedes Bild der Welt und "
                             "noch länger, Ω und 水 und @ und ÿ inbegriffen",
                             ""})
      for (const double top : {1e-9, 0.14, 4.43, 12345678.0})
        for (const Double3& eye : {Double3{0, 0, 0}, Double3{2, -3, 2}, Double3{1, 0.5, 0.4}}) {
          View view = bar_view(size);
          view.name = name;
          view.range = {0.123 * top, top};
          if (eye[0] > 0) view.camera.position = eye;
          view.camera.target = Double3{0.8, 0.1, 0};
          Image image = white(size[0], size[1]);
          draw_overlay(image, view, projection_of(view, 0), "kg/m^3", 2147483647, 1234.5678);
          INFO(size[0] << " x " << size[1] << " " << name << " " << top << " " << eye[0]);
          int at_edge = 0;
          const TextBox bar = bar_place(size, ticks_of(view.range));
          for (int x = 0; x < size[0]; ++x)
            for (int y = 0; y < size[1]; ++y) {
              if (x > 0 && y > 0 && x < size[0] - 1 && y < size[1] - 1) {
                y = std::max(y, size[1] - 2);  // the rim alone
                continue;
              }
              const bool in_bar =
                  x >= bar.x0 - 3 && x <= bar.x1 + 12 && y >= bar.y0 - 3 && y <= bar.y1 + 3;
              at_edge += !in_bar && pixel(image, x, y)[1] < 200;
            }
          CHECK(at_edge == 0);
        }
}

TEST_CASE("a power is raised and a name stands as it is, in UTF-8", "[render]") {
  const auto drawn = [](const std::string& name, const std::string& unit) {
    View view = bar_view({640, 360});
    view.name = name;
    Image image = white(640, 360);
    draw_overlay(image, view, projection_of(view, 0), unit, 10, 1);
    return image.rgb;
  };
  CHECK(drawn("a", "kg/m^3") == drawn("a", "kg/m³"));
  CHECK(drawn("a", "kg/m^3") != drawn("a", "kg/m3"));
  CHECK(drawn("ä", "") != drawn("a", ""));
  CHECK(drawn("a^3", "") != drawn("a³", ""));
}

TEST_CASE("the default camera keeps its frame clear of labels and colour bar", "[render]") {
  for (const std::array<int, 2>& size : {std::array{320, 240}, {1280, 720}, {3840, 2160}})
    for (const bool flat : {false, true}) {
      View view = bar_view(size);
      view.flat = flat;
      if (flat) view.domain_max[1] = 0.01;
      const Projection p = projection_of(view, 0);
      const TextBox bar = bar_place(size, ticks_of(view.range));
      for (const Double3& corner : frame_of(view)) {
        const auto [x, y] = p.to_pixel(corner);
        CHECK(x < bar.x0);
        CHECK(y > 3.4 * text_size(size));  // under name and time
        CHECK(y < size[1] - text_size(size));
      }
    }
}

TEST_CASE("an edge too short for two numbers has none, and no name of an axis", "[render]") {
  View view = bar_view({640, 360});
  const auto below_the_floor = [&](const Double3& box) {
    view.domain_max = box;
    const Projection p = projection_of(view, 0);
    double floor = 0, left = 1e9, right = 0;
    for (const double x : {0.0, box[0]})
      for (const double y : {0.0, box[1]}) {
        const auto place = p.to_pixel({x, y, 0});
        floor = std::max(floor, place[1]);
        left = std::min(left, place[0]), right = std::max(right, place[0]);
      }
    Image image = white(640, 360);
    draw_overlay(image, view, p, "m/s", 1, 0);
    return ink(image, left - 60, floor + 6, right + 60, 360);  // under the 0 of the heights
  };
  CHECK(below_the_floor({1.6, 1.6, 1.6}) > 50);
  CHECK(below_the_floor({0.1, 0.1, 3}) == 0);
}
