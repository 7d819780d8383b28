#include "lib/run/run.h"

#include <unistd.h>

#include "lib/base/error.h"
#include "lib/base/text.h"
#include "lib/base/version.h"
#include "lib/io/particle_output.h"

namespace pbf::inline run_module {
namespace {

RunInfo run_info(const RunParts& run, const std::string& started) {
  const LoadedScene& loaded = run.loaded;
  const Scene& scene = run.scene;
  const BuildInfo build = build_info();
  char host[256] = "";
  gethostname(host, sizeof host - 1);
  RunInfo info;
  info.scene_path = loaded.path;
  info.scene_text = loaded.text;
  info.resolved_scene = resolved_yaml(scene);
  info.scene_files = loaded.files;
  info.scene_bases = loaded.bases;
  info.scene_sha256 = scene_digest(info.resolved_scene, info.scene_files);
  info.overrides = loaded.overrides;
  for (const Warning& w : run.of_scene) info.warnings.push_back(w.text);
  info.program_version = build.version;
  info.commit = build.commit;
  info.compiler = build.compiler;
  info.build_flags = build.flags;
  info.host = host;
  info.started = started;
  info.plan = plan_text(run.plan, scene);
  info.solver = run.solver.info();
  info.domain_min = scene.domain.min;
  info.domain_max = scene.domain.max;
  info.spacing = scene.fluid.spacing;
  info.smoothing_length = scene.h();
  info.rest_density = scene.fluid.rest_density;
  info.particles = run.plan.particles;
  info.first_update = run.from.update();
  info.gauges = gauge_data(scene);
  return info;
}

/// Saves the last good state and a scene that goes on from it, and ends the run.
[[noreturn]] void report_alarm(const Watch& watch, const Scene& scene, const RunFolder& folder) {
  const GuardEvent& e = *watch.event();
  const Guard& guard = *watch.guard();
  write_particle_file(folder.file("guard_state.h5"), to_particles(e.last_good, scene));
  folder.write_text("guard_scene.yaml", resolved_yaml(guard.repeating_scene(e, "guard_state.h5")));
  throw Error(
      ExitCode::guard,
      guard.text(e) + format(". %s holds the run up to there, guard_state.h5 the last good state "
                             "(update %ld); to repeat: pbf run %s",
                             folder.path().c_str(), e.last_good.updates,
                             folder.file("guard_scene.yaml").c_str()));
}

}  // namespace

void open_files(RunParts& run, const std::string& started) {
  if (const auto& output = run.scene.output) {
    const std::string path = run.folder.file(kRunFile);
    const RunInfo info = run_info(run, started);
    const bool gzip = output->compression == Compression::gzip;
    run.writer = run.from.keep_file
                     ? std::make_unique<RunWriter>(path, info, gzip, run.from.frames, run.from.rows)
                     : std::make_unique<RunWriter>(path, info, gzip);
  }
#ifdef PBF_HAS_RENDER
  if (run.pictures) run.pictures->into(run.folder.file(RunFolder::kPictures));
#endif
}

void run_session(RunParts& run) {
  const Stopwatch loop;
  std::optional<Rows> rows;
  Watch watch(
      run.scene, run.plan, run.solver, [&](Diagnostics& m, double dt) { rows->take(m, dt); },
      [&](const std::string& line) { run.log.note(line); }, &run.clock);
  if (run.schedule.gauge_every > 0 && run.writer)
    watch.read_gauges([&](const GaugeRow& row) { run.writer->gauges(row); });
  Reporter reporter(run, watch);
  rows.emplace(run, reporter);
  Frames frames(run, reporter);
  Callback handing([](std::int64_t) { return kEveryCall; },
                   [&](Session&) {
                     frames.hand_over();
                     return Now::go_on;
                   });
  Saving saving(run, frames, *rows, watch, reporter);
  const auto& saved = run.from.saved;
  if (saved) rows->follow(watch.go_on_from(*saved));
  // A signal waits for a quarter of a second at most, or for one update.
  Session session(run.solver, {&handing, &watch, &frames, &watch.choosing(), &reporter, &saving},
                  0.25);
  session.use(watch.options());
  session.run(run.schedule.updates, saved ? run.from.update() : -1);
  run.loop_seconds = loop.seconds();
  run.log.result(run_summary(run, watch, rows->stages()));
  if (!run.strict)  // else all are in the error
    for (const Warning& w : reporter.untold()) run.log.warning(w.text);
  if (watch.event()) report_alarm(watch, run.scene, run.folder);
  if (run.strict && !reporter.warnings().empty())
    throw Error(ExitCode::difference,
                "--strict: " + warning_lines(reporter.warnings()) +
                    format("\npbf: the files in %s hold the run up to update %ld of %ld; the same "
                           "command with --resume and without --strict goes on",
                           run.folder.path().c_str(), run.solver.updates(), run.schedule.updates));
}

}  // namespace pbf::inline run_module
