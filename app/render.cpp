// pbf render: pictures from the frames of a run file.
#include <fmt/core.h>
#include <filesystem>

#include "app/commands.h"
#include "app/options.h"
#include "app/render_options.h"
#include "lib/base/error.h"
#include "lib/base/log.h"
#include "lib/base/output_file.h"
#include "lib/base/stage_clock.h"
#include "lib/io/run_file.h"
#include "lib/io/run_path.h"
#include "lib/run/load_run.h"
#include "lib/run/motion_files.h"
#include "lib/scene/load.h"
#ifdef PBF_HAS_RENDER
#include "lib/render/quantile_range.h"
#include "lib/render/renderer.h"
#endif

namespace pbf::app_module {

namespace {

const char* const kRenderHelp =
    "Example:\n"
    "  pbf render out/dam_break --frames 0:-1:5 --size 1920x1080 --color density \\\n"
    "      --camera 'position=3,-4,2;fov=30'";

#ifndef PBF_HAS_RENDER
int command_render(const RenderOptions&) {
  throw Error(ExitCode::unavailable, "this build draws no pictures; build with -DPBF_RENDER=ON");
}
#else
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
  // Pictures need only the tables of motions.
  if (!motion_paths(scene).empty())
    read_motions(scene, folder_of_files(scene, run, info.scene_path));
  apply_render_options(options, scene);
  const auto frames = select_frames(options.frames, reader.frames());
  const std::filesystem::path folder = options.out.empty()
                                           ? std::filesystem::path(run).parent_path() / "render"
                                           : std::filesystem::path(options.out);
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw Error(ExitCode::io, folder.string() + ": cannot be made: " + error.message() +
                                  "; choose another folder with --out");
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
