#include "lib/run/resume.h"

#include <fmt/core.h>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "lib/base/error.h"
#include "lib/base/text.h"
#include "lib/exec/ranks/world.h"
#include "lib/io/run_file.h"
#include "lib/io/run_layout.h"
#include "lib/io/run_path.h"
#include "lib/program/schedule.h"
#include "lib/run/run_record.h"
#include "lib/scene/load.h"

namespace pbf::run_module {
namespace {

/// Runs of such scenes give the same bits with one version of the program on every machine.
bool exact(const Scene& s) { return about(s.backend).exact || s.solver.reproducible; }

/// The number of leading values that agree with the schedule.
template <class Values, class Expected>
std::int64_t prefix(const Values& values, std::int64_t last, const Expected& expected) {
  std::int64_t k = 0;
  for (const auto v : values) {
    if (std::int64_t(v) > last || std::int64_t(v) != expected(k)) break;
    ++k;
  }
  return k;
}

class Finder {
 public:
  Finder(const RunFolder& folder, const Scene& scene, const std::vector<SceneFile>& files,
         const std::string& commit)
      : folder_(folder),
        scene_(scene),
        files_(files),
        commit_(commit),
        schedule_(make_schedule(scene)) {}

  ResumePoint find(const Plan& plan) {
    if (!folder_.has(kResolvedScene)) {
      if (folder_.holds_other_files())
        bad("holds no run to resume, but other files; give another folder with --out");
      return {};  // killed before it began
    }
    const LoadedScene record = load_stored_scene(folder_.file(kResolvedScene));
    const Scene& before = record.scene;
    const std::string files = recorded_files(record.text);
    if (const std::string other = difference_of_runs(before, files, scene_, files_); !other.empty())
      refuse("", other);
    if (files.empty() && !files_.empty())
      point_.notes.push_back(folder_.path() +
                             ": begun by an earlier version, which kept no SHA-256 "
                             "of its particle files: they are taken as they are");
    if (folder_.has(kEarlierRunFile) && !folder_.has(kRunFile))
      bad(std::string("cannot resume: holds ") + kEarlierRunFile +
          ", as an earlier version of pbf called its run file, whose results are others" +
          kOtherwise);
    const std::int64_t done = make_schedule(before).updates;
    if (folder_.has("DONE") && schedule_.updates <= done) {
      const std::string other =
          scene_.output ? difference_of_file(folder_.path(), scene_) : std::string();
      if (!other.empty()) refuse(kRunFile, other);
      const std::string doubt = why_not_finished(folder_.path(), scene_);
      if (doubt.empty()) {
        finish(schedule_.updates < done
                   ? fmt::format("the run is finished, up to {:.6g} s, beyond time.end, which is "
                                 "now {:.6g} s; nothing to do",
                                 double(done) * before.time.step, scene_.time.end)
                   : "the run is finished (DONE is there); nothing to do");
        return point_;
      }
      point_.notes.push_back("DONE is there, but " + doubt);
    }
    point_.started = true;
    point_.saved = read_checkpoint(folder_.path(), point_.notes, !world());
    check_checkpoint(plan);
    if (point_.saved && point_.saved->state.updates > schedule_.updates) {
      leave_as_it_is();
      return point_;
    }
    if (scene_.output) look_at_file(before);
    if (schedule_.updates < done)
      point_.notes.push_back(fmt::format(
          "time.end is {:.6g} s now, {:.6g} s before: the run ends earlier{}", scene_.time.end,
          before.time.end,
          beyond_ > 0 ? fmt::format("; {} frames of run.vtkhdf beyond it are removed", beyond_)
                      : ""));
    if (!point_.saved) point_.notes.push_back(from_the_start(before, done));
    return point_;
  }

 private:
  [[noreturn]] void bad(const std::string& what) const { bad_input(folder_.path(), what); }
  /// Refuses a file of the folder that belongs to another scene or to other files.
  void refuse_other(const std::string& name, const std::string& scene,
                    const std::string& files) const {
    const std::string difference = difference_of_runs(
        parse_stored_scene(scene, folder_.file(name) + ": its scene", {}), files, scene_, files_);
    if (!difference.empty()) refuse(name, difference);
  }
  [[noreturn]] void refuse(const std::string& name, const std::string& difference) const {
    bad_input(name.empty() ? folder_.path() : folder_.file(name),
              (name.empty() ? "cannot resume: " : "cannot resume: it is of another scene: ") +
                  difference + kSame);
  }
  /// Note on the work that is lost without a checkpoint.
  std::string from_the_start(const Scene& before, std::int64_t done) const {
    const bool prolonged = folder_.has("DONE") && schedule_.updates > done;
    std::string text = "there is no checkpoint: the run starts again from its first update";
    if (prolonged)
      text = fmt::format(
          "the run is finished up to {:.6g} s, but has kept no checkpoint: to reach time.end "
          "{:.6g} s it starts again from its first update",
          double(done) * before.time.step, scene_.time.end);
    if (point_.frames > 0)
      text += fmt::format("; the {} frames that are there stay", point_.frames);
    if (prolonged && !scene_.checkpoint)
      text += ". With checkpoint: {every: 60} in the scene a finished run can be prolonged";
    return text;
  }
  void finish(const std::string& why) {
    point_.notes.push_back(folder_.path() + ": " + why);
    point_.finished = true;
  }
  /// The run was stopped after the present time.end, so all requested results are there.
  void leave_as_it_is() {
    const auto reached = point_.saved->state.updates;
    const std::string at = fmt::format("{:.6g} s (update {})", double(reached) * scene_.time.step,
                                       reached),
                      end = fmt::format("time.end, which is now {:.6g} s", scene_.time.end);
    std::string doubt;
    if (scene_.output) {
      if (!folder_.has(kRunFile)) bad("cannot resume: " + at + lost_file("is missing", end));
      try {
        try_run_file(folder_.file(kRunFile));
        const RunInfo info = RunReader(folder_.file(kRunFile)).info();
        refuse_other(kRunFile, info.resolved_scene, info.scene_files);
      } catch (const Error& e) {
        if (e.code() == ExitCode::bad_input) throw;
        bad("cannot resume: " + at + lost_file("cannot be read", end));
      }
    }
    finish("the run was stopped at " + at + ", beyond " + end +
           "; nothing to do. A later time.end goes on from there");
  }
  static std::string lost_file(const std::string& what, const std::string& end) {
    return " is done, beyond " + end + ", but run.vtkhdf " + what +
           "; give a later time.end, or start again with --overwrite";
  }

  void check_checkpoint(const Plan& plan) {
    if (!point_.saved) return;
    const SavedRun& s = *point_.saved;
    if (s.scene.empty())
      bad(std::string("cannot resume: checkpoint.h5 is of an earlier version of pbf, which kept no "
                      "scene in it and whose results are others") +
          kOtherwise);
    refuse_other("checkpoint.h5", s.scene, s.files);
    const bool fitting = s.path.empty() ? fits(s.state, plan.most_particles(), changes_rows(scene_))
                                        : s.particles == plan.particles;
    if (!fitting || s.state.precision != scene_.precision)
      throw Error(ExitCode::io, folder_.file("checkpoint.h5") +
                                    ": holds other particles or another precision "
                                    "than the scene; remove it to start again");
  }

  void look_at_file(const Scene& before) {
    if (!folder_.has(kRunFile)) return forget("run.vtkhdf is missing");
    std::optional<RunReader> file;
    RunInfo info;
    try {
      try_run_file(folder_.file(kRunFile));
      file.emplace(folder_.file(kRunFile));
      info = file->info();
    } catch (const Error& e) {
      damaged_ = true;
      return forget(std::string(e.what()) + "; it becomes run.damaged.vtkhdf");
    }
    if (file->frames() == 0) return forget("");
    refuse_older_log(*file, info);
    refuse_other(kRunFile, info.resolved_scene, info.scene_files);  // older files have none
    point_.keep_file = true;
    add_earlier(file->sessions());
    const std::int64_t u = point_.update();
    if (point_.saved) {
      point_.rows.log = prefix(file->log_column("update"), u,
                               [&](std::int64_t k) { return schedule_.update_of_measure(k); });
      if (schedule_.gauge_every > 0)
        point_.rows.gauges = prefix(file->gauge("update"), u,
                                    [&](std::int64_t k) { return schedule_.update_of_gauges(k); });
    }
    // Frames after the checkpoint stay if the resumed run would write the same.
    const bool same = exact(before) && exact(scene_) && info.commit == commit_;
    const std::vector<std::int64_t> frames = file->updates();
    beyond_ = std::ranges::count_if(frames, [&](auto f) { return f > schedule_.updates; });
    point_.frames = prefix(frames, same ? schedule_.updates : u,
                           [&](std::int64_t k) { return schedule_.update_of_frame(k); });
    if (point_.saved && (point_.frames < schedule_.frames_until(u) ||
                         point_.rows.log < schedule_.measures_until(u) ||
                         point_.rows.gauges < schedule_.gauges_until(u)))
      forget("run.vtkhdf ends before the checkpoint");
  }
  void add_earlier(const std::vector<RunSession>& sessions) {
    EarlierSessions& earlier = point_.earlier.emplace();
    for (const RunSession& s : sessions) {
      const auto began = utc_seconds(s.started), ended = utc_seconds(s.ended);
      ++earlier.sessions;
      earlier.whole &= began && ended;
      if (began && ended) earlier.seconds += std::max(0.0, *ended - *began);
    }
  }
  /// A log that lacks a present column cannot continue; results differ between versions.
  void refuse_older_log(const RunReader& file, const RunInfo& info) const {
    const std::vector<std::string> there = file.log_columns();
    for (const auto& column : run_layout::log_columns())
      if (std::ranges::find(there, column.name) == there.end())
        bad("cannot resume: run.vtkhdf was written by pbf " + info.program_version + " (" +
            info.commit + "), whose log has no column " + column.name +
            " and whose results are others" + kOtherwise);
  }
  /// A checkpoint is useless without the earlier results in run.vtkhdf.
  void forget(const std::string& why) {
    if (point_.saved && !why.empty())
      point_.notes.push_back(why + ": the checkpoint is not used");
    else if (!why.empty() && damaged_)
      point_.notes.push_back(why);
    point_.saved.reset();
    point_.rows = {};
  }

  static constexpr const char* kSame =
      ". Give the same scene, files and --set options as at the start (only time.end, checkpoint, "
      "threads and backend may change), or start anew: in another folder with --out, or in this "
      "one with --overwrite";
  static constexpr const char* kOtherwise =
      "; resume with that program, or start again with --overwrite";
  const RunFolder& folder_;
  const Scene& scene_;
  const std::vector<SceneFile>& files_;
  const std::string& commit_;
  Schedule schedule_;
  ResumePoint point_;
  bool damaged_ = false;
  std::int64_t beyond_ = 0;  // frames of run.vtkhdf after time.end
};

}  // namespace

ResumePoint find_resume_point(const RunFolder& folder, const Scene& scene,
                              const std::vector<SceneFile>& files, const Plan& plan,
                              const std::string& commit) {
  return Finder(folder, scene, files, commit).find(plan);
}

void prepare_resume(const RunFolder& folder, const ResumePoint& from) {
  folder.remove("DONE");
  if (!from.keep_file && folder.has(kRunFile)) {
    const std::string aside = folder.file(kDamagedRunFile);
    if (std::rename(folder.file(kRunFile).c_str(), aside.c_str()) != 0)
      throw Error(ExitCode::io, aside + ": cannot be made: " + std::strerror(errno));
  }
}

}  // namespace pbf::run_module
