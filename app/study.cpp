// pbf study: many runs with some keys varied, error against run time.
#include <filesystem>
#include <system_error>

#include "app/commands.h"
#include "lib/base/error.h"
#include "lib/base/log.h"
#include "lib/base/own_file.h"
#include "lib/base/stage_clock.h"
#include "lib/base/text.h"
#include "lib/campaign/study_table.h"
#include "lib/run/signals.h"

namespace pbf::inline app_module {
namespace {

namespace fs = std::filesystem;

void make_folder(const std::string& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error)
    throw Error(ExitCode::io, path + ": the folder cannot be made: " + error.message() +
                                  "; choose another one with --out");
}

/// Runs members one after the other and keeps their results in a folder.
class StudyRunner {
 public:
  StudyRunner(const Study& study, const std::string& folder, Log& log)
      : study_(study), folder_(folder), log_(log) {}

  /// The result of the k-th of n runs: kept from before, or simulated now. Empty when a signal
  /// came. Throws Error(unavailable) where it cannot run here.
  std::optional<MemberResult> result(const StudyMember& member, std::size_t k, std::size_t n) {
    const std::string head = format("[%zu/%zu] %s", k, n, member.label.c_str());
    const std::string path = folder_ + "/members/" + member_key(study_, member) + ".json";
    require_own_file(path);
    try {
      if (auto kept = read_member(path)) {
        log_.note(head + ": kept from before");
        return kept;
      }
    } catch (const Error& e) {
      log_.note(head + ": its result is damaged and made again: " + e.what());
    }
    const Stopwatch watch;
    double told = 0;
    const auto progress = [&](double share) {
      if (watch.seconds() - told < (log_.terminal() ? 0.5 : 10)) return;
      told = watch.seconds();
      const std::string line = head + format(": %.0f %%, %s left", 100 * share,
                                             duration_text(told / share - told).c_str());
      log_.terminal() ? log_.transient(line) : log_.note(line);
    };
    auto result = run_member(
        study_, member, [] { return !signal_seen().empty(); }, progress);
    if (!result) return result;
    write_member(path, *result);
    const std::vector<double>& mean = result->series("compression_mean");
    log_.note(head +
              format(": %s in all; updates %.4g s (spread %.2g s), mean compression %.3g %% at the "
                     "end%s",
                     duration_text(watch.seconds()).c_str(), result->seconds_median(),
                     result->seconds_spread(), 100 * mean.back(),
                     result->status == "finished" ? "" : (", " + result->status).c_str()));
    return result;
  }

 private:
  const Study& study_;
  std::string folder_;
  Log& log_;
};

void write_tables(const Study& study, const std::vector<StudyRow>& rows, const std::string& out) {
  const auto write = [&](const char* name, const std::string& text) {
    write_text_file(out + "/" + name, text, Naming::own);
  };
  write("study.csv", study_table(study, rows).csv());
  write("study.json", study_json(study, rows));
  if (study.front) write("front.csv", front_table(study, rows).csv());
}

std::string list_text(const Study& study) {
  std::string out = format("%s: %zu runs", study.name.c_str(), study.members.size());
  if (study.reference) out += " and the reference";
  for (const StudyMember& m : study.members) out += "\n  " + m.label;
  return out;
}

}  // namespace

int command_study(const StudyOptions& o) {
  Study study = load_study(o.study, o.overrides);
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
  StudyRunner runner(study, out, log);
  const std::size_t n = study.members.size() + (study.reference ? 1 : 0);
  const auto stopped = [&](std::size_t done) {
    log.note(
        format("pbf: stopped early by %s with %zu of %zu runs done; the same command goes on "
               "from there",
               signal_seen().c_str(), done, n));
    return static_cast<int>(ExitCode::resumable);
  };
  std::size_t k = 0;
  std::optional<MemberResult> reference;
  if (study.reference) {
    reference = runner.result(*study.reference, ++k, n);
    if (!reference) return stopped(k - 1);
  }
  std::vector<StudyRow> rows;
  std::size_t unavailable = 0;
  for (const StudyMember& member : study.members) {
    std::optional<MemberResult> result;
    try {
      result = runner.result(member, ++k, n);
      if (!result) return stopped(k - 1);
    } catch (const Error& e) {
      if (e.code() != ExitCode::unavailable) throw;
      ++unavailable;
      result.emplace();
      result->status = "unavailable";
      result->message = e.what();
      result->backend = member.scene.backend == Backend::cuda ? "cuda" : "cpu";
      result->precision = member.scene.precision == Precision::dbl ? "double" : "float";
      log.note(format("[%zu/%zu] %s: ", k, n, member.label.c_str()) + e.what());
    }
    rows.push_back(study_row(study, member, *result, reference ? &*reference : nullptr));
    mark_front(study, rows);
    write_tables(study, rows, out);  // after every run: what is done can be looked at
  }
  log.result(study_text(study, rows));
  log.note("tables in " + out + ": study.csv, study.json" + (study.front ? ", front.csv" : ""));
  if (unavailable > 0)
    throw Error(ExitCode::unavailable,
                format("%zu of %zu runs could not run here: their rows say why", unavailable, n));
  return 0;
}

}  // namespace pbf::inline app_module
