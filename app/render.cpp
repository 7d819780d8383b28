// pbf render: pictures from the frames of a run file.
#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "app/commands.h"
#include "app/options.h"
#include "lib/base/error.h"
#include "lib/base/log.h"
#include "lib/base/output_file.h"
#include "lib/base/stage_clock.h"
#include "lib/io/run_file.h"
#include "lib/io/run_path.h"
#include "lib/run/load_run.h"
#include "lib/scene/load.h"
#ifdef PBF_HAS_RENDER
#include "lib/render/quantile_range.h"
#include "lib/render/renderer.h"
#endif

namespace pbf::app_module {
namespace {

struct RenderOptions {
  std::string run;                  ///< path of run.vtkhdf
  std::string frames = "all";       ///< k, a:b, a:b:step (b excluded, negative from the end) or all
  std::string size;                 ///< WxH, empty: as the scene says
  std::string camera;               ///< position=x,y,z;target=x,y,z;fov=deg;orbit=deg/s
  std::string style, color, range;  ///< empty: as the scene says
  std::string out;                  ///< folder, empty: render/ beside the run file
};

const char* const kRenderHelp =
    "Example:\n"
    "  pbf render out/dam_break --frames 0:-1:5 --size 1920x1080 --color density \\\n"
    "      --camera 'position=3,-4,2;fov=30'";

#ifndef PBF_HAS_RENDER
int command_render(const RenderOptions&) {
  throw Error(ExitCode::unavailable, "this build draws no pictures; build with -DPBF_RENDER=ON");
}
#else
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

/// "all", "k", "a:b" or "a:b:step", as in Python: b excluded, negative from the end, empty for the
/// ends. Throws if no frame of `frames` is selected.
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

/// Whether the range is computed from the frames.
bool by_quantile(const RenderOptions& options) { return options.range == "quantile"; }

/// Applies --size, --camera, --style, --color and --range to the scene's render settings. A new
/// color without a range gets the default range of its field.
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

/// The quantity of a range, and how the range follows from the quantiles of the frames (`of`).
std::string meaning(const View& view, std::array<double, 2> quantiles, const std::string& of) {
  const std::string are = "the 1 % and 99 % quantiles " + of;
  switch (view.color) {
    case ColorBy::speed:
      return "speed in m/s, " + are;
    case ColorBy::density:
      return fmt::format(
          "density in kg/m^3, as far below as above the rest density {:.6g}; {} are {:.6g} and "
          "{:.6g}",
          view.rest_density, are, quantiles[0], quantiles[1]);
    case ColorBy::compression:
      return "compression as a share (0.01 is 1 %), " + are;
    case ColorBy::id:
      break;
  }
  return "ids of particles, " + are;
}

/// Sets the range from the 1 % and 99 % quantiles of the frames.
void take_quantiles(View& view, const RunReader& reader, const std::vector<std::int64_t>& frames,
                    Log& log) {
  std::int64_t particles = 0;
  for (const std::int64_t k : frames) particles += reader.counts()[std::size_t(k)];
  QuantileRange values(view, particles);
  for (const std::int64_t k : frames) values.add(reader.frame(k));
  const std::array<double, 2> quantiles = values.between(0.01, 0.99);
  const std::string taken =
      values.stride() == 1 ? "" : fmt::format(", of every {}th particle", values.stride());
  const BarRange bar = bar_range(view, quantiles);
  if (bar.ends[0] < bar.ends[1]) {
    view.range = bar.ends;
    log.note("range " + bar.text + ": " +
             meaning(view, quantiles,
                     fmt::format("of {} frame{}{}", frames.size(), frames.size() == 1 ? "" : "s",
                                 taken)));
  } else {
    log.note(fmt::format(
        "range {:.9g},{:.9g}, the scene's own: all values of the frames chosen are {:.9g}{}",
        view.range[0], view.range[1], quantiles[0], taken));
  }
}

int command_render(const RenderOptions& options) {
  const std::string run = only_run_path(options.run);
  try_run_file(run);
  const RunReader reader(run);
  const RunInfo info = reader.info();
  Scene scene = parse_stored_scene(info.resolved_scene, run + " (the scene stored in it)", {});
  read_files_of_run(scene, run, info.scene_path);
  apply_render_options(options, scene);
  const auto frames = select_frames(options.frames, reader.frames());
  const std::filesystem::path folder = options.out.empty()
                                           ? std::filesystem::path(run).parent_path() / "render"
                                           : std::filesystem::path(options.out);
  make_folder(folder.string());
  Log log(false);
  View view = view_of(scene, info.particles);
  if (by_quantile(options)) take_quantiles(view, reader, frames, log);
  Renderer renderer(view);
  log.note(fmt::format("{} picture{} of {}x{} with {}", frames.size(),
                       frames.size() == 1 ? "" : "s", view.size[0], view.size[1],
                       renderer.backend()));
  for (const std::int64_t k : frames) {
    const std::string file = (folder / fmt::format("frame_{:06}.png", k)).string();
    check_output("--out", file);
    Stopwatch watch;
    const Snapshot snapshot = reader.frame(k);
    write_png(file, renderer.draw(snapshot));
    log.result(fmt::format("{}  t = {:.6g} s  ({:.2f} s)", file, snapshot.time, watch.seconds()));
  }
  return 0;
}
#endif

}  // namespace

void add_render(CLI::App& app, int& code) {
  const auto [c, o] = add_command(app, code, command_render, "render",
                                  "Pictures from the frames of a run file", kRenderHelp);
  c->add_option("RUN", o.run, "A run: its run file (run.vtkhdf) or its folder")->required();
  c->add_option("--frames", o.frames, "all, k, a:b or a:b:step; b excluded, negative from the end");
  c->add_option("--size", o.size, "WIDTHxHEIGHT in pixels");
  c->add_option("--camera", o.camera, "position=x,y,z;target=x,y,z;fov=degrees;orbit=degrees/s");
  c->add_option("--style", o.style, "How the fluid is drawn")
      ->check(CLI::IsMember(words_of<RenderStyle>()));
  c->add_option("--color", o.color, "What colours the particles")
      ->check(CLI::IsMember(words_of<ColorBy>()));
  c->add_option(
      "--range", o.range,
      "LOW,HIGH of the colour bar, in the unit of the field; or quantile: from 1 % to 99 % of "
      "the particles of all --frames lie in it");
  c->add_option("--out", o.out, "Folder of the pictures; render/ beside the run file")
      ->check(not_empty());
}

}  // namespace pbf::app_module
