// What a plan comes to: one number for each question, the same in the text and in the JSON form.
#include <cmath>
#include <nlohmann/json.hpp>

#include "lib/base/text.h"
#include "lib/program/plan.h"
#include "lib/scene/auto_step.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace {

using namespace pbf;
using scene_test::contains;
using scene_test::kMinimal;

const std::string kAll = kMinimal + "threads: 1\noutput: {every: 0.1}\nrender: {every: 0.2}\n";

}  // namespace

TEST_CASE("plan summary: the sums are those of its parts, in the text and in the JSON form") {
  const Scene s = scene_test::parse(kAll);
  const Plan plan = make_plan(s, 500);
  const PlanTotals totals = plan_totals(plan, s);
  CHECK(totals.updates == 100);
  CHECK(totals.end == Approx(1));
  CHECK(totals.host_bytes == plan.memory.host_arrays + plan.memory.fixed_bytes(false));
  CHECK(totals.device_bytes == 0);
  std::int64_t disk = 0;
  for (const PlanFile& f : plan.files) disk += f.bytes;
  CHECK(totals.disk_bytes == disk);
  const std::string text = plan_summary(plan, s, "as long as it takes");
  CHECK(contains(text, "\n  time      1 s in 100 updates of 0.01 s; dt sqrt(g/h) = 0.07 ("));
  CHECK(contains(text, "\n  run time  as long as it takes\n"));
  CHECK(contains(
      text, "\n  memory    about " + bytes_text(double(totals.host_bytes)) + " on the host; "));
  CHECK(contains(text, "\n  disk      " + bytes_text(double(disk)) + ": run.vtkhdf "));
  CHECK_FALSE(contains(text, "log.txt"));  // next to nothing
  CHECK(std::count(text.begin(), text.end(), '\n') == 5);
  CHECK_FALSE(contains(plan_summary(plan, s, ""), "run time"));
  const Json json = plan_json(plan, s);
  CHECK(json["host_bytes"] == totals.host_bytes);
  CHECK(json["disk_bytes"] == disk);
  CHECK(json["updates"] == 100);
  CHECK(json["h_m"] == s.h());
  // The choice of the scene is one of those that the memory of every backend is told for.
  bool there = false;
  for (const Json& m : json["memory"]) there = there || m["host_peak"] == totals.host_bytes;
  CHECK(there);
}

TEST_CASE("plan summary: a device has a sum of its own, steps that adapt and free fall are told") {
  const Scene cuda = scene_test::parse(kAll + "backend: cuda\n");
  const Plan plan = make_plan(cuda, 500);
  const PlanTotals totals = plan_totals(plan, cuda);
  CHECK(totals.device_bytes == plan.memory.device_peak());
  CHECK(totals.device_bytes > 0);
  CHECK(contains(plan_summary(plan, cuda, ""),
                 " on the host, " + bytes_text(double(totals.device_bytes)) + " on the device"));
  const Scene adaptive = scene_test::parse(
      "domain: {min: [0, 0, 0], max: [1, 1, 1]}\nfluid: {spacing: 0.1}\n"
      "bodies: [{shape: block, min: [0, 0, 0], max: [1, 1, 0.5]}]\n"
      "time: {step: 0.01, end: 1, adaptive: {step_min: 0.003}}\n");
  CHECK(contains(plan_summary(make_plan(adaptive, 500), adaptive, ""), ", each of 1 to "));
  const Scene flying = scene_test::parse(kAll + "gravity: [0, 0, 0]\n");
  CHECK(relative_step(flying) == 0);
  CHECK_FALSE(contains(plan_summary(make_plan(flying, 500), flying, ""), "sqrt"));
}

TEST_CASE("the step without dimension is dt sqrt(g/h), whichever way gravity points") {
  Scene s = scene_test::parse(kMinimal + "gravity: [0, 3, -4]\n");
  CHECK(relative_step(s) == Approx(0.01 * std::sqrt(5 / 0.2)));
  // time.step: auto, without output to fit, is the longest step that is safe.
  s.time.step = step_rule(s).gravity;
  CHECK(relative_step(s) == Approx(kSafeStep));
}
