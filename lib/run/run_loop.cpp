#include "lib/run/run_loop.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "lib/base/error.h"
#include "lib/run/signals.h"
#include "lib/scene/load.h"

namespace pbf::inline run_module {
namespace {

bool has(const std::vector<std::string>& list, const std::string& name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

}  // namespace

const char* status_name(RunEnd end) {
  switch (end) {
    case RunEnd::finished:
      return "finished";
    case RunEnd::stopped:
      return "stopped";
    case RunEnd::diverged:
      return "diverged";
  }
  return "";
}

RunLoop::RunLoop(const Scene& scene, const Plan& plan, Solver& solver, RunSinks sinks, Log& log,
                 StageClock& clock, const Stopwatch& wall, const RunLimits& limits)
    : scene_(scene),
      plan_(plan),
      solver_(solver),
      sinks_(std::move(sinks)),
      log_(log),
      clock_(clock),
      wall_(wall),
      limits_(limits),
      schedule_(make_schedule(scene)),
      progress_(log),
      warnings_(scene, plan.particles, schedule_.updates) {
  for (const Warning& w : limits_.of_scene) told_.emplace(w.kind, w.text);  // by who found them
  due_.scene = resolved_yaml(scene);
  due_.files = sinks_.scene_files;
  if (scene.output) fields_ = scene.output->fields;
  if (scene.render && scene.render->color != ColorBy::id) {
    const char* needed = scene.render->color == ColorBy::speed ? "velocity" : "density";
    if (!has(fields_, needed)) fields_.push_back(needed), extra_.push_back(needed);
  }
}

void RunLoop::go_on_from(const SavedRun& saved) {
  const std::int64_t u = saved.state.updates;
  due_.energy = saved.energy;
  due_.compression_max = compression_max_ = saved.compression_max;
  energy_ = EnergyTrack(saved.energy);
  first_ = due_.first = saved.first;
  first_.energy = saved.energy.first;
  steps_ = saved.steps;
  released_ = saved.released;
  due_.compressed_updates = saved.compressed_updates;
  warnings_.go_on_from(saved.compressed_updates);
  resumed_ = true;
  seen_frames_ = schedule_.frames_until(u);
  pictures_ = schedule_.pictures_until(u);
  start_ = last_frame_ = u;
  if (schedule_.measures(u)) last_measure_ = u;
  progress_.start_at(u);
}

RunEnd RunLoop::run() {
  const Stopwatch loop;
  std::int64_t u = start_;
  if (resumed_) {
    show(solver_.measure());
  } else {
    measure();
    first_ = due_.first = last_;
    outputs(0, false);
    choose_step(0);
  }
  double per_update = 0;  // s, of the last call of step()
  while (u < schedule_.updates && !guard_event() && !must_stop()) {
    // Short calls, so that a signal or the wall-time limit waits a quarter of a second at most
    // (or one update), yet few calls when an update takes microseconds.
    std::int64_t n = 1;
    if (per_update > 0) n = std::max<std::int64_t>(1, std::int64_t(0.25 / per_update));
    n = std::min({n, schedule_.next_event(u) - u, std::int64_t(1 << 20)});
    const double step_before = step();
    const Stopwatch watch;
    solver_.step(static_cast<int>(n), watch_ ? watch_->options() : StepOptions{});
    per_update = watch.seconds() / double(n);
    hand_over();  // what was being copied while the updates ran
    u += n;
    if (schedule_.measures(u))
      measure();
    else if (goes_back() && schedule_.has(u))
      look(solver_.measure());
    if (solver_.updates() < u && !guard_event()) {  // again, with a shorter step
      u = solver_.updates();
    } else if (!guard_event()) {
      outputs(u, false);
      choose_step(u);
    }
    if (!guard_event() && u < schedule_.updates) tell(warnings_.at(last_, false));
    per_update *= step_before / step();
    progress_.update({u, schedule_.updates, plan_.particles,
                      double(solver_.updates()) * scene_.time.step, last_.compression_mean,
                      last_.compression_max, start_});
    if (!guard_event() && u < schedule_.updates && checkpoint_due()) save();
  }
  if (!guard_event() && u < schedule_.updates) {
    if (goes_back()) {  // nothing beyond the last good state is in the files
      watch_->go_back();
      u = solver_.updates();
    }
    save();
  }
  // Stopped between two measures; what it has gone back to is known to be good.
  if (!guard_event() && last_measure_ != u) measure(!goes_back());
  if (guard_event()) u = solver_.updates();  // gone back to what it found
  outputs(u, true);
  const RunEnd end = guard_event()           ? RunEnd::diverged
                     : u < schedule_.updates ? RunEnd::stopped
                                             : RunEnd::finished;
  close(end);
  if (end == RunEnd::finished && scene_.checkpoint) save();
  loop_seconds_ = loop.seconds();
  return end;
}

/// A run that alarms take back goes on to its first measure or frame, so that it gains something.
bool RunLoop::must_stop() {
  stop_reason_.clear();
  if (goes_back() && watch_->guard()->last_good().update <= start_) return false;
  stop_reason_ = signal_seen();
  if (stop_reason_.empty() && limits_.walltime > 0 && wall_.seconds() >= limits_.walltime)
    stop_reason_ = "--max-walltime";
  if (stop_reason_.empty() && limits_.strict && !told_.empty()) stop_reason_ = "--strict";
  return !stop_reason_.empty();
}

bool RunLoop::checkpoint_due() {
  return save_asked() || (scene_.checkpoint && since_save_.seconds() >= scene_.checkpoint->every);
}

/// All that comes before the state is on the disk before the checkpoint is. A state that the guard
/// objects to is not saved: no run could go on from it.
void RunLoop::save() {
  hand_over();
  if (scene_.guard && !goes_back() && last_measure_ != solver_.updates()) look(solver_.measure());
  if (guard_event()) return;
  clock_.begin();
  if (!closed_) {
#ifdef PBF_HAS_RENDER
    if (sinks_.pictures) sinks_.pictures->wait();
#endif
    if (sinks_.writer) sinks_.writer->sync();
  }
  due_.state = goes_back() ? solver_.state(Which::kept) : solver_.state();
  due_.particles = plan_.particles;
  if (watch_ && watch_->guard()) due_.released = watch_->guard()->released();
  if (watch_ && watch_->adaptive()) due_.steps = watch_->adaptive()->history();
  write_checkpoint(sinks_.checkpoints, due_);
  due_.state = {};
  clock_.mark("write");
  since_save_.reset();
}

void RunLoop::show(const Measures& m) {
  last_ = m;
  EnergyTrack(energy_).follow(last_);
  if (watched()) watch(m);
}

void RunLoop::measure(bool judged) {
  const Measures m = solver_.measure();
  if (watched()) watch(m);
  const double dt = step();
  if (watched() && judged && look(m) == Verdict::back) return;
  last_ = m;
  energy_.follow(last_);
  last_measure_ = last_.update;
  compression_max_ = std::max(compression_max_, last_.compression_max);
  if (schedule_.measures(last_.update)) warnings_.follow(last_);
  if (last_.update % schedule_.measure_every == 0) {
    due_.energy = energy_.history();
    due_.compression_max = compression_max_;
    due_.compressed_updates = warnings_.compressed_updates();
  }
  const std::vector<StageTime> since = stages_since_last_row();
  clock_.begin();
  if (sinks_.writer) {
    sinks_.writer->log({last_, scene_.solver.iterations, dt, since});
    clock_.mark("write");
  }
  if (sinks_.json) {
    const std::int64_t frames = sinks_.writer ? sinks_.writer->frames_written() : 0;
    const std::string line = measure_json(last_, wall_.seconds(), frames, since) + "\n";
    // A reader that has gone is no error, as on stdout.
    if ((std::fwrite(line.data(), 1, line.size(), sinks_.json) != line.size() ||
         std::fflush(sinks_.json) != 0) &&
        errno != EPIPE)
      throw Error(ExitCode::io,
                  std::string("--log-json: cannot be written: ") + std::strerror(errno));
    clock_.mark("write");
  }
}

bool RunLoop::told(const Warning& w) const {
  const auto at = told_.find(w.kind);
  return at != told_.end() && at->second == w.text;
}

/// Each kind once: at the end the whole run's figures are told.
void RunLoop::tell(const std::vector<Warning>& found) {
  for (const Warning& w : found)
    if (told_.emplace(w.kind, w.text).second) log_.warning(w.text);
}

/// Made with the first measure of this process.
Watch& RunLoop::watch(const Measures& m) {
  if (!watch_)
    watch_.emplace(
        scene_, plan_, solver_, resumed_ ? first_ : m, m,
        [this](const std::string& line) { log_.note(line); }, steps_.value_or(StepHistory{}),
        released_);
  return *watch_;
}

Verdict RunLoop::look(const Measures& m) {
  Verdict v{};
  book_guard([&] { v = watch_->look(m, !goes_back() || schedule_.has(m.update)); });
  return v;
}

/// A measure at the end of a run alone chooses nothing: a longer run would not have it.
void RunLoop::choose_step(std::int64_t u) {
  if (!scene_.time.adaptive || guard_event() || last_measure_ != u ||
      u % schedule_.measure_every != 0)
    return;
  book_guard([&] { watch_->choose(last_); });
}

/// Books what `action` takes, but for what the solver books itself.
void RunLoop::book_guard(const std::function<void()>& action) {
  const auto solver_seconds = [&] {
    double sum = 0;
    for (const StageTime& s : solver_.info().stages) sum += s.seconds;
    return sum;
  };
  const double before = solver_seconds();
  const Stopwatch stopwatch;
  action();
  clock_.add("guard", stopwatch.seconds() - (solver_seconds() - before));
}

void RunLoop::outputs(std::int64_t u, bool last) {
  bool write = schedule_.frame_every > 0 && (last || schedule_.writes(u)) && last_frame_ < u;
  bool draw = !last && schedule_.draws(u);
#ifndef PBF_HAS_RENDER
  draw = false;  // refused before the run began
#endif
  if (write && !last) ++seen_frames_;
  if (write && seen_frames_ <= kept_frames_) {
    write = false;
    last_frame_ = u;
  }
  if (!write && !draw) return;
  const bool wide = scene_.output && scene_.output->precision == Precision::dbl;
  hand_over();
  under_way_ =
      UnderWay{solver_.download(fields_, wide ? ScalarType::f64 : ScalarType::f32), write, draw};
  if (write) last_frame_ = u;
  if (last) hand_over();
}

void RunLoop::hand_over() {
  if (!under_way_.copy.valid()) return;
  const bool write = under_way_.write, draw = under_way_.draw;
  Snapshot snapshot = under_way_.copy.get();
  clock_.begin();
  warnings_.look_outside(snapshot);
  (void)draw;  // without pictures
#ifdef PBF_HAS_RENDER
  if (draw) {
    sinks_.pictures->draw(snapshot, pictures_++);
    clock_.mark("render");
  }
#endif
  if (write) {
    for (const std::string& name : extra_)
      std::erase_if(snapshot.fields, [&](const FieldArray& f) { return f.name == name; });
    sinks_.writer->write(std::move(snapshot));
    clock_.mark("write");
  }
}

void RunLoop::close(RunEnd end) {
  hand_over();
  closed_ = true;
  clock_.begin();
#ifdef PBF_HAS_RENDER
  if (sinks_.pictures) {
    sinks_.pictures->finish();
    render_thread_ = sinks_.pictures->seconds();
    clock_.mark("render");
  }
#endif
  if (!scene_.domain.open.empty()) warnings_.look_outside(solver_.state(Which::positions).position);
  all_warnings_ = limits_.of_scene;
  for (Warning& w : warnings_.at(last_, end == RunEnd::finished))
    all_warnings_.push_back(std::move(w));
  if (sinks_.writer) {
    RunEnding ending{status_name(end), stop_reason_, solver_.updates(), {}};
    for (const Warning& w : all_warnings_) ending.warnings.push_back(w.text);
    sinks_.writer->finish(ending);
    frames_ = sinks_.writer->frames_written();
    bytes_ = sinks_.writer->bytes_written();
    clock_.mark("write");
  }
}

std::vector<StageTime> RunLoop::stages() const {
  // The names of the whole run from the start, so that every row of the log has the same columns.
  std::vector<StageTime> out;
  const auto add = [&](const std::string& name, double seconds, std::int64_t calls) {
    for (auto& s : out) {
      if (s.name != name) continue;
      s.seconds += seconds;
      s.calls += calls;
      return;
    }
    out.push_back({name, seconds, calls});
  };
  add("init", 0, 0);
  for (const PassCount& c : count_passes(plan_.program.update)) add(c.pass->stage, 0, 0);
  add("measure", 0, 0);
  if (watched()) add("guard", 0, 0);
  if (scene_.output || scene_.render) add("download", 0, 0);
  if (scene_.output || sinks_.json) add("write", 0, 0);
  if (scene_.render) add("render", 0, 0);
  for (const StageTime& s : solver_.info().stages) add(s.name, s.seconds, s.calls);
  for (const auto& e : clock_.entries()) add(e.name, e.seconds, e.calls);
  return out;
}

std::vector<StageTime> RunLoop::stages_since_last_row() {
  std::vector<StageTime> now = stages(), since = now;
  for (auto& s : since)
    for (const auto& before : row_stages_)
      if (before.name == s.name) s.seconds -= before.seconds, s.calls -= before.calls;
  row_stages_ = std::move(now);
  return since;
}

RunTotals RunLoop::totals() const {
  RunTotals t;
  t.particles = plan_.particles;
  t.updates = solver_.updates();
  t.first_update = start_;
  t.simulated = double(solver_.updates()) * scene_.time.step;
  t.wall = wall_.seconds();
  t.loop = loop_seconds_;
  t.stages = stages();
  t.render_thread = render_thread_;
  t.fused = scene_.solver.fused;
  t.first = first_;
  t.tolerance = plan_.tolerance;
  t.substeps = plan_.substeps;
  t.max_sweeps = scene_.solver.iterations * (1 + plan_.more_rounds);
  if (watch_ && watch_->adaptive()) {
    t.steps = watch_->adaptive()->history();
    t.steps->updates = watch_->adaptive()->updates_at_levels(t.updates);
  }
  t.step = scene_.time.step;
  t.speed_limit = scene_.solver.speed_limit * scene_.h() / scene_.time.step;
  t.last = last_;
  t.compression_max = compression_max_;
  t.frames = frames_;
  t.pictures = pictures_;
  t.bytes = bytes_;
  return t;
}

}  // namespace pbf::inline run_module
