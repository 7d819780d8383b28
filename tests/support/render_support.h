// Helpers of the picture tests.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <numbers>
#include <string>
#include <vector>

#include "lib/base/error.h"
#include "lib/render/camera.h"
#include "lib/render/colormap.h"
#include "lib/render/gl_context.h"
#include "lib/render/renderer.h"
#include "tests/support/catch.h"
#include "tests/support/obstacle_shapes.h"

// Ends a test case on a machine where no OpenGL can be opened.
#define PBF_NEEDS_GL() \
  if (const std::string why = pbf_test::no_gl(); !why.empty()) PBF_SKIP("no OpenGL: " << why)

namespace pbf_test {

/// Why no OpenGL can be opened here; "" when it can. Any other error is a failure, not a skip.
inline std::string no_gl() {
  static const std::string reason = [] {
    try {
      const pbf::GlContext context;
      return std::string();
    } catch (const pbf::Error& error) {
      if (error.code() != pbf::ExitCode::unavailable) throw;
      return std::string(error.what());
    }
  }();
  return reason;
}

template <class T>
pbf::FieldArray field(const std::string& name, const std::string& unit, int components,
                      const std::vector<T>& values) {
  pbf::FieldArray f{
      name, unit, sizeof(T) == 8 ? pbf::ScalarType::f64 : pbf::ScalarType::f32, components, {}};
  f.bytes.resize(values.size() * sizeof(T));
  if (!values.empty()) std::memcpy(f.bytes.data(), values.data(), f.bytes.size());
  return f;
}

/// A snapshot coloured by density: particle i at positions[i] with value values[i].
template <class T = double>
pbf::Snapshot snapshot(const std::vector<pbf::Double3>& positions,
                       const std::vector<double>& values) {
  std::vector<T> flat, density;
  for (const auto& p : positions)
    for (double x : p) flat.push_back(static_cast<T>(x));
  for (double v : values) density.push_back(static_cast<T>(1 + v));
  pbf::Snapshot s;
  s.count = positions.size();
  s.fields = {field("position", "m", 3, flat), field("density", "kg/m^3", 1, density),
              pbf::FieldArray{"id", "1", pbf::ScalarType::i32, 1, {}}};
  s.fields[2].bytes.resize(4 * s.count);
  for (std::size_t i = 0; i < s.count; ++i) s.fields[2].as<std::int32_t>()[i] = int(i);
  return s;
}

/// 200 x 200 pixels, coloured by compression in 0..1, seen along +y from 4 m before the origin, z
/// up, in the middle of a box of 100 m whose edges and floor stay colourless.
inline pbf::View front_view() {
  pbf::View view;
  view.domain_min = {-50, -50, -50};
  view.domain_max = {50, 50, 50};
  view.radius = 0.5;
  view.color = pbf::ColorBy::compression;
  view.rest_density = 1;
  view.size = {200, 200};
  view.camera.position = pbf::Double3{0, -4, 0};
  view.camera.target = pbf::Double3{0, 0, 0};
  return view;
}

/// Pixels per unit tangent in a picture of `height` pixels with the default field of view.
inline double focal(int height) { return 0.5 * height / std::tan(17.5 * std::numbers::pi / 180); }

inline pbf::Rgb pixel(const pbf::Image& image, int x, int y) {
  const auto* p = &image.rgb[3 * static_cast<std::size_t>(y * image.width + x)];
  return {p[0], p[1], p[2]};
}

/// Where `place` (m) is seen, whatever stands before it.
inline pbf::Rgb pixel_at(const pbf::Image& image, const pbf::View& view, const pbf::Double3& place,
                         double time = 0) {
  const auto [x, y] = pbf::projection_of(view, time).to_pixel(place);
  REQUIRE((x > 0 && x < image.width && y > 0 && y < image.height));
  return pixel(image, static_cast<int>(x), static_cast<int>(y));
}

/// First row below the name, the time and the number of particles in a picture up to 500 pixels
/// high.
inline constexpr int kBelowTexts = 36;

/// The bytes of the rows below these texts, which differ where the number of particles does.
inline std::vector<std::uint8_t> below_texts(const pbf::Image& image) {
  return {image.rgb.begin() + 3 * kBelowTexts * image.width, image.rgb.end()};
}

/// An obstacle: a box along the axes, `half` (m) to each side of its centre.
inline pbf::Solid<double> plate(const pbf::Double3& center, const pbf::Double3& half) {
  pbf::Solid<double> solid;
  solid.center = {center[0], center[1], center[2]};
  solid.shape = pbf::shape::Box<double>{{half[0], half[1], half[2]}};
  return solid;
}

inline int chroma(const pbf::Rgb& c) {
  const auto [low, high] = std::minmax({c[0], c[1], c[2]});
  return high - low;
}

/// Hue in degrees, 0..360.
inline double hue(const pbf::Rgb& c) {
  const double angle = std::atan2(std::sqrt(3.0) * (c[1] - c[2]), 2.0 * c[0] - c[1] - c[2]);
  return std::fmod(angle * 180 / std::numbers::pi + 360, 360);
}

inline double hue_distance(double a, double b) { return std::abs(std::remainder(a - b, 360)); }

/// Share of the pixels of which a channel differs by more than `step`.
inline double share_off(const pbf::Image& a, const pbf::Image& b, int step = 8) {
  if (a.width != b.width || a.height != b.height) return 1;
  std::size_t off = 0;
  for (std::size_t i = 0; i + 2 < a.rgb.size(); i += 3)
    for (std::size_t k = 0; k < 3; ++k)
      if (std::abs(a.rgb[i + k] - b.rgb[i + k]) > step) {
        ++off;
        break;
      }
  return static_cast<double>(off) / (static_cast<double>(a.width) * a.height);
}

/// Sets an environment variable until the end of the scope.
class Environment {
 public:
  Environment(const char* name, const char* value) : name_(name) {
    if (const char* old = std::getenv(name)) old_ = old, had_ = true;
    setenv(name, value, 1);
  }
  ~Environment() { had_ ? setenv(name_, old_.c_str(), 1) : unsetenv(name_); }

 private:
  const char* name_;
  std::string old_;
  bool had_ = false;
};

/// Code and text of the Error that `f` throws; code -1 when it throws none.
template <class F>
std::pair<int, std::string> error_of(F f) {
  try {
    f();
  } catch (const pbf::Error& error) {
    return {static_cast<int>(error.code()), error.what()};
  }
  return {-1, "no error"};
}

}  // namespace pbf_test
