// When a run writes and draws: one schedule for the run, its forecast and the names of pictures.
#include "lib/program/schedule.h"

#include "lib/program/plan.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

using namespace pbf;
using scene_test::kMinimal;
using scene_test::parse;
using Notes = std::vector<std::string>;

namespace {

Scene scene(const std::vector<std::string>& more) {
  std::vector<std::string> keys{"time.step=0.02", "time.end=1"};
  keys.insert(keys.end(), more.begin(), more.end());
  return parse(kMinimal, keys);
}
std::int64_t forecast(const Scene& s, const std::string& name) {
  for (const PlanFile& f : make_plan(s, 100).files)
    if (f.name == name) return f.number;
  return 0;
}

}  // namespace

TEST_CASE("schedule: the plan forecasts as many pictures as the run draws, at any interval") {
  const std::string frames = GENERATE("0.02", "0.05", "0.3", "2");
  const std::string pictures = GENERATE("0.02", "0.05", "0.07", "0.3", "3");
  const bool written = GENERATE(false, true);
  std::vector<std::string> keys{"render.every=" + pictures};
  if (written && std::stod(frames) <= std::stod(pictures)) keys.push_back("output.every=" + frames);
  const Scene s = scene(keys);
  const Schedule schedule = make_schedule(s);
  std::int64_t drawn = 0;
  for (std::int64_t u = 0; u <= schedule.updates; ++u) drawn += schedule.draws(u);
  CHECK(forecast(s, "frames/frame_*.png") == drawn);
}

TEST_CASE("schedule: a picture has the number of the frame of its moment") {
  const Schedule both = make_schedule(scene({"output.every=0.04", "render.every=0.12"}));
  for (std::int64_t u = 0; u <= both.updates; ++u)
    if (both.draws(u)) CHECK(both.update_of_frame(both.picture_number(u)) == u);
  const Schedule alone = make_schedule(scene({"render.every=0.12"}));
  CHECK(alone.picture_number(0) == 0);
  CHECK(alone.picture_number(6) == 1);
}

TEST_CASE("schedule: intervals that are no whole number of updates are told, others not") {
  CHECK(rounded_times(scene({"output.every=0.06", "render.every=0.12"})).empty());
  CHECK(rounded_times(scene({"output.every=0.05"})) ==
        Notes{"output.every: 0.05 s becomes 0.06 s, 3 updates of 0.02 s"});
  CHECK(rounded_times(scene({"output.every=0.06", "render.every=0.1"})) ==
        Notes{"render.every: 0.1 s becomes 0.12 s, 6 updates of 0.02 s"});
  CHECK(rounded_times(scene({"time.end=0.05", "gauges=[{name: a, kind: level, at: [0.5, 0.5]}]",
                             "output.gauges_every=0.07"})) ==
        Notes{"time.end: 0.05 s becomes 0.06 s, 3 updates of 0.02 s",
              "output.gauges_every: 0.07 s becomes 0.08 s, 4 updates of 0.02 s"});
}
