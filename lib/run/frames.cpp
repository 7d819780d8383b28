#include <algorithm>
#include <utility>

#include "lib/run/run.h"

namespace pbf::run_module {

Frames::Frames(RunParts& run, Reporter& reporter) : run_(run), reporter_(reporter) {
  const Scene& scene = run.scene;
  if (scene.output) fields_ = scene.output->fields;
  const std::string needed = scene.render ? about(scene.render->color).field : "id";
  if (needed != "id" && std::find(fields_.begin(), fields_.end(), needed) == fields_.end())
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
  hand_over();
  copy_ = run_.solver.download(fields_, wide ? ScalarType::f64 : ScalarType::f32);
  write_ = write;
  draw_ = draw;
  picture_ = run_.schedule.picture_number(u);
}

void Frames::hand_over() {
  if (!copy_.valid()) return;
  Snapshot snapshot = copy_.get();
  run_.clock.begin();
  reporter_.look_outside(snapshot);
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
  hand_over();
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
#ifdef PBF_HAS_RENDER
  run_.pictures.reset();
#endif
  run_.writer.reset();
}

}  // namespace pbf::run_module
