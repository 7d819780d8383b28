#include "lib/run/run.h"

namespace pbf::run_module {

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
  const Control& control = run_.control;
  if (const char* why = control.stop.why()) return why;
  if (control.max_walltime > 0 && control.wall.seconds() >= control.max_walltime)
    return "--max-walltime";
  return control.strict && reporter_.has_told() ? "--strict" : "";
}

/// Writes all earlier output to disk before the checkpoint. Returns false, and saves nothing, if
/// the guard rejects the state, since no run could continue from it.
bool Saving::save() {
  frames_.hand_over();
  if (!monitor_.state_is_good()) return false;
  run_.clock.begin();
#ifdef PBF_HAS_RENDER
  if (run_.pictures) run_.pictures->wait();
#endif
  if (run_.writer) run_.writer->sync();
  SavedRun saved = rows_.due();
  saved.first = monitor_.first();
  saved.state = monitor_.goes_back() ? run_.solver.state(StateOf::kept) : run_.solver.state();
  saved.particles = std::int64_t(saved.state.id.size());
  if (monitor_.guard()) saved.released = monitor_.guard()->released();
  saved.steps = monitor_.steps();
  write_checkpoint(run_.folder.path(), saved);
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
    run_.writer->finish(ending);
    run_.frames_written = run_.writer->frames_written();
    run_.bytes = run_.writer->bytes_written();
    run_.writer.reset();
    run_.clock.mark("write");
  }
  if (run_.status == "finished" && run_.scene.checkpoint) save();
}

}  // namespace pbf::run_module
