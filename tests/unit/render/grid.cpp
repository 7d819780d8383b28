// Lengths in pictures: steps, lines on the floor, and labels where they belong.
#include "lib/render/grid.h"

#include "lib/scene/vector3.h"
#include "tests/support/render_support.h"

using namespace pbf;
using namespace pbf_test;

namespace {

View tank_view(const Double3& min, const Double3& max) {
  View view;
  view.domain_min = min, view.domain_max = max;
  return view;
}

/// The place of a label's number on the edge: where it says, with nothing else.
double number_of(const std::string& text) {
  std::size_t end = 0;
  const double number = std::stod(text, &end);
  CHECK(end == text.size());
  return number;
}

}  // namespace

TEST_CASE("the step of a grid is 1, 2 or 5 times a power of ten, and 4 to 10 fit", "[render]") {
  for (double longest = 1.3e-7; longest < 1e9; longest *= 1.37) {
    const double step = grid_step(longest);
    INFO("longest " << longest << " step " << step);
    const double power = std::floor(std::log10(step) + 1e-9), lead = step / std::pow(10, power);
    CHECK(std::min({std::abs(lead - 1), std::abs(lead - 2), std::abs(lead - 5)}) < 1e-9);
    CHECK(longest / step >= 4 - 1e-9);
    CHECK(longest / step <= 10 + 1e-9);
  }
  CHECK(grid_step(10) == 1);
  CHECK(grid_step(1) == 0.1);
  CHECK(grid_step(1.6) == 0.2);
}

TEST_CASE("multiples take in both ends, also where these are not whole in binary", "[render]") {
  CHECK(multiples(0, 0.3, 0.1).size() == 4);
  CHECK(multiples(0.1, 0.35, 0.1).size() == 3);
  CHECK(multiples(-0.2, 0.2, 0.1)[2] == 0);
  CHECK_FALSE(std::signbit(multiples(-0.2, 0.2, 0.1)[2]));
  CHECK(multiples(0.11, 0.19, 0.1).empty());
  CHECK(multiples(0, 1, 1e-9).size() == 1000);  // at most
}

TEST_CASE("a label stands at the place that it names, on a near edge of the floor", "[render]") {
  for (const Double3& min : {Double3{0, 0, 0}, Double3{-3.07, 2.5, 1}})
    for (const Double3& size : {Double3{1.6, 0.4, 1}, Double3{1, 1, 5}, Double3{3, 10, 2}}) {
      View view = tank_view(min, min + size);
      const Projection p = projection_of(view, 0);
      const auto edges = length_labels(view, p);
      REQUIRE(edges.size() == 3);
      for (std::size_t k = 0; k < 2; ++k)  // along x, along y
        for (const auto& labels : edges[k].of) {
          REQUIRE(labels.size() >= 2);
          for (const LengthLabel& l : labels) {
            INFO("axis " << k << " label " << l.text);
            double nearest = 1e9;  // to a place on either edge along the axis
            for (const bool high : {false, true}) {
              Double3 x = min;
              x[k] = number_of(l.text);
              if (high) x[1 - k] += size[1 - k];
              const auto at = p.to_pixel(x);
              nearest = std::min(nearest, std::hypot(at[0] - l.place[0], at[1] - l.place[1]));
            }
            CHECK(nearest < 0.5);
            CHECK(std::hypot(l.away[0], l.away[1]) == Approx(1));
            // Away from the middle of the floor.
            Double3 middle = 0.5 * (view.domain_min + view.domain_max);
            middle[2] = min[2];
            const auto centre = p.to_pixel(middle);
            CHECK((l.place[0] - centre[0]) * l.away[0] + (l.place[1] - centre[1]) * l.away[1] > 0);
          }
          CHECK(edges[k].axis == (k == 0 ? "x" : "y"));
          CHECK(edges[k].unit == "m");
        }
    }
}

TEST_CASE("heights stand at their places on the left of the box, with the floor's unit",
          "[render]") {
  View view = tank_view({-1, 2, 0.1}, {2, 3, 1.7});
  const Projection p = projection_of(view, 0);
  double left = 1e9;
  for (unsigned corner = 0; corner < 8; ++corner)
    left = std::min(left, p.to_pixel(corner_of(view, corner))[0]);
  const auto edges = length_labels(view, p);
  const EdgeLabels& heights = edges.back();
  CHECK(heights.ticks);
  CHECK_FALSE(edges.front().ticks);
  REQUIRE(heights.of.front().size() == 3);  // 0.5, 1, 1.5
  CHECK(heights.of.front().back().text == "1.5");
  CHECK(heights.axis + heights.unit == "zm");
  for (const LengthLabel& l : heights.of.front()) {
    CHECK(l.away == std::array<double, 2>{-1, 0});
    double nearest = 1e9;
    for (unsigned corner = 0; corner < 4; ++corner) {
      Double3 x = corner_of(view, corner);
      x[2] = number_of(l.text);
      const auto at = p.to_pixel(x);
      nearest = std::min(nearest, std::hypot(at[0] - l.place[0], at[1] - l.place[1]));
      CHECK(at[0] > l.place[0] - 1e-6);  // nothing of the box is further left
    }
    CHECK(nearest < 1e-6);
  }
}

TEST_CASE("heights go as far as the default camera shows, and up the box for another", "[render]") {
  View view = tank_view({0, 0, 0}, {2, 1, 8});
  view.frame = std::array{Double3{0, 0, 0}, Double3{2, 1, 1}};
  const auto last = [&] {
    return length_labels(view, projection_of(view, 0)).back().of[0].back().text;
  };
  CHECK(last() == "1.0");
  view.camera.position = Double3{1, -20, 4};
  CHECK(last() == "8.0");
}

TEST_CASE("heights are few, up a tower too", "[render]") {
  const View view = tank_view({0, 0, 0}, {1, 1, 30});
  const auto heights = length_labels(view, projection_of(view, 0)).back();
  REQUIRE(!heights.of.empty());
  for (const auto& labels : heights.of) {
    CHECK(labels.size() >= 2);
    CHECK(labels.size() <= 7);
  }
}

TEST_CASE("heights are on the right where the left is open, and nowhere where both are",
          "[render]") {
  View view = tank_view({0, 0, 0}, {2, 1, 1});
  view.camera.position = Double3{1, -5, 2};
  const auto away = [&]() -> double {
    const auto edges = length_labels(view, projection_of(view, 0));
    return edges.back().ticks ? edges.back().of[0][0].away[0] : 0;
  };
  CHECK(away() == -1);
  view.open[0][0] = true;
  CHECK(away() == 1);
  view.open[0][1] = true;
  CHECK(away() == 0);
}

TEST_CASE("small and large scenes are labelled in units for people", "[render]") {
  const auto last = [](double size) {
    const View view = tank_view({0, 0, 0}, {size, size, size});
    const EdgeLabels edge = length_labels(view, projection_of(view, 0))[0];
    return edge.of[0].back().text + " " + edge.unit;
  };
  CHECK(last(1e-3) == "1.0 mm");
  CHECK(last(2e-6) == "2.0 µm");
  CHECK(last(10) == "10 m");
  CHECK(last(0.5) == "0.50 m");
  CHECK(last(5e4) == "50 km");
}

TEST_CASE("in two dimensions the lower and the left edge have a scale", "[render]") {
  View view = tank_view({0, 0, 0}, {6, 0.02, 0.8});
  view.flat = true;
  const Projection p = projection_of(view, 0);
  const auto edges = length_labels(view, p);
  REQUIRE(edges.size() == 2);
  CHECK(edges[0].of[0].size() == 7);
  CHECK(edges[0].of[0][3].away[1] == Approx(1).margin(0.02));  // down
  CHECK(edges[1].of[0].back().text == "0.8");  // a step of its own: none of 1 m fits
  CHECK(edges[1].of[0][0].away[0] == Approx(-1).margin(0.02));  // to the left
}

TEST_CASE("no lengths where no floor is seen: from below, and where it is open", "[render]") {
  View view = tank_view({0, 0, 0}, {2, 1, 1});
  std::vector<FlatVertex> lines;
  const auto count = [&] {
    const Projection p = projection_of(view, 0);
    lines.clear();
    add_floor_grid(view, p, 1, 1e-3, lines);
    return std::pair{lines.size() / 6, length_labels(view, p).size()};
  };
  CHECK(count() == std::pair<std::size_t, std::size_t>{9 + 4, 3});
  view.open[2][0] = true;
  CHECK(count() == std::pair<std::size_t, std::size_t>{0, 0});
  view.open[2] = {false, true};
  view.open[0] = {true, true};  // fluid runs out over these edges: labels along x alone
  CHECK(count() == std::pair<std::size_t, std::size_t>{13, 1});
  view.open = {};
  view.camera.position = Double3{1, -3, -2};
  CHECK(count() == std::pair<std::size_t, std::size_t>{0, 0});
  view.up = {0, 0, -1};  // then the eye is above the floor, which is at z = 1
  CHECK(count().second == 3);
  view.camera.position = Double3{1, -3, 1.5};
  CHECK(count().second == 0);
}

TEST_CASE("the lines lie on the floor, within a thousandth of the way to the eye", "[render]") {
  View view = tank_view({3, -2, 5}, {5, -1, 6});
  const Projection p = projection_of(view, 0);
  std::vector<FlatVertex> lines;
  add_floor_grid(view, p, 1, 1e-3, lines);
  REQUIRE(!lines.empty());
  for (const FlatVertex& v : lines) {
    const auto [right, up, depth] = v.place;
    const Double3 x = p.eye + static_cast<double>(right) * p.right +
                      static_cast<double>(up) * p.up + static_cast<double>(depth) * p.forward;
    const double away = length(x - p.eye);
    CHECK(x[2] >= 5 - 2 * p.pixel() * away);  // half the width of a line
    CHECK(x[2] <= 5 + 2e-3 * away);
  }
}

TEST_CASE("a camera amid the lengths draws those before it", "[render]") {
  View view = tank_view({0, 0, 0}, {10, 10, 10});
  view.camera.position = Double3{5, 5, 1};
  view.camera.target = Double3{5, 9, 0.5};
  const Projection p = projection_of(view, 0);
  for (const auto& edge : length_labels(view, p))
    for (const auto& labels : edge.of)
      for (const LengthLabel& l : labels) {
        CHECK(std::isfinite(l.place[0] + l.place[1]));
        CHECK(std::isfinite(l.away[0] + l.away[1]));
      }
}
