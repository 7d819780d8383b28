#include "lib/run/run.h"

#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "lib/base/error.h"
#include "lib/base/output_file.h"
#include "lib/base/sha256.h"
#include "lib/base/text.h"
#include "lib/base/version.h"
#include "lib/io/particle_file.h"
#include "lib/io/run_path.h"
#include "lib/program/free_bodies.h"
#include "lib/program/threads.h"
#include "lib/run/load_run.h"
#include "lib/run/prestabilize.h"
#include "lib/run/run_record.h"
#include "lib/run/settle.h"
#include "lib/run/wave_files.h"

namespace pbf::run_module {
namespace {

RunInfo run_info(const RunParts& run, const std::string& started) {
  const LoadedScene& loaded = run.start.loaded;
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
  for (const Warning& w : run.start.warnings) info.warnings.push_back(w.text);
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
  info.energy_at_rest = run.at_rest;
  info.particles = run.plan.particles;
  info.capacity = changes_rows(scene) ? run.plan.most_particles() : 0;
  info.first_update = run.from.update();
  info.columns = run.plan.columns;
  info.bodies = names_of_bodies(scene);
  return info;
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

namespace {

/// Saves the last good state and a scene that continues from it, and ends the run with an error.
[[noreturn]] void report_alarm(const Monitor& monitor, const Scene& scene,
                               const RunFolder& folder) {
  const GuardEvent& e = *monitor.event();
  const Guard& guard = *monitor.guard();
  write_particle_file(folder.file("guard_state.h5"), to_particles(e.last_good, scene));
  folder.write_text("guard_scene.yaml", resolved_yaml(guard.repeating_scene(e, "guard_state.h5")));
  throw Error(ExitCode::guard, fmt::format("{}. {} holds the run up to there, guard_state.h5 the "
                                           "last good state (update {}); to repeat: pbf run {}",
                                           guard.text(e), folder.path(), e.last_good.updates,
                                           folder.file("guard_scene.yaml")));
}

std::string banner(const RunParts& run) {
  const SolverInfo i = run.solver.info();
  const BuildInfo build = build_info();
  const Scene& scene = run.scene;
  std::string where = i.backend + " " + i.precision;
  if (!about(scene.backend).on_device) where += ", " + threads_text(scene, run.plan.particles);
  return fmt::format(
      "pbf {} ({})  scene {}: {} particles, {} updates of {:.4g} s\n{} on {}; the solver holds {}; "
      "files in {}",
      build.version, build.commit, scene.name, run.plan.particles, run.schedule.updates,
      scene.time.step, where, i.device, bytes_text(double(i.bytes)), run.folder.path());
}

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

File open_json(const std::string& path, bool append) {
  File file(path.empty() ? nullptr : ::fdopen(open_output_stream(path, append), "a"), std::fclose);
  if (!path.empty() && !file)
    throw Error(ExitCode::io,
                "--log-json " + path + ": cannot be created: " + std::strerror(errno));
  return file;
}

std::function<void(const std::string&)> progress_in(Log& log) {
  return [&log](const std::string& line) { log.progress("pbf: " + line); };
}

/// Everything after the folder is made, so that log.txt also gets the error that ends the run.
RunResult simulate(RunParts& run) {
  const ResumePoint& from = run.from;
  Log& log = run.control.log;
  const std::string started = utc_now();
  const auto note = [&log](const std::string& text) { log.note("pbf: " + text); };
  const File json = open_json(run.control.log_json, from.started);
  run.json = json.get();
  if (from.started) prepare_resume(run.folder, from);
  run.folder.write_text(kResolvedScene, scene_record(run.scene, run.start.loaded.files));
  for (const WaveFile& f : wave_files(run.scene)) {
    run.folder.write_text(f.name, f.text);
    if (!from.saved) note("SHA-256 of " + f.name + ": " + sha256(f.text));
  }
  log.note(banner(run));
  for (const Warning& w : run.start.warnings) log.warning(w.text);
  for (const std::string& text : from.notes) note(text);
  if (!from.saved)
    for (const std::string& text : run.start.notes) note(text);
  for (const std::string& text : rounded_times(run.scene)) note(text);
  if (from.saved) {
    if (SplitRows* split = run.solver.split()) {
      const CheckpointRows rows(*from.saved);
      split->set_state_in_pieces(
          {from.saved->state, from.saved->particles,
           [&](std::int64_t first, std::int64_t n) { return rows.read(first, n); }});
    } else {
      run.solver.set_state(from.saved->state);
    }
    note(fmt::format("goes on from the checkpoint of update {}", from.update()));
  } else {
    run.clock.mark("init");
    const std::string done =
        prestabilized_text(prestabilize(run.solver, run.scene, run.plan, progress_in(log)));
    if (!done.empty()) note(done);
    run.clock.begin();  // the solver has recorded its own steps
  }
  open_files(run, started);
  run.clock.mark("init");
  run_session(run);
  const RunResult result{run.stop_reason, run.solver.updates()};
  if (run.status == "stopped")
    note(
        fmt::format("stopped early by {} after update {} of {}, after saving; the files in {} hold "
                    "the run up to there: the same command with --resume goes on",
                    result.stop_reason, result.updates, run.schedule.updates, run.folder.path()));
  log.close();
  if (run.status != "stopped") run.folder.write_text("DONE", "finished " + utc_now() + "\n");
  return result;
}

}  // namespace

void run_session(RunParts& run) {
  const Stopwatch loop;
  std::optional<LogRows> rows;
  Monitor monitor(
      run.scene, run.plan, run.solver, [&](Diagnostics& m, double dt) { rows->take(m, dt); },
      [&](const std::string& line) { run.control.log.note(line); }, &run.clock);
  if (run.schedule.gauge_every > 0 && run.writer)
    monitor.read_gauges([&](const GaugeRow& row) { run.writer->gauges(row); });
  Reporter reporter(run, monitor);
  rows.emplace(run, reporter);
  Frames frames(run, reporter);
  Callback handing([](std::int64_t) { return kEveryCall; },
                   [&](Session&) {
                     frames.hand_over();
                     return Next::go_on;
                   });
  Saving saving(run, frames, *rows, monitor, reporter);
  const auto& saved = run.from.saved;
  if (saved) rows->follow(monitor.go_on_from(*saved));
  // A signal waits for at most a quarter of a second, or for one update.
  Session session(run.solver,
                  {&handing, &monitor, &frames, &monitor.choosing(), &reporter, &saving}, 0.25);
  session.use(monitor.options());
  session.run(run.schedule.updates, saved ? run.from.update() : -1);
  run.loop_seconds = loop.seconds();
  run.control.log.result(run_summary(run, monitor, rows->stages()));
  if (!run.control.strict)  // a strict run has all of them in its error
    for (const Warning& w : reporter.untold()) run.control.log.warning(w.text);
  if (monitor.event()) report_alarm(monitor, run.scene, run.folder);
  if (run.control.strict && !reporter.warnings().empty())
    throw Error(ExitCode::difference,
                fmt::format("--strict: {}\npbf: the files in {} hold the run up to update {} of "
                            "{}; the same command with --resume and without --strict goes on",
                            warning_lines(reporter.warnings()), run.folder.path(),
                            run.solver.updates(), run.schedule.updates));
}

void refuse_pictures([[maybe_unused]] const Scene& scene) {
#ifndef PBF_HAS_RENDER
  if (scene.render)
    throw Error(ExitCode::unavailable,
                "render: this build draws no pictures; remove the key, or build with "
                "-DPBF_RENDER=ON");
#endif
}

RunResult run(Start start, const RunPlace& place, Control& control) {
  refuse_pictures(start.scene());
  Log& log = control.log;
  StageClock clock;
  std::unique_ptr<RunFolder> folder;
  ResumePoint from;
  if (place.existing == ExistingFolder::resume && RunFolder::check(place.folder, place.existing)) {
    folder = std::make_unique<RunFolder>(place.folder, place.existing);
    from = find_resume_point(*folder, start.scene(), start.particles.files, start.plan,
                             build_info().commit);
    if (from.finished) {
      for (const std::string& note : from.notes) log.note("pbf: " + note);
      return {};
    }
  }
  take_files(start.loaded, start.particles.files, from.notes);
  if (!from.saved &&
      !settle(start, progress_in(log), [&] { return !control.why_stop().empty(); })) {
    log.note("pbf: stopped early by " + control.why_stop() +
             " while the start settled; nothing is saved, the same command begins again");
    return {control.why_stop(), 0};
  }
  const auto solver = new_solver(start, start.scene(), start.plan);
  double solver_init = 0;  // the solver reports its own part of "init"
  for (const StageTime& s : solver->info().stages) solver_init += s.name == "init" ? s.seconds : 0;
#ifdef PBF_HAS_RENDER
  std::unique_ptr<RenderThread> pictures;  // made first, as not every machine can draw
  if (start.scene().render)
    pictures = std::make_unique<RenderThread>(view_of(start.scene(), start.plan.particles));
#endif
  clock.add("init", control.wall.seconds() - solver_init);
  clock.begin();
  // Make a new folder last, so that a scene that cannot run leaves nothing behind.
  if (!folder) folder = std::make_unique<RunFolder>(place.folder, place.existing);
  log.open(folder->file("log.txt"), from.started);
  try {
    RunParts parts{start, *solver, control, clock, *folder, from};
#ifdef PBF_HAS_RENDER
    parts.pictures = std::move(pictures);
#endif
    return simulate(parts);
  } catch (const std::exception& e) {
    try {
      log.file_only(std::string("pbf: error: ") + e.what());
    } catch (const Error&) {  // for example a full disk; the first error is reported
    }
    throw;
  }
}

}  // namespace pbf::run_module
