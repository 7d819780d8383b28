// pbf run: a scene in, a run folder out.
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>

#include "app/commands.h"
#include "lib/base/error.h"
#include "lib/base/output_file.h"
#include "lib/base/text.h"
#include "lib/base/version.h"
#include "lib/exec/make_solver.h"
#include "lib/io/particle_output.h"
#include "lib/program/threads.h"
#include "lib/run/emit.h"
#include "lib/run/load_run.h"
#include "lib/run/prestabilize.h"
#include "lib/run/resume.h"
#include "lib/run/run_folder.h"
#include "lib/run/run_loop.h"
#include "lib/run/signals.h"
#include "lib/run/start_neighbors.h"
#include "lib/run/warnings.h"
#include "lib/scene/load.h"

namespace pbf::inline app_module {
namespace {

std::vector<std::string> all_overrides(const RunOptions& o) {
  std::vector<std::string> list = o.overrides;  // the options win: they come last
  if (!o.backend.empty()) list.push_back("backend=" + o.backend);
  if (!o.precision.empty()) list.push_back("precision=" + o.precision);
  if (o.threads > 0) list.push_back("threads=" + std::to_string(o.threads));
  return list;
}

RunInfo run_info(const LoadedScene& loaded, const Plan& plan, const Solver& solver,
                 const std::string& started, std::int64_t first_update,
                 const std::vector<Warning>& warnings) {
  const BuildInfo build = build_info();
  char host[256] = "";
  gethostname(host, sizeof host - 1);
  RunInfo info;
  info.scene_path = loaded.path;
  info.scene_text = loaded.text;
  info.resolved_scene = resolved_yaml(loaded.scene);
  info.scene_files = loaded.files;
  info.scene_sha256 = scene_digest(info.resolved_scene, info.scene_files);
  info.overrides = loaded.overrides;
  for (const Warning& w : warnings) info.warnings.push_back(w.text);
  info.program_version = build.version;
  info.commit = build.commit;
  info.compiler = build.compiler;
  info.build_flags = build.flags;
  info.host = host;
  info.started = started;
  info.plan = plan_text(plan, loaded.scene);
  info.solver = solver.info();
  info.domain_min = loaded.scene.domain.min;
  info.domain_max = loaded.scene.domain.max;
  info.spacing = loaded.scene.fluid.spacing;
  info.smoothing_length = loaded.scene.h();
  info.rest_density = loaded.scene.fluid.rest_density;
  info.particles = plan.particles;
  info.first_update = first_update;
  return info;
}

RunSinks open_sinks(const LoadedScene& loaded, const Plan& plan, const Solver& solver,
                    const RunFolder& folder, std::FILE* json, const std::string& started,
                    const ResumePoint& from, const std::vector<Warning>& warnings) {
  const Scene& scene = loaded.scene;
  RunSinks sinks;
  sinks.json = json;
  sinks.checkpoints = folder.path();
  sinks.scene_files = loaded.files;
  if (scene.output) {
    const std::string path = folder.file(kRunFile);
    const RunInfo info = run_info(loaded, plan, solver, started, from.update(), warnings);
    const bool gzip = scene.output->compression == Compression::gzip;
    sinks.writer = from.keep_file
                       ? std::make_unique<RunWriter>(path, info, gzip, from.frames, from.rows)
                       : std::make_unique<RunWriter>(path, info, gzip);
  }
#ifdef PBF_HAS_RENDER
  if (scene.render) {
    folder.make_frames_folder();
    sinks.pictures =
        std::make_unique<RenderThread>(view_of(scene, plan.particles), folder.file("frames"));
  }
#endif
  return sinks;
}

std::string banner(const Scene& scene, const Plan& plan, const Solver& solver,
                   const std::string& folder) {
  const SolverInfo i = solver.info();
  const BuildInfo build = build_info();
  std::string where = i.backend + " " + i.precision;
  if (i.backend == "cpu") where += ", " + threads_text(scene, plan.particles);
  return format("pbf %s (%s)  scene %s: %lld particles, %lld updates of %.4g s\n%s on %s, %s -> %s",
                build.version.c_str(), build.commit.c_str(), scene.name.c_str(),
                static_cast<long long>(plan.particles),
                static_cast<long long>(make_schedule(scene).updates), scene.time.step,
                where.c_str(), i.device.c_str(), bytes_text(double(i.bytes)).c_str(),
                folder.c_str());
}

/// Saves the last good state and a scene that goes on from it, and ends the run.
[[noreturn]] void report_alarm(const GuardEvent& e, const Guard& guard, const Scene& scene,
                               const RunFolder& folder) {
  write_particle_file(folder.file("guard_state.h5"), to_particles(e.last_good, scene));
  folder.write_text("guard_scene.yaml", resolved_yaml(guard.repeating_scene(e, "guard_state.h5")));
  throw Error(
      ExitCode::guard,
      guard.text(e) + format(". %s holds the run up to there, guard_state.h5 the last good state "
                             "(update %lld); to repeat: pbf run %s",
                             folder.path().c_str(), static_cast<long long>(e.last_good.updates),
                             folder.file("guard_scene.yaml").c_str()));
}

/// A folder that is missing is told before the run folder is made. It may be the run folder itself.
void check_json(const std::string& path, const std::string& out) {
  namespace fs = std::filesystem;
  if (path.empty()) return;
  if (RunFolder::owns(out, path))
    throw Error(ExitCode::bad_input,
                "--log-json " + path + ": the run itself writes this file; give another name");
  const fs::path parent = fs::path(path).parent_path();
  std::error_code error;
  if (parent.empty() || fs::is_directory(parent, error)) return check_output("--log-json", path);
  if (fs::absolute(parent).lexically_normal() == fs::absolute(out).lexically_normal()) return;
  throw Error(ExitCode::io, "--log-json " + path + ": the folder " + parent.string() +
                                " is not there; make it first");
}

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

File open_json(const std::string& path, bool append) {
  File file(path.empty() ? nullptr : ::fdopen(open_output_stream(path, append), "a"), std::fclose);
  if (!path.empty() && !file)
    throw Error(ExitCode::io,
                "--log-json " + path + ": cannot be created: " + std::strerror(errno));
  return file;
}

/// The start's compression, taken out with a line in the log, and one every 10 s on the way.
void relieve(Solver& solver, const Scene& scene, const Plan& plan, Log& log) {
  Stopwatch since;
  const std::string done =
      prestabilized_text(prestabilize(solver, scene, plan, [&](const std::string& line) {
        if (since.seconds() < 10) return log.transient("pbf: " + line);
        log.note("pbf: " + line);
        since.reset();
      }));
  if (!done.empty()) log.note("pbf: " + done);
}

/// What was done to the particles of the scene before the start; empty: nothing.
std::string start_note(const Particles& p, const Scene& scene) {
  if (p.put_on_margin == 0) return {};
  return format(
      "%zu particles were nearer to a wall than solver.wall_margin (%.6g m), by up to "
      "%.3g m; they start at that distance",
      p.put_on_margin, scene.solver.wall_margin, p.farthest_put);
}

std::string lines(const std::vector<Warning>& warnings) {
  std::string text;
  for (const Warning& w : warnings) text += (text.empty() ? "" : "\npbf: error: ") + w.text;
  return text;
}

/// After the summary: what has not been told on the way, and what has become of the rest.
void tell_warnings(const RunLoop& loop, Log& log) {
  for (const Warning& w : loop.warnings())
    if (!loop.told(w)) log.warning(w.text);
}

/// Everything from the made folder on, so that its log.txt also gets the error that ends it.
int simulate(const LoadedScene& loaded, const Plan& plan, std::unique_ptr<Solver> solver,
             const std::string& start_note, const std::vector<Warning>& warnings,
             const RunFolder& folder, const ResumePoint& from, Log& log, StageClock& clock,
             const Stopwatch& wall, const RunOptions& options) {
  const std::string started = utc_now();
  const File json = open_json(options.log_json, from.started);
  if (from.started) prepare_resume(folder, from);
  folder.write_text("scene.resolved.yaml", scene_record(loaded.scene, loaded.files));
  log.note(banner(loaded.scene, plan, *solver, folder.path()));
  for (const Warning& w : warnings) log.warning(w.text);
  for (const std::string& note : from.notes) log.note("pbf: " + note);
  if (!from.saved && !start_note.empty()) log.note("pbf: " + start_note);
  if (from.saved) {
    solver->set_state(from.saved->state);
    log.note(format("pbf: goes on from the checkpoint of update %lld",
                    static_cast<long long>(from.update())));
  } else {
    clock.mark("init");
    relieve(*solver, loaded.scene, plan, log);
    clock.begin();  // the solver has booked its steps
  }
  RunSinks sinks = open_sinks(loaded, plan, *solver, folder, json.get(), started, from, warnings);
  clock.mark("init");
  RunLoop loop(loaded.scene, plan, *solver, std::move(sinks), log, clock, wall,
               {options.max_walltime, options.strict, warnings});
  if (from.saved) loop.go_on_from(*from.saved);
  loop.keep_frames(from.frames);
  const RunEnd end = loop.run();
  RunTotals totals = loop.totals();
  totals.folder = folder.path();
  log.result(run_summary(totals));
  if (!options.strict) tell_warnings(loop, log);  // else all are in the error
  if (loop.guard_event()) report_alarm(*loop.guard_event(), loop.guard(), loaded.scene, folder);
  if (options.strict && !loop.warnings().empty())
    throw Error(
        ExitCode::difference,
        "--strict: " + lines(loop.warnings()) +
            format("\npbf: the files in %s hold the run up to update %lld of %lld; the same "
                   "command with --resume and without --strict goes on",
                   folder.path().c_str(), static_cast<long long>(totals.updates),
                   static_cast<long long>(make_schedule(loaded.scene).updates)));
  if (end == RunEnd::stopped) {
    log.note(
        format("pbf: stopped early by %s after update %lld of %lld, after saving; the files "
               "in %s hold the run up to there: the same command with --resume goes on",
               loop.stop_reason().c_str(), static_cast<long long>(totals.updates),
               static_cast<long long>(make_schedule(loaded.scene).updates), folder.path().c_str()));
    log.close();
    return static_cast<int>(ExitCode::resumable);
  }
  log.close();
  folder.write_text("DONE", "finished " + utc_now() + "\n");
  return 0;
}

}  // namespace

int command_run(const RunOptions& options) {
  watch_signals();
  const Stopwatch wall;
  StageClock clock;
  LoadedScene loaded = load_scene_or_run(options.scene, all_overrides(options));
  const Scene& scene = loaded.scene;
#ifndef PBF_HAS_RENDER
  if (scene.render)
    throw Error(ExitCode::unavailable,
                "render: this build draws no pictures; remove the key, or build with "
                "-DPBF_RENDER=ON");
#endif
  const std::string out = options.out.empty() ? "out/" + scene.name : options.out;
  const ExistingFolder existing = options.overwrite ? ExistingFolder::overwrite
                                  : options.resume  ? ExistingFolder::resume
                                                    : ExistingFolder::refuse;
  Log log(options.quiet);
  const bool there = RunFolder::check(out, existing);
  const std::string& dir = loaded.folder;
  const std::int64_t particles = count_particles(scene, dir);
  check_json(options.log_json, out);  // now that all is read
  if (there && options.overwrite) RunFolder::refuse_overwrite(out);
  refuse_if_too_large(scene, make_plan(scene, particles));  // before a look at every particle
  const Plan plan = make_plan(scene, particles, start_neighbors(scene, dir, particles));
  refuse_if_too_large(scene, plan);
  const std::vector<Warning> warnings = scene_warnings(scene, dir, particles);
  if (options.strict && !warnings.empty())
    throw Error(ExitCode::difference, "--strict: " + lines(warnings));
  Particles start = emit_particles(scene, dir);
  std::unique_ptr<RunFolder> folder;
  ResumePoint from;
  if (there && existing == ExistingFolder::resume) {
    folder = std::make_unique<RunFolder>(out, existing);
    from = find_resume_point(*folder, scene, start.files, plan.particles, build_info().commit);
    if (from.finished) {
      for (const std::string& note : from.notes) log.note("pbf: " + note);
      log.note(out + ": the run is finished (DONE is there); nothing to do");
      return 0;
    }
  }
  // A new folder comes last: a scene that cannot run leaves nothing behind.
  take_files(loaded, start.files, from.notes);
  const std::string note = start_note(start, scene);
  auto solver = make_solver(scene, plan, std::move(start));
  double solver_init = 0;  // the solver reports its own part of "init"
  for (const StageTime& s : solver->info().stages) solver_init += s.name == "init" ? s.seconds : 0;
  clock.add("init", wall.seconds() - solver_init);
  clock.begin();
  if (!folder) folder = std::make_unique<RunFolder>(out, existing);
  log.open(folder->file("log.txt"), from.started);
  try {
    return simulate(loaded, plan, std::move(solver), note, warnings, *folder, from, log, clock,
                    wall, options);
  } catch (const std::exception& e) {
    try {
      log.file_only(std::string("pbf: error: ") + e.what());
    } catch (const Error&) {  // a full disk: the first error is the one to tell
    }
    throw;
  }
}

}  // namespace pbf::inline app_module
