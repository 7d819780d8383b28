// pbf run: a scene in, a run folder out.
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>

#include "app/commands.h"
#include "app/options.h"
#include "app/run_place.h"
#include "lib/base/error.h"
#include "lib/base/output_file.h"
#include "lib/base/text.h"
#include "lib/base/version.h"
#include "lib/exec/make_solver.h"
#include "lib/io/run_path.h"
#include "lib/program/threads.h"
#include "lib/run/emit.h"
#include "lib/run/load_run.h"
#include "lib/run/prestabilize.h"
#include "lib/run/resume.h"
#include "lib/run/run.h"
#include "lib/run/run_folder.h"
#include "lib/run/run_record.h"
#include "lib/run/signals.h"
#include "lib/run/start_neighbors.h"
#include "lib/run/warnings.h"
#include "lib/scene/load.h"

namespace pbf::inline app_module {
namespace {

struct RunOptions {
  std::string scene;                   ///< path
  std::string out;                     ///< run folder; empty: out/<scene name>
  std::string backend, precision;      ///< empty: as the scene says
  int threads = 0;                     ///< 0: as the scene says
  std::vector<std::string> overrides;  ///< key.path=value
  std::string base_folder;
  bool overwrite = false, resume = false, quiet = false;
  bool strict = false;      ///< warnings are errors
  std::string log_json;     ///< path, empty: none
  double max_walltime = 0;  ///< s, 0: none
};

const char* const kRunHelp =
    "Examples:\n"
    "  pbf run configs/dam_break.yaml\n"
    "  pbf run configs/dam_break.yaml --out out/fine --set fluid.spacing=0.01 --threads 8\n"
    "  pbf run configs/dam_break.yaml --set checkpoint.every=60 --resume\n"
    "  pbf run out/fine --out out/again\n"
    "  pbf run out/fine --resume\n"
    "A run is given by its folder or its run file; it is repeated, or with --resume and without\n"
    "--out gone on with where it is.\n"
    "SIGTERM and SIGINT finish the update, save a checkpoint and exit 75, as --max-walltime\n"
    "does; a second one ends at once. SIGUSR1 saves a checkpoint and goes on. With\n"
    "time.adaptive and the guard, checkpoints are of the last measure or frame, and no run\n"
    "ends before its first.\n"
    "Exit codes are listed in pbf --help.\n\n";

std::vector<std::string> all_overrides(const RunOptions& o) {
  std::vector<std::string> list = o.overrides;  // the options win: they come last
  if (!o.backend.empty()) list.push_back("backend=" + o.backend);
  if (!o.precision.empty()) list.push_back("precision=" + o.precision);
  if (o.threads > 0) list.push_back("threads=" + std::to_string(o.threads));
  return list;
}

std::string banner(const Scene& scene, const Plan& plan, const Solver& solver,
                   const std::string& folder) {
  const SolverInfo i = solver.info();
  const BuildInfo build = build_info();
  std::string where = i.backend + " " + i.precision;
  if (!about(scene.backend).on_device) where += ", " + threads_text(scene, plan.particles);
  return format(
      "pbf %s (%s)  scene %s: %ld particles, %ld updates of %.4g s\n%s on %s; the solver "
      "holds %s; files in %s",
      build.version.c_str(), build.commit.c_str(), scene.name.c_str(), plan.particles,
      make_schedule(scene).updates, scene.time.step, where.c_str(), i.device.c_str(),
      bytes_text(double(i.bytes)).c_str(), folder.c_str());
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
  std::string note;
  if (p.put_on_margin > 0)
    note = format(
        "%zu particles were nearer to a wall than solver.wall_margin (%.6g m), by up to "
        "%.3g m; they start at that distance",
        p.put_on_margin, scene.solver.wall_margin, p.farthest_put);
  for (std::size_t b = 0; b < p.in_obstacles.size(); ++b)
    if (p.in_obstacles[b] > 0)
      note += format(
          "%s%zu particles of bodies[%zu] are in obstacles, or nearer to one than 0.4 "
          "spacings, and are left out",
          note.empty() ? "" : "; ", p.in_obstacles[b], b);
  return note;
}

/// Everything from the made folder on, so that its log.txt also gets the error that ends it.
int simulate(RunParts& parts, const std::string& start_note, const std::string& log_json) {
  const ResumePoint& from = parts.from;
  const RunFolder& folder = parts.folder;
  Log& log = parts.log;
  const std::string started = utc_now();
  const File json = open_json(log_json, from.started);
  parts.json = json.get();
  if (from.started) prepare_resume(folder, from);
  folder.write_text(kResolvedScene, scene_record(parts.scene, parts.loaded.files));
  log.note(banner(parts.scene, parts.plan, parts.solver, folder.path()));
  for (const Warning& w : parts.of_scene) log.warning(w.text);
  for (const std::string& note : from.notes) log.note("pbf: " + note);
  if (!from.saved && !start_note.empty()) log.note("pbf: " + start_note);
  for (const std::string& note : rounded_times(parts.scene)) log.note("pbf: " + note);
  if (from.saved) {
    parts.solver.set_state(from.saved->state);
    log.note(format("pbf: goes on from the checkpoint of update %ld", from.update()));
  } else {
    parts.clock.mark("init");
    relieve(parts.solver, parts.scene, parts.plan, log);
    parts.clock.begin();  // the solver has booked its steps
  }
  open_files(parts, started);
  parts.clock.mark("init");
  run_session(parts);
  if (parts.status == "stopped") {
    log.note(
        format("pbf: stopped early by %s after update %ld of %ld, after saving; the files "
               "in %s hold the run up to there: the same command with --resume goes on",
               parts.stop_reason.c_str(), parts.solver.updates(), parts.schedule.updates,
               folder.path().c_str()));
    log.close();
    return static_cast<int>(ExitCode::resumable);
  }
  log.close();
  folder.write_text("DONE", "finished " + utc_now() + "\n");
  return 0;
}

int command_run(const RunOptions& options) {
  watch_signals();
  const Stopwatch wall;
  StageClock clock;
  LoadedScene loaded =
      load_scene_or_run(options.scene, all_overrides(options), options.base_folder);
  const Scene& scene = loaded.scene;
#ifndef PBF_HAS_RENDER
  if (scene.render)
    throw Error(ExitCode::unavailable,
                "render: this build draws no pictures; remove the key, or build with "
                "-DPBF_RENDER=ON");
#endif
  const std::string out = run_place(loaded, options.out, options.resume);
  const ExistingFolder existing = options.overwrite ? ExistingFolder::overwrite
                                  : options.resume  ? ExistingFolder::resume
                                                    : ExistingFolder::refuse;
  Log log(options.quiet);
  if (existing == ExistingFolder::refuse) refuse_own_folder(loaded, out);
  const bool there = RunFolder::check(out, existing);
  const std::string& dir = loaded.folder;
  const std::int64_t particles = count_particles(scene, dir);
  check_log_json(options.log_json, out);  // now that all is read
  if (there && options.overwrite) RunFolder::refuse_overwrite(out);
  refuse_if_too_large(scene, make_plan(scene, particles));  // before a look at every particle
  const Plan plan = make_plan(scene, particles, start_neighbors(scene, dir, particles));
  refuse_if_too_large(scene, plan);
  const std::vector<Warning> warnings = scene_warnings(scene, dir, particles);
  if (options.strict && !warnings.empty())
    throw Error(ExitCode::difference, "--strict: " + warning_lines(warnings));
  Particles start = emit_particles(scene, dir);
  std::unique_ptr<RunFolder> folder;
  ResumePoint from;
  if (there && existing == ExistingFolder::resume) {
    folder = std::make_unique<RunFolder>(out, existing);
    from = find_resume_point(*folder, scene, start.files, plan.particles, build_info().commit);
    if (from.finished) {
      for (const std::string& note : from.notes) log.note("pbf: " + note);
      return 0;
    }
  }
  if (options.resume && !there)
    log.note("pbf: " + not_there_note(loaded, out, !options.out.empty()));
  // A new folder comes last: a scene that cannot run leaves nothing behind.
  take_files(loaded, start.files, from.notes);
  const std::string note = start_note(start, scene);
  auto solver = make_solver(scene, plan, std::move(start));
  double solver_init = 0;  // the solver reports its own part of "init"
  for (const StageTime& s : solver->info().stages) solver_init += s.name == "init" ? s.seconds : 0;
#ifdef PBF_HAS_RENDER
  std::unique_ptr<RenderThread> pictures;  // here, for not every machine has what draws them
  if (scene.render) pictures = std::make_unique<RenderThread>(view_of(scene, plan.particles));
#endif
  clock.add("init", wall.seconds() - solver_init);
  clock.begin();
  if (!folder) folder = std::make_unique<RunFolder>(out, existing);
  log.open(folder->file("log.txt"), from.started);
  try {
    RunParts parts{loaded,        plan,    *solver, log,      clock,
                   wall,          *folder, from,    warnings, options.max_walltime,
                   options.strict};
#ifdef PBF_HAS_RENDER
    parts.pictures = std::move(pictures);
#endif
    return simulate(parts, note, options.log_json);
  } catch (const std::exception& e) {
    try {
      log.file_only(std::string("pbf: error: ") + e.what());
    } catch (const Error&) {  // a full disk: the first error is the one to tell
    }
    throw;
  }
}

}  // namespace

void add_run(CLI::App& app, int& code) {
  const auto [c, o] = add_command(app, code, command_run, "run",
                                  "Simulate a scene: run.vtkhdf and pictures in one folder",
                                  std::string(kRunHelp) + diagnostics_text());
  c->add_option("SCENE", o.scene,
                "Scene file (YAML), or a run to repeat: its run file or its folder")
      ->required();
  c->add_option(
       "--out", o.out,
       "Run folder; out/<scene name> when not given, with --resume of a run the one that it is in")
      ->check(not_empty());
  c->add_option("--backend", o.backend, "Where to run")->check(CLI::IsMember(words_of<Backend>()));
  c->add_option("--precision", o.precision, "Of the computation")
      ->check(CLI::IsMember(words_of<Precision>()));
  c->add_option("--threads", o.threads, "CPU threads")->transform(whole_number(1, 4096));
  add_overrides(c, o.overrides);
  add_base_folder(c, o.base_folder);
  CLI::Option* overwrite =
      c->add_flag("--overwrite", o.overwrite, "Replace the run in an existing folder");
  c->add_flag(
       "--resume", o.resume,
       "Go on from the last checkpoint; leave a run that has reached time.end as it is and exit "
       "0, or prolong it to a later time.end; start it when the folder is not there")
      ->excludes(overwrite);
  c->add_flag("--quiet", o.quiet, "No progress on stderr");
  c->add_flag("--strict", o.strict,
              "A warning ends the run with exit 6: before it where the scene gives it, else after "
              "saving");
  c->add_option("--log-json", o.log_json, "One JSON object per line and measure, into this file");
  c->add_option("--max-walltime", o.max_walltime, "Stop after so many seconds, save, exit 75")
      ->transform(number_from(0, true, "seconds"));
}

}  // namespace pbf::inline app_module
