// Columns of gauges and loads in the summary of a batch, as a scene asks for them.
#include "lib/scene/summary.h"

#include <algorithm>

#include "lib/program/plan.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

const std::string kRead = kMinimal +
                          "obstacles: [{name: post, shape: box, min: [0.7, 0.4, 0], max: [0.8, "
                          "0.6, 1], loads: true}]\n"
                          "gauges:\n"
                          "  - {name: H, kind: level, at: [0.2, 0.5]}\n"
                          "  - {name: U, kind: velocity, at: [0.2, 0.5, 0.1]}\n"
                          "  - {name: 'Q [1], x', kind: flow, center: [0.5, 0.5, 0.5], normal: "
                          "[1, 0, 0], size: [1, 1]}\n";

std::vector<std::string> names_in(const std::vector<SummaryColumn>& columns) {
  std::vector<std::string> names;
  for (const SummaryColumn& c : columns) names.push_back(c.name);
  return names;
}

}  // namespace

TEST_CASE("summary: every gauge and every recorded load has columns along the scene's axes") {
  const Scene s = parse(kRead);
  CHECK(names_in(summary_columns(s)) ==
        std::vector<std::string>{
            "gauge/H/max", "gauge/H/mean", "gauge/U/x/max", "gauge/U/x/mean", "gauge/U/y/max",
            "gauge/U/y/mean", "gauge/U/z/max", "gauge/U/z/mean", "gauge/Q [1], x/max",
            "gauge/Q [1], x/mean", "load/post/force_x/max_20ms", "load/post/force_x/mean",
            "load/post/impulse_x", "load/post/force_y/max_20ms", "load/post/force_y/mean",
            "load/post/impulse_y", "load/post/force_z/max_20ms", "load/post/force_z/mean",
            "load/post/impulse_z"});
  // The surfaces are those whose loads a run records.
  const Scene walls = parse(kRead, {"domain.loads=true", "domain.open=[z_max]"});
  std::vector<std::string> impulses;
  for (const ReadingColumn& c : make_plan(walls, 500).columns)
    if (c.name == std::string("impulse")) impulses.push_back("load/" + c.of + "/impulse_x");
  CHECK(impulses.size() == 6);
  const std::vector<std::string> all = names_in(summary_columns(walls));
  CHECK(std::ranges::count_if(all,
                              [](const std::string& n) { return n.ends_with("/impulse_x"); }) == 6);
  for (const std::string& name : impulses) CHECK(std::ranges::count(all, name) == 1);
  const Scene flat = parse(kMinimal, {"dimensions=2", "domain.max=[1, 0.1, 1]",
                                      "gauges=[{name: U, kind: velocity, at: [0.2, 0, 0.1]}]"});
  CHECK(names_in(summary_columns(flat)) ==
        std::vector<std::string>{"gauge/U/x/max", "gauge/U/x/mean", "gauge/U/z/max",
                                 "gauge/U/z/mean"});
}

TEST_CASE("summary: named columns are the only ones, and beyond 200 there are no others") {
  const std::string named = "summary: [load/post/impulse_x, gauge/H/max, 'gauge/Q [1], x/mean']\n";
  const Scene s = parse(kRead + named + "summary_from: 0.25\n");
  CHECK(s.summary_from == 0.25);
  CHECK(names_in(wanted_summary_columns(s)) ==
        std::vector<std::string>{"gauge/H/max", "gauge/Q [1], x/mean", "load/post/impulse_x"});
  CHECK(parse(resolved_yaml(s)) == s);
  const auto with_levels = [&](int n) {
    std::string gauges;
    for (int k = 0; k < n; ++k)
      gauges += "  - {name: g" + std::to_string(k) + ", kind: level, at: [0.2, 0.5]}\n";
    return kMinimal + "gauges:\n" + gauges;
  };
  CHECK(wanted_summary_columns(parse(with_levels(100))).size() == kMostSummaryColumns);
  CHECK(wanted_summary_columns(parse(with_levels(101))).empty());
  CHECK(
      names_in(wanted_summary_columns(parse(with_levels(101) + "summary: [gauge/g100/mean]\n"))) ==
      std::vector<std::string>{"gauge/g100/mean"});
}

TEST_CASE("summary: what names no column is refused with the nearest, in its line") {
  const auto refused = [](const std::string& summary, const std::string& text = kRead) {
    return parse_error(text + "summary: " + summary + "\n");
  };
  CHECK(contains(refused("[gauge/H/max, gauge/H/maks]"),
                 "scene.yaml:11:10: summary: there is no column gauge/H/maks; did you mean "
                 "gauge/H/max?"));
  CHECK(contains(refused("[load/post/force_x/max]"), "did you mean load/post/force_x/m"));
  CHECK(contains(refused("[somewhere_else]"), "no column somewhere_else; there are gauge/H/max; "));
  CHECK(
      contains(refused("[gauge/H/max]", kMinimal), "the scene has no gauges and records no loads"));
  CHECK(contains(refused("[gauge/H/max, gauge/H/max]"), "is listed twice"));
  CHECK(contains(refused("gauge/H/max"), "a list of names in brackets"));
  CHECK(contains(refused("[[gauge/H/max]]"), "a name"));
  CHECK(contains(parse_error(kRead + "summary_from: -1\n"), "out of range"));
}

}  // namespace pbf::scene_test
