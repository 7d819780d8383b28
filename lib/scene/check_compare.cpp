// Rules for comparisons with measurements. What needs the data: lib/data/comparison.h.
#include <fmt/core.h>
#include <algorithm>

#include "lib/base/text.h"
#include "lib/scene/number.h"
#include "lib/scene/scene_rules.h"
#include "lib/scene/suggest.h"
#include "lib/scene/surface.h"

namespace pbf::scene_module {
namespace {

class CompareChecker : public SceneRules {
 public:
  using SceneRules::SceneRules;

  void run() {
    if (!good(s_.compare)) return;
    for (const Comparison& c : s_.compare) check(c);
    check_result_names();
  }

 private:
  void check(const Comparison& c) {
    const int given = !c.gauge.empty() + !c.load.empty() + !c.log.empty();
    if (given == 1) check_reading(c);
    if (!good(c.between, c.lag, c.lag_range)) return;
    if (const auto problem = problem_of(c, s_.compare)) {
      ++wrong_;
      add_at(block_of(name(c.data)) + "." + problem->key, "{}", problem->what);
    }
  }

  void check_reading(const Comparison& c) {
    if (!c.gauge.empty()) check_gauge(c);
    if (!c.load.empty()) check_load(c);
    if (!c.log.empty() && !c.component.empty())
      wrong(c.component,
            "goes with a gauge or a load; a column of the log names its own (momentum_x)");
  }

  void check_gauge(const Comparison& c) {
    if (!good(s_.gauges)) return;
    std::vector<std::string> names;
    for (const Gauge& g : s_.gauges) {
      names.push_back(g.name);
      if (g.name != c.gauge || !good(g.kind)) continue;
      const bool vector =
          std::visit([](const auto& k) { return k.columns[0].components > 1; }, g.kind);
      if (vector != !c.component.empty())
        wrong(c.component, vector ? "is missing: " + c.gauge + " reads a velocity; give x, y or z"
                                  : "goes with a velocity or a load, and " + c.gauge +
                                        " reads one number; remove it");
      else if (vector && c.component != "x" && c.component != "y" && c.component != "z")
        wrong(c.component, "is \"" + c.component + "\", expected x, y or z");
      return;
    }
    wrong(c.gauge, "no gauge is named " + c.gauge + meant(c.gauge, names));
  }

  void check_load(const Comparison& c) {
    if (!good(s_.obstacles, s_.domain.open)) return;
    const std::optional<int> surface = surface_named(s_, c.load);
    if (!surface) {
      std::vector<std::string> names(kFaceNames.begin(), kFaceNames.end());
      for (const Obstacle& o : s_.obstacles) names.push_back(o.name);
      return wrong(c.load, "no wall or obstacle is named " + c.load + meant(c.load, names));
    }
    const Obstacle* o = obstacle_of(s_, *surface);
    if (o ? !o->loads : !s_.domain.loads)
      return wrong(c.load, "the loads of " + c.load + " are not recorded; give " +
                               (o ? "the obstacle" : "domain") + " loads: true");
    static const std::vector<std::string> kWords{"x",        "y",         "z",        "force_x",
                                                 "force_y",  "force_z",   "torque_x", "torque_y",
                                                 "torque_z", "force_peak"};
    if (std::ranges::find(kWords, c.component) == kWords.end())
      wrong(c.component,
            (c.component.empty() ? "is missing" : "is \"" + c.component + "\"") +
                std::string("; give x, y or z of the force, torque_x, torque_y, torque_z or "
                            "force_peak"));
  }

  void check_result_names() {
    std::map<std::string, std::size_t> seen;
    for (std::size_t k = 0; k < s_.compare.size() && wrong_ == 0; ++k) {
      const Comparison& c = s_.compare[k];
      if (!good(c.name)) continue;
      const std::string is = name_of(c);
      if (is.find('/') != is.npos || is == "." || is == ".." || is == "none" || is == "fit")
        wrong(c.name, "\"" + is + "\" cannot name a result; give a word without \"/\"");
      else if (const auto [first, fresh] = seen.try_emplace(is, k); !fresh)
        wrong(c.name, fmt::format("{} is also the result of compare[{}]; give each a name", is,
                                  first->second));
    }
  }

  static std::string meant(const std::string& word, const std::vector<std::string>& words) {
    const std::string near = nearest_choice(word, words);
    return (near.empty() ? "" : "; did you mean " + near + "?") +
           (words.empty() ? "; the scene has none" : "; there are " + joined(words, ", "));
  }

  void wrong(const auto& member, const std::string& what) {
    ++wrong_;
    add(member, "{}", what);
  }
  std::size_t wrong_ = 0;
};

bool is_range(const std::optional<Comparison::Span>& range) {
  return range && (*range)[1] > (*range)[0];
}

constexpr const char* kNoRange = "is not two numbers of which the second is larger";

}  // namespace

std::optional<ComparisonProblem> problem_of(const Comparison& c,
                                            const std::vector<Comparison>& all) {
  using Problem = ComparisonProblem;
  const int given = !c.gauge.empty() + !c.load.empty() + !c.log.empty();
  if (given != 1)
    return Problem{"gauge", given == 0
                                ? "which reading? Give one of gauge: NAME, load: NAME, log: COLUMN"
                                : "is given beside another of gauge, load and log; give each an "
                                  "entry of its own"};
  if (c.between && !is_range(c.between))
    return Problem{"between", std::string(kNoRange) + "; give [from, to]"};
  if (c.lag == "fit") {
    if (is_range(c.lag_range)) return std::nullopt;
    return Problem{"lag_range", (!c.lag_range ? "is missing: lag: fit looks from where to "
                                                "where?"
                                              : kNoRange) +
                                    std::string(" Give [-0.2, 0.2], say")};
  }
  if (c.lag_range) return Problem{"lag_range", "goes with lag: fit; remove it"};
  double number = 0;
  if (c.lag == "none" || read_number(c.lag, number) == NumberError::none) return std::nullopt;
  std::vector<std::string> fitted;
  for (const Comparison& other : all)
    if (other.lag == "fit") fitted.push_back(name_of(other));
  if (std::ranges::find(fitted, c.lag) != fitted.end()) return std::nullopt;
  return Problem{"lag",
                 "is \"" + c.lag +
                     "\": give none, fit, seconds, or the name of a comparison with lag: "
                     "fit" +
                     (fitted.empty() ? "; there is none" : "; there are " + joined(fitted, " "))};
}

void check_compare(const PlacedScene& placed, Problems& problems) {
  CompareChecker(placed, problems).run();
}

}  // namespace pbf::scene_module
