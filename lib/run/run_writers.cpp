// What a run writes besides its reports: rows of the log, frames and pictures, checkpoints.
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "lib/base/error.h"
#include "lib/run/run.h"
#include "lib/scene/load.h"

namespace pbf::run_module {

LogRows::LogRows(RunParts& run, Reporter& reporter) : run_(run), reporter_(reporter) {
  if (const auto& saved = run.from.saved) {
    energy_ = EnergyTrack(due_.energy = saved->energy);
    due_.compression_max = run.compression_max = saved->compression_max;
    due_.compressed_updates = saved->compressed_updates;
  }
  due_.scene = resolved_yaml(run.scene);
  due_.files = run.start.loaded.files;
}

void LogRows::take(Diagnostics& m, double dt) {
  energy_.follow(m);
  double& most = run_.compression_max;
  most = std::max(most, m.compression_max);
  if (run_.schedule.measures(m.update)) reporter_.follow(m);
  if (m.update % run_.schedule.measure_every == 0) {
    due_.energy = energy_.history();
    due_.compression_max = most;
    due_.compressed_updates = reporter_.compressed_updates();
  }
  const std::vector<StageTime> since = stages_since_last_row();
  const auto& writer = run_.writer;
  if (!writer && !run_.json) return;
  const std::vector<double> poses = pose_readings(run_.scene, m.time, m.bodies);
  run_.clock.begin();
  if (writer) {
    writer->log({m, run_.scene.solver.iterations, dt, since, poses});
    run_.clock.mark("write");
  }
  if (!run_.json) return;
  const std::int64_t frames = writer ? writer->frames_written() : 0;
  const std::string line =
      measure_json(m, run_.control.wall.seconds(), frames, since, run_.plan.columns, poses) + "\n";
  // A closed pipe is no error, as for stdout.
  if ((std::fwrite(line.data(), 1, line.size(), run_.json) != line.size() ||
       std::fflush(run_.json) != 0) &&
      errno != EPIPE)
    throw Error(ExitCode::io,
                std::string("--log-json: cannot be written: ") + std::strerror(errno));
  run_.clock.mark("write");
}

std::vector<StageTime> LogRows::stages() const {
  const Scene& scene = run_.scene;
  StageClock sum;
  sum.entry("init");
  for (const PassCount& c : count_passes(run_.plan.program, run_.plan.program.update))
    sum.entry(c.pass->stage);
  sum.entry("measure");
  if (scene.guard || scene.time.adaptive) sum.entry("guard");
  if (scene.output || scene.render) sum.entry("download");
  if (scene.output || run_.json) sum.entry("write");
  if (scene.render) sum.entry("render");
  for (const auto& times : {run_.solver.info().stages, run_.clock.entries()})
    for (const StageTime& s : times) sum.add(s.name, s.seconds, s.calls);
  return sum.entries();
}

std::vector<StageTime> LogRows::stages_since_last_row() {
  std::vector<StageTime> now = stages(), since = now;
  for (auto& s : since)
    for (const auto& before : row_stages_)
      if (before.name == s.name) s.seconds -= before.seconds, s.calls -= before.calls;
  row_stages_ = std::move(now);
  return since;
}

Frames::Frames(RunParts& run, Reporter& reporter) : run_(run), reporter_(reporter) {
  const Scene& scene = run.scene;
  if (scene.output) fields_ = scene.output->fields;
  const std::string needed = scene.render ? about(scene.render->color).field : "id";
  if (needed != "id" && std::ranges::find(fields_, needed) == fields_.end())
    fields_.push_back(needed), extra_ = needed;
  if (!run.from.saved) return;
  last_ = run.from.update();
  run.pictures_drawn = run.schedule.pictures_until(last_);
}

Next Frames::at(Session& session) {
  start(session.update(), false);
  return Next::go_on;
}

void Frames::start(std::int64_t u, bool last) {
  bool write = run_.schedule.frame_every > 0 && (last || run_.schedule.writes(u)) && last_ < u;
  bool draw = !last && run_.schedule.draws(u);
#ifndef PBF_HAS_RENDER
  draw = false;  // a scene with pictures was refused before the run began
#endif
  if (write) last_ = u;
  if (write && run_.schedule.frames_until(u) <= run_.from.frames) write = false;
  if (!write && !draw) return;
  const bool wide = run_.scene.output && run_.scene.output->precision == Precision::dbl;
  const ScalarType type = wide ? ScalarType::f64 : ScalarType::f32;
  hand_over();
  if (write && run_.solver.split()) write_split(type), write = false;
  if (!write && !draw) return;
  copy_ = run_.solver.download(fields_, type);
  write_ = write;
  draw_ = draw;
  picture_ = run_.schedule.picture_number(u);
}

void Frames::write_split(ScalarType type) {
  run_.clock.begin();
  if (!split_)
    split_ = std::make_unique<SplitFrames>(
        *run_.solver.split(), *run_.writer, run_.folder.file(kRunFile),
        [&](const std::string& text) { run_.control.log.note("pbf: " + text); });
  split_->end(true);
  run_.clock.mark("write");
  const Snapshot head = run_.solver.split()->hold(run_.scene.output->fields, type);
  run_.clock.begin();  // the solver has recorded its part
  TakeRows look = [&](std::int64_t first, const FieldArray& x) {
    reporter_.look_outside(first, x);
  };
  if (run_.scene.domain.open.empty()) look = nullptr;
  split_->begin(head, look);
  run_.clock.mark("write");
}

void Frames::finish() {
  hand_over();
  run_.clock.begin();
  if (split_) split_->end(true);
  run_.clock.mark("write");
}

void Frames::hand_over() {
  if (split_) split_->end(false);
  if (!copy_.valid()) return;
  Snapshot snapshot = copy_.get();
  run_.clock.begin();
  reporter_.look_outside(0, *snapshot.find("position"));
#ifdef PBF_HAS_RENDER
  if (draw_) {
    run_.pictures->draw(snapshot, picture_);
    ++run_.pictures_drawn;
    run_.clock.mark("render");
  }
#endif
  if (!write_) return;
  std::erase_if(snapshot.fields, [&](const FieldArray& f) { return f.name == extra_; });
  run_.writer->write(std::move(snapshot));
  run_.clock.mark("write");
}

void Frames::end(Session& session) {
  start(session.update(), true);
  finish();
#ifdef PBF_HAS_RENDER
  if (!run_.pictures) return;
  run_.clock.begin();
  run_.pictures->finish();
  run_.drawing_seconds = run_.pictures->seconds();
  run_.pictures.reset();
  run_.clock.mark("render");
#endif
}

void Frames::close() noexcept {
  split_.reset();
#ifdef PBF_HAS_RENDER
  run_.pictures.reset();
#endif
  run_.writer.reset();
}

Next Saving::at(Session& session) {
  if (session.update() >= run_.schedule.updates) return Next::go_on;
  const auto& checkpoint = run_.scene.checkpoint;
  const bool due = checkpoint && since_save_.seconds() >= checkpoint->every;
  if ((run_.control.stop.take_save() || due) && !save()) return Next::stop;
  // A run that can go back continues to its first measurement or frame, to gain something.
  const bool goes_back = monitor_.goes_back();
  if (goes_back && monitor_.guard()->last_good().update <= run_.from.update()) return Next::go_on;
  run_.stop_reason = why_stop();
  if (run_.stop_reason.empty()) return Next::go_on;
  if (goes_back) monitor_.go_back();  // the files hold nothing after the last good state
  save();
  return Next::stop;
}

std::string Saving::why_stop() const {
  const std::string why = run_.control.why_stop();
  return why.empty() && run_.control.strict && reporter_.has_told() ? "--strict" : why;
}

/// Writes all earlier output to disk before the checkpoint. Returns false, and saves nothing, if
/// the guard rejects the state, since no run could continue from it.
bool Saving::save() {
  frames_.finish();
  if (!monitor_.state_is_good()) return false;
  run_.clock.begin();
#ifdef PBF_HAS_RENDER
  if (run_.pictures) run_.pictures->wait();
#endif
  if (run_.writer) run_.writer->sync();
  SavedRun saved = rows_.due();
  saved.first = monitor_.first();
  if (monitor_.guard()) saved.released = monitor_.guard()->released();
  saved.steps = monitor_.steps();
  const StateOf which = monitor_.goes_back() ? StateOf::kept : StateOf::present;
  if (SplitRows* split = run_.solver.split()) {
    saved.particles = run_.plan.particles;
    write_checkpoint(run_.folder.path(), saved, [&](const StateSink& to) {
      split->state_in_pieces(which, kCheckpointRows, to);
    });
  } else {
    saved.state = run_.solver.state(which);
    saved.particles = std::int64_t(saved.state.id.size());
    write_checkpoint(run_.folder.path(), saved);
  }
  run_.clock.mark("write");
  since_save_.reset();
  return true;
}

void Saving::end(Session& session) {
  const std::int64_t u = session.update();
  run_.status = monitor_.event() ? "diverged" : u < run_.schedule.updates ? "stopped" : "finished";
  if (run_.writer) {
    run_.clock.begin();
    RunEnding ending{run_.status, run_.stop_reason, u, {}};
    for (const Warning& w : reporter_.warnings()) ending.warnings.push_back(w.text);
    ending.comparisons = run_.compared;
    run_.writer->finish(ending);
    run_.frames_written = run_.writer->frames_written();
    run_.bytes = run_.writer->bytes_written();
    run_.writer.reset();
    run_.clock.mark("write");
  }
  if (run_.status == "finished" && run_.scene.checkpoint) save();
}

}  // namespace pbf::run_module
