// pbf study: many runs with some keys varied, error against run time.
#include <fmt/core.h>

#include "app/commands.h"
#include "app/options.h"
#include "lib/base/error.h"
#include "lib/base/log.h"
#include "lib/base/own_file.h"
#include "lib/base/stage_clock.h"
#include "lib/base/text.h"
#include "lib/campaign/study_table.h"
#include "lib/run/signals.h"
#include "lib/solver/diagnostics.h"

namespace pbf::app_module {
namespace {

struct StudyOptions : SceneOptions {
  std::string study;  ///< path of the study file
  std::string out;    ///< folder; empty: out/study_<name>
  int repeats = 0;    ///< 0: as the study says
  bool list = false, quiet = false;
};

const char* const kStudyHelp =
    "A study file:\n"
    "  scene: ../dam_break.yaml           # from this file's folder\n"
    "  set: {time.end: 0.5, render: off}  # keys of the scene, for every run\n"
    "  variants:                          # curves; each a set of keys\n"
    "    - {name: paper, set: {solver.kernels: paper}, energy_limit: 0.03}\n"
    "    - {name: consistent}\n"
    "  grid:                              # every combination of these entries;\n"
    "    - {solver.iterations: [1, 4]}    # keys of one entry vary together\n"
    "    - {time.step: [0.002, 0.001], measure_every: [10, 20]}\n"
    "  error: compression_mean            # set against the run time [default]\n"
    "  targets: [0.01, 0.001]             # of the error [default]\n"
    "  from: 0.1                          # s, measures count from here [0]\n"
    "  repeats: 3                         # of the timing [default]\n"
    "  clock: wall                        # or cpu, of all threads: on busy machines\n"
    "  energy_limit: 0.01                 # larger energy_rise: no verdict [default];\n"
    "                                     # a variant may have its own\n"
    "  reference: {solver.iterations: 64} # keys; reference_distance to this run\n"
    "  front: {axis: x, length: 0.1, factor: 2, data: [front.csv]}\n"
    "                                     # T = t sqrt(factor g/length), Z = x/length\n"
    "Results are kept per run in OUT/members: the same command goes on where a killed\n"
    "one ended, and runs only what is new. OUT/study.csv and study.json hold the table:\n"
    "compression and pool measures are means over time (compression_rms: root of the\n"
    "mean square, maxima: the largest) from `from` on, seconds_median those of all\n"
    "updates. * in the table on the terminal: no other run is both faster and better.\n"
    "\n";

const char* const kStudyMeasures =
    "  reference_distance     RMS distance of the centres of mass / (volume)^(1/3) [1]\n"
    "  front_rms_<data>       RMS of Z - Z published [1]; all fronts in OUT/front.csv\n\n"
    "Example:\n"
    "  pbf study configs/study/dam_break.yaml --out out/study --set threads=2";

/// The result of a run, called `name` in messages: stored in the folder, or simulated now. Empty
/// after a signal. Throws Error(unavailable) if it cannot run here.
std::optional<MemberResult> result_of(const Study& study, const StudyMember& member,
                                      const std::string& folder, const std::string& name,
                                      Log& log) {
  const std::string path = folder + "/members/" + member_key(study, member) + ".json";
  require_own_file(path);
  try {
    if (auto kept = read_member(path)) {
      log.note(name + ": kept from before");
      return kept;
    }
  } catch (const Error& e) {
    log.note(name + ": its result is damaged and made again: " + e.what());
  }
  const Stopwatch watch;
  const auto progress = [&](double share) {
    const double s = watch.seconds();
    log.progress(
        fmt::format("{}: {:.0f} %, {} left", name, 100 * share, duration_text(s / share - s)));
  };
  auto result = run_member(
      study, member, [] { return signal_token().why() != nullptr; }, progress);
  if (!result) return result;
  write_member(path, *result);
  const std::vector<double>& mean = result->series("compression_mean");
  log.note(fmt::format(
      "{}: {} in all; updates {:.4g} s (spread {:.2g} s), mean compression {:.3g} % at the end{}",
      name, duration_text(watch.seconds()), result->seconds_median(), result->seconds_spread(),
      100 * mean.back(), result->status == "finished" ? "" : ", " + result->status));
  return result;
}

void write_tables(const Study& study, const std::vector<StudyRow>& rows, const std::string& out) {
  const auto write = [&](const char* name, const std::string& text) {
    write_text_file(out + "/" + name, text, Naming::own);
  };
  write("study.csv", study_table(study, rows).csv());
  write("study.json", study_json(study, rows));
  if (study.front) write("front.csv", front_table(study, rows).csv());
}

std::string list_text(const Study& study) {
  std::string out = fmt::format("{}: {} runs", study.name, study.members.size());
  if (study.reference) out += " and the reference";
  for (const StudyMember& m : study.members) out += "\n  " + m.label;
  return out;
}

int command_study(const StudyOptions& o) {
  Study study = load_study(o.study, o.overrides, o.base_folder);
  if (o.repeats > 0) study.repeats = o.repeats;
  Log log(o.quiet);
  if (o.list) {
    log.result(list_text(study));
    return 0;
  }
  const std::string out = o.out.empty() ? "out/study_" + study.name : o.out;
  make_folder(out + "/members");
  for (const char* name : {"study.csv", "study.json", "front.csv"}) {
    require_own_file(out + "/" + name);
    check_output("--out", out + "/" + name);
  }
  watch_signals();
  const std::size_t n = study.members.size() + (study.reference ? 1 : 0);
  const auto stopped = [&](std::size_t done) {
    log.note(fmt::format(
        "pbf: stopped early by {} with {} of {} runs done; the same command goes on from there",
        signal_token().why(), done, n));
    return static_cast<int>(ExitCode::resumable);
  };
  const auto name_of = [n](const StudyMember& member, std::size_t k) {
    return fmt::format("[{}/{}] {}", k, n, member.label);
  };
  std::size_t k = 0;
  std::optional<MemberResult> reference;
  if (study.reference) {
    reference = result_of(study, *study.reference, out, name_of(*study.reference, ++k), log);
    if (!reference) return stopped(k - 1);
  }
  std::vector<StudyRow> rows;
  std::size_t unavailable = 0;
  for (const StudyMember& member : study.members) {
    const std::string name = name_of(member, ++k);
    std::optional<MemberResult> result;
    try {
      result = result_of(study, member, out, name, log);
      if (!result) return stopped(k - 1);
    } catch (const Error& e) {
      if (e.code() != ExitCode::unavailable) throw;
      ++unavailable;
      result.emplace();
      result->status = "unavailable";
      result->message = e.what();
      result->backend = word(member.scene.backend);
      result->precision = word(member.scene.precision);
      log.note(name + ": " + e.what());
    }
    rows.push_back(study_row(study, member, *result, reference ? &*reference : nullptr));
    mark_front(study, rows);
    write_tables(study, rows, out);  // after every run, for early inspection
  }
  log.result(study_text(study, rows));
  log.note("tables in " + out + ": study.csv, study.json" + (study.front ? ", front.csv" : ""));
  if (unavailable > 0)
    throw Error(
        ExitCode::unavailable,
        fmt::format("{} of {} runs could not run here: their rows say why", unavailable, n));
  return 0;
}

}  // namespace

void add_study(CLI::App& app, int& code) {
  const auto [c, o] = add_command(app, code, command_study, "study",
                                  "Error against run time over a grid of settings",
                                  std::string(kStudyHelp) + diagnostics_help() + kStudyMeasures);
  c->add_option("STUDY", o.study, "Study file (YAML)")->required();
  c->add_option("--out", o.out, "Folder of the tables; out/study_<name> when not given")
      ->check(not_empty());
  add_scene_options(
      c, o,
      "Replace one key of the scene in every run, KEY.PATH=VALUE; the study's variants "
      "and grid come after it");
  c->add_option("--repeats", o.repeats, "Repeats of the timing; as the study says when not given")
      ->transform(whole_number(1, 1000));
  c->add_flag("--list", o.list, "Print the runs and do nothing");
  add_quiet(c, o.quiet);
}

}  // namespace pbf::app_module
