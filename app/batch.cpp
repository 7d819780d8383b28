// pbf batch: many scenes, each in a folder of its own. Finished runs are skipped, stopped or
// killed ones continue.
#include <fmt/core.h>
#include <algorithm>
#include <filesystem>
#include <map>

#include "app/batch_options.h"
#include "app/commands.h"
#include "app/options.h"
#include "lib/base/error.h"
#include "lib/base/log.h"
#include "lib/base/output_file.h"
#include "lib/base/own_file.h"
#include "lib/base/stage_clock.h"
#include "lib/campaign/batch_jobs.h"
#include "lib/campaign/batch_list.h"
#include "lib/campaign/batch_summary.h"
#include "lib/exec/ranks/mpi_ranks.h"
#include "lib/io/run_path.h"
#include "lib/program/schedule.h"
#include "lib/run/emit.h"
#include "lib/run/load_run.h"
#include "lib/run/run_record.h"
#include "lib/run/signals.h"

namespace pbf::app_module {
namespace {

const char* const kBatchHelp =
    "Every run is what `pbf run --resume` does, in a folder of its own: what is finished (DONE\n"
    "is there, and run.vtkhdf is whole, of this scene, up to its end; --collect looks too) is\n"
    "left alone, what was stopped or killed goes on, so the same command can be given again\n"
    "until all is done. OUT/summary.csv and summary.json have a row per run: its settings, why\n"
    "it ended, its last measures.\n"
    "Every run is read and planned before the first one starts. SIGTERM, SIGINT and\n"
    "--max-walltime save all runs.\n"
    "Exit code 0 when all are finished, 75 when some are to go on, 6 when some failed.\n"
    "Examples:\n"
    "  pbf batch configs/dam_break.yaml --grid solver.iterations=2,4,8 \\\n"
    "      --grid time.step=0.001:0.002:3 --jobs 2\n"
    "  pbf batch scenes/ --out out/scenes --set checkpoint.every=60\n"
    "  pbf batch scenes/ --out out/scenes --slurm --time 4:00:00 > job.sh; bash job.sh\n"
    "  pbf batch large.yaml --slurm --ranks 16 --threads 8 > job.sh; bash job.sh";

namespace fs = std::filesystem;

std::string list_text(const std::vector<BatchMember>& members) {
  std::string text = fmt::format("{} runs", members.size());
  for (std::size_t k = 0; k < members.size(); ++k)
    text += fmt::format("\n  {:3}  {}  ({})", k, members[k].name, members[k].scene);
  return text;
}

class Batch {
 public:
  /// needs: of the members.
  Batch(const BatchOptions& o, std::vector<BatchMember> members, std::vector<JobNeeds> needs,
        const std::string& out, Log& log)
      : o_(o), members_(std::move(members)), needs_(std::move(needs)), out_(out), log_(log) {}

  void run() {
    const auto stop = [this] { return signal_token().why() || time_is_up(); };
    run_jobs(limits(o_), needs_,
             {[this](std::size_t k) { return arguments(k); }, stop,
              [this](std::size_t k, const JobEnd& end) {
                ended(members_[k], end);
                if (o_.only < 0) results_.read(members_[k]);  // else there is no summary
              },
              [this](const std::string& text) { log_.note("pbf: " + text); }});
  }

  /// Collects the results of runs without running them, from DONE, record and run.vtkhdf.
  void collect() {
    for (const BatchMember& m : members_)
      if (fs::exists(out_ + "/" + m.name + "/DONE")) ended(m, end_of(m));
  }

  /// Exit code of the only run.
  int code() const {
    return ends_.empty() ? static_cast<int>(ExitCode::resumable) : ends_.begin()->second.code;
  }

  int finish() {
    const BatchSummary summary = batch_summary(members_, ends_, results_);
    if (!summary.note.empty()) log_.warning(summary.note);
    write_text_file(out_ + "/summary.csv", summary.csv(), Naming::own);
    write_text_file(out_ + "/summary.json", summary.json(), Naming::own);
    std::size_t finished = 0, failed = 0;
    for (const auto& [name, end] : ends_) {
      finished += end.code == 0;
      failed += end.code != 0 && !resumable(end.code);
    }
    const std::size_t open = members_.size() - finished - failed;
    log_.result(fmt::format("{} runs: {} finished, {} failed, {} to go on with; {}/summary.csv",
                            members_.size(), finished, failed, open, out_));
    if (open > 0) log_.note("pbf: the same command goes on from there");
    return static_cast<int>(open > 0     ? ExitCode::resumable
                            : failed > 0 ? ExitCode::difference
                                         : ExitCode::done);
  }

 private:
  LoadedScene loaded(const BatchMember& m) const {
    std::vector<std::string> overrides = o_.overrides;
    overrides.insert(overrides.end(), m.overrides.begin(), m.overrides.end());
    return load_scene_or_run(m.scene, overrides, o_.base_folder);
  }
  /// The result that a run with DONE would have if it were started again.
  JobEnd end_of(const BatchMember& m) const {
    const std::string folder = out_ + "/" + m.name;
    try {
      const LoadedScene own = loaded(m);
      const LoadedScene record = load_stored_scene(folder + "/" + kResolvedScene);
      const StartPoints points(own.scene, own.folder);
      const std::string other =
          difference_of_runs(record.scene, recorded_files(record.text), own.scene, points.files());
      if (!other.empty())
        throw Error(ExitCode::bad_input, folder + " is of another scene: " + other + kOther);
      const std::string file = difference_of_file(folder, own.scene);
      if (!file.empty())
        throw Error(ExitCode::bad_input,
                    folder + "/run.vtkhdf is of another scene: " + file + kOther);
      const std::string doubt = why_not_finished(folder, own.scene);
      if (!doubt.empty()) throw Error(ExitCode::resumable, "DONE is there, but " + doubt);
      if (make_schedule(own.scene).updates > make_schedule(record.scene).updates)
        throw Error(ExitCode::resumable, "time.end has grown");
    } catch (const Error& e) {
      return {static_cast<int>(e.code()), e.what()};
    }
    return {0, ""};
  }

  static bool resumable(int code) {
    return code == static_cast<int>(ExitCode::resumable) || code > 128;
  }
  bool time_is_up() const { return o_.max_walltime > 0 && wall_.seconds() >= o_.max_walltime; }

  std::vector<std::string> arguments(std::size_t k) const {
    const BatchMember& m = members_[k];
    std::vector<std::string> args{"run",     m.scene,   "--out", out_ + "/" + m.name,
                                  "--quiet", "--resume"};
    for (const std::string& word : options_of_runs(o_)) args.push_back(word);
    for (const std::string& s : m.overrides) args.insert(args.end(), {"--set", s});
    const auto sharing = needs_[k].shares ? std::ranges::count_if(needs_, &JobNeeds::shares) : 0;
    if (const int n = threads_of_run(o_, sharing))
      args.insert(args.end(), {"--threads", std::to_string(n)});
    if (o_.max_walltime > 0)
      args.insert(args.end(),
                  {"--max-walltime",
                   fmt::format("{:.3f}", std::max(0.001, o_.max_walltime - wall_.seconds()))});
    return args;
  }

  void ended(const BatchMember& m, const JobEnd& end) {
    ends_[m.name] = end;
    std::string line =
        fmt::format("[{}/{}] {}: {}", ends_.size(), members_.size(), m.name, exit_reason(end.code));
    if (!end.message.empty()) line += ": " + end.message;
    log_.note(line);
  }

  static constexpr const char* kOther =
      ". Give the same scenes and options as before, or another folder with --out";

  const BatchOptions& o_;
  std::vector<BatchMember> members_;
  std::vector<JobNeeds> needs_;
  std::string out_;
  Log& log_;
  Stopwatch wall_;
  std::map<std::string, JobEnd> ends_;
  RunResults results_{out_, [this](const BatchMember& m) { return loaded(m).scene; }};
};

int command_batch(const BatchOptions& o) {
  std::vector<GridAxis> axes;
  for (const std::string& g : o.grid) axes.push_back(parse_axis(g));
  std::vector<BatchMember> members = batch_members(o.input, axes);
  const std::string out = o.out.empty() ? "out/batch_" + batch_stem(o.input) : o.out;
  Log log(o.quiet || launched_rank() > 0);
  if (o.list) {
    log.result(list_text(members));
    return 0;
  }
  if (o.slurm) {
    log.result(slurm_text(o, out, members));
    return 0;
  }
  if (o.only >= std::int64_t(members.size()))
    throw Error(ExitCode::bad_input, fmt::format("--only {}: the runs are counted from 0 to {}",
                                                 o.only, members.size() - 1));
  const bool one = o.only >= 0;  // a task of an array: no summary, others write beside it
  std::vector<JobNeeds> needs(one ? 1 : members.size());
  if (!one && !o.collect) {
    std::vector<std::string> overrides = o.overrides;
    if (const int n = threads_of_run(o)) overrides.push_back("threads=" + std::to_string(n));
    needs = check_members(members, overrides, o.base_folder, true);
    for (JobNeeds& n : needs)
      n.shares = !n.pictures && (o.share == "yes" || (o.share == "auto" && n.device));
  }
  make_folder(out);
  for (const char* name : {"/summary.csv", "/summary.json"}) {
    require_own_file(out + name);
    check_output("--out", out + name);
  }
  watch_signals();
  if (one) members = {members[static_cast<std::size_t>(o.only)]};
  Batch batch(o, members, std::move(needs), out, log);
  o.collect ? batch.collect() : batch.run();
  return one ? batch.code() : batch.finish();
}

}  // namespace

void add_batch(CLI::App& app, int& code) {
  const auto [c, o] = add_command(
      app, code, command_batch, "batch",
      "Many scenes, or one with a grid of settings: each run in a folder of its own", kBatchHelp);
  c->add_option(
       "INPUT", o.input,
       "Folder of scenes (*.yaml), a scene, or a list: a scene or a run on each line, then "
       "KEY.PATH=VALUE where wanted")
      ->required();
  c->add_option("--out", o.out, "Folder of the run folders; out/batch_<name> when not given")
      ->check(not_empty());
  add_repeatable(
      c, "--grid", o.grid,
      "KEY=V1,V2,... or KEY=FIRST:LAST:COUNT in equal steps, both ends included (--x and --y of "
      "pbf stability take equal ratios): a run for every value; repeatable, then for every "
      "combination");
  add_scene_options(c, o);
  c->add_option("--jobs", o.jobs,
                "Runs at a time; 1, of those that share a process up to 8 on each GPU: as many as "
                "fit into memory and have together about 300000 particles")
      ->transform(whole_number(1, 4096));
  CLI::Option* share =
      c->add_option(
           "--share", o.share,
           "Whether runs without pictures share a process, which makes the GPU ready once: "
           "auto: those on a GPU; yes; no")
          ->check(CLI::IsMember({"auto", "yes", "no"}));
  c->add_option("--threads", o.threads, "CPU threads of a run; all, shared among --jobs")
      ->transform(whole_number(1, 4096));
  c->add_option("--max-walltime", o.max_walltime, "Stop all after so many seconds, save, exit 75")
      ->transform(number_from(0, true, "seconds"));
  CLI::Option* only = c->add_option("--only", o.only, "Run this one alone, counted from 0")
                          ->transform(whole_number(0))
                          ->excludes(share);
  c->add_flag("--collect", o.collect, "Run nothing, write the summary of what is there")
      ->excludes(only);
  c->add_flag("--strict", o.strict, "A warning ends its run with exit 6");
  c->add_flag("--list", o.list, "Print the runs and do nothing");
  CLI::Option* slurm = c->add_flag("--slurm", o.slurm, "Print a Slurm array script and do nothing");
  c->add_option("--time", o.time,
                "Of a task of the Slurm script, e.g. 30, 4:00:00 or 1-12; 1:00:00")
      ->needs(slurm);
  c->add_option("--ranks", o.ranks,
                "Ranks of each run of the Slurm script, which srun starts with --mpi=pmix; "
                "--threads is for each of them")
      ->transform(whole_number(1, 65536))
      ->needs(slurm);
  add_quiet(c, o.quiet);
}

}  // namespace pbf::app_module
