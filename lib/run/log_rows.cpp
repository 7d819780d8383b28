#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "lib/base/error.h"
#include "lib/run/run.h"
#include "lib/run/run_report.h"
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
  run_.clock.begin();
  if (writer) {
    writer->log({m, run_.scene.solver.iterations, dt, since, pose_readings(run_.scene, m.time)});
    run_.clock.mark("write");
  }
  if (!run_.json) return;
  const std::int64_t frames = writer ? writer->frames_written() : 0;
  const std::string line =
      measure_json(m, run_.control.wall.seconds(), frames, since, run_.plan.columns) + "\n";
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

}  // namespace pbf::run_module
