// pbf run: a scene in, a run folder out.
#include <filesystem>

#include "app/commands.h"
#include "app/options.h"
#include "lib/base/error.h"
#include "lib/base/output_file.h"
#include "lib/io/run_path.h"
#include "lib/run/load_run.h"
#include "lib/run/signals.h"
#include "lib/run/start.h"

namespace pbf::app_module {
namespace fs = std::filesystem;
namespace {

struct RunOptions : SceneOptions {
  std::string scene;               ///< path
  std::string out;                 ///< run folder; empty: out/<scene name>
  std::string backend, precision;  ///< empty: as the scene says
  int threads = 0;                 ///< 0: as the scene says
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
  std::vector<std::string> list = o.overrides;  // options come last, so they override --set
  if (!o.backend.empty()) list.push_back("backend=" + o.backend);
  if (!o.precision.empty()) list.push_back("precision=" + o.precision);
  if (o.threads > 0) list.push_back("threads=" + std::to_string(o.threads));
  return list;
}

/// The run folder: `given` by --out; else, to resume a run from its own file or folder, that
/// folder; else out/<scene name>.
std::string run_place(const LoadedScene& loaded, const std::string& given, bool resume) {
  if (!given.empty()) return given;
  const std::string own = folder_of_run(loaded.run_file);
  return resume && !own.empty() ? own : "out/" + loaded.scene.name;
}

/// Refuses to repeat a run into its own folder.
void refuse_own_folder(const LoadedScene& loaded, const std::string& out) {
  const std::string own = folder_of_run(loaded.run_file);
  std::error_code error;
  if (own.empty() || !fs::equivalent(own, out, error)) return;
  bad_input(out,
            "holds the run that is to be repeated; give another folder with --out, or --resume to "
            "go on with it");
}

/// Note of --resume on a missing folder. `given`: named by --out.
std::string not_there_note(const LoadedScene& loaded, const std::string& out, bool given) {
  const std::string text = out + " is not there: the run begins at its start";
  if (given) return text;
  // Earlier versions kept runs of scenes without a name in out/scene.
  const std::string before = std::string("out/") + Scene{}.name;
  std::error_code error;
  if (loaded.named_by_file && fs::exists(before + "/" + kResolvedScene, error))
    return text + "; " + before +
           " holds a run of a scene without a name: to go on with that one, give --out " + before;
  return text + "; to go on with one that was begun with --out FOLDER, give the same --out";
}

/// Refuses --log-json if its folder is missing, or if the run in `out` writes that file itself.
void check_log_json(const std::string& path, const std::string& out) {
  if (path.empty()) return;
  if (RunFolder::owns(out, path))
    throw Error(ExitCode::bad_input,
                "--log-json " + path + ": the run itself writes this file; give another name");
  const fs::path parent = fs::path(path).parent_path();
  std::error_code error;
  if (parent.empty() || fs::is_directory(parent, error)) return check_output("--log-json", path);
  // It may be the run folder itself, which is made later.
  if (fs::absolute(parent).lexically_normal() == fs::absolute(out).lexically_normal()) return;
  throw Error(ExitCode::io, "--log-json " + path + ": the folder " + parent.string() +
                                " is not there; make it first");
}

int command_run(const RunOptions& options) {
  watch_signals();
  Log log(options.quiet);
  Control control{signal_token(), log, options.log_json, options.max_walltime, options.strict};
  LoadedScene loaded =
      load_scene_or_run(options.scene, all_overrides(options), options.base_folder);
  refuse_pictures(loaded.scene);
  const RunPlace place{run_place(loaded, options.out, options.resume),
                       options.overwrite ? ExistingFolder::overwrite
                       : options.resume  ? ExistingFolder::resume
                                         : ExistingFolder::refuse};
  if (place.existing == ExistingFolder::refuse) refuse_own_folder(loaded, place.folder);
  const bool there = RunFolder::check(place.folder, place.existing);
  const auto check_outputs = [&] {  // against what has been read
    check_log_json(options.log_json, place.folder);
    if (there && options.overwrite) RunFolder::refuse_overwrite(place.folder);
  };
  Start start = prepare(std::move(loaded),
                        {.warnings = true,
                         .strict = options.strict,
                         .measured = true,
                         .when_read = check_outputs,
                         .progress = [&](const std::string& line) { log.progress(line); }});
  if (options.resume && !there)
    log.note("pbf: " + not_there_note(start.loaded, place.folder, !options.out.empty()));
  const RunResult result = run(std::move(start), place, control);
  return static_cast<int>(result.stop_reason.empty() ? ExitCode::done : ExitCode::resumable);
}

}  // namespace

void add_run(CLI::App& app, int& code) {
  const auto [c, o] = add_command(app, code, command_run, "run",
                                  "Simulate a scene: run.vtkhdf and pictures in one folder",
                                  std::string(kRunHelp) + diagnostics_help());
  c->add_option("SCENE", o.scene,
                "Scene file (YAML), or a run to repeat: its run file or its folder")
      ->required();
  c->add_option(
       "--out", o.out,
       "Run folder; out/<scene name> when not given, with --resume of a run the one that it is in")
      ->check(not_empty());
  add_backend(c, o.backend, o.precision);
  c->add_option("--threads", o.threads, "CPU threads")->transform(whole_number(1, 4096));
  add_scene_options(c, o);
  CLI::Option* overwrite =
      c->add_flag("--overwrite", o.overwrite, "Replace the run in an existing folder");
  c->add_flag(
       "--resume", o.resume,
       "Go on from the last checkpoint; leave a run that has reached time.end as it is and exit "
       "0, or prolong it to a later time.end; start it when the folder is not there")
      ->excludes(overwrite);
  add_quiet(c, o.quiet);
  c->add_flag("--strict", o.strict,
              "A warning ends the run with exit 6: before it where the scene gives it, else after "
              "saving");
  c->add_option("--log-json", o.log_json, "One JSON object per line and measure, into this file");
  c->add_option("--max-walltime", o.max_walltime, "Stop after so many seconds, save, exit 75")
      ->transform(number_from(0, true, "seconds"));
}

}  // namespace pbf::app_module
