#include "app/render_options.h"

#include <algorithm>
#include <cmath>

#include "lib/base/error.h"
#include "lib/scene/number.h"

namespace pbf::app_module {
namespace {

[[noreturn]] void bad(const std::string& option, const std::string& text, const std::string& want) {
  throw Error(ExitCode::bad_input, option + " " + text + ": give " + want);
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts{""};
  for (const char c : text)
    if (c == separator)
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

/// Exactly `n` finite numbers separated by `separator`; false for anything else.
bool read_numbers(const std::string& text, char separator, std::size_t n, double* out) {
  const auto parts = split(text, separator);
  if (parts.size() != n) return false;
  for (std::size_t i = 0; i < n; ++i) {
    const NumberError e = read_number(parts[i], out[i]);
    if (e == NumberError::too_small) out[i] = 0;
    if (e != NumberError::none && e != NumberError::too_small) return false;
  }
  return true;
}

void read_camera(const std::string& text, Camera& camera) {
  const char* want =
      "position=x,y,z;target=x,y,z;fov=degrees;orbit=degrees_per_second, any of them";
  for (const std::string& part : split(text, ';')) {
    if (part.empty()) continue;
    const auto equals = part.find('=');
    if (equals == std::string::npos) bad("--camera", text, want);
    const std::string key = part.substr(0, equals), value = part.substr(equals + 1);
    Double3 triple{};
    double number = 0;
    if (key == "position" && read_numbers(value, ',', 3, triple.data()))
      camera.position = triple;
    else if (key == "target" && read_numbers(value, ',', 3, triple.data()))
      camera.target = triple;
    else if (key == "fov" && read_numbers(value, ',', 1, &number) && number >= 1 && number <= 170)
      camera.fov = number;
    else if (key == "orbit" && read_numbers(value, ',', 1, &number))
      camera.orbit = number;
    else
      bad("--camera", part, std::string(want) + " (fov from 1 to 170)");
  }
}

}  // namespace

std::vector<std::int64_t> select_frames(const std::string& text, std::int64_t frames) {
  const char* want = "all, k, a:b or a:b:step (b excluded, negative counts from the end)";
  if (frames == 0) throw Error(ExitCode::bad_input, "the run file holds no frame yet");
  std::vector<std::int64_t> out;
  const auto parts = split(text, ':');
  std::int64_t range[2] = {0, frames}, step = 1;
  if (text != "all") {
    if (parts.size() > 3) bad("--frames", text, want);
    for (std::size_t i = 0; i < std::min<std::size_t>(2, parts.size()); ++i) {
      if (parts[i].empty() && parts.size() > 1) continue;  // an omitted bound
      if (read_number(parts[i], range[i]) != NumberError::none) bad("--frames", text, want);
      if (range[i] < 0) range[i] += frames;
    }
    if (parts.size() == 1) {
      if (range[0] < 0 || range[0] >= frames)
        bad("--frames", text, "a frame from 0 to " + std::to_string(frames - 1));
      return {range[0]};
    }
    if (parts.size() == 3 && (read_number(parts[2], step) != NumberError::none || step < 1))
      bad("--frames", text, want);
  }
  range[0] = std::max<std::int64_t>(0, range[0]);
  range[1] = std::min(frames, range[1]);
  for (std::int64_t k = range[0]; k < range[1]; k += std::min(step, frames)) out.push_back(k);
  if (out.empty())
    bad("--frames", text,
        "a range that selects something; the run file holds frames 0 to " +
            std::to_string(frames - 1));
  return out;
}

bool by_quantile(const RenderOptions& options) { return options.range == "quantile"; }

void apply_render_options(const RenderOptions& o, Scene& scene) {
  if (!scene.render) scene.render.emplace();
  Render& render = *scene.render;
  if (!o.size.empty()) {
    double size[2];
    if (!read_numbers(o.size, 'x', 2, size) || size[0] != std::floor(size[0]) ||
        size[1] != std::floor(size[1]) || std::min(size[0], size[1]) < 16 ||
        std::max(size[0], size[1]) > 16384)
      bad("--size", o.size, "WIDTHxHEIGHT in pixels, each from 16 to 16384, e.g. 1280x720");
    render.size = {static_cast<int>(size[0]), static_cast<int>(size[1])};
  }
  if (!o.style.empty()) render.style = *named<RenderStyle>(o.style);
  if (!o.color.empty()) {
    const ColorBy color = *named<ColorBy>(o.color);
    if (color != render.color) render.range.reset();
    render.color = color;
  }
  if (by_quantile(o)) {
    render.range.reset();
  } else if (!o.range.empty()) {
    double range[2];
    if (!read_numbers(o.range, ',', 2, range) || range[0] >= range[1])
      bad("--range", o.range,
          "LOW,HIGH with LOW below HIGH, in the unit of the field, or quantile");
    render.range = {{range[0], range[1]}};
  }
  if (!o.camera.empty()) read_camera(o.camera, render.camera);
}

}  // namespace pbf::app_module
