// Reads suite files (YAML) into cases.
#include <algorithm>
#include <filesystem>
#include <set>

#include "lib/campaign/stability.h"
#include "lib/campaign/strict_reader.h"
#include "lib/scene/load.h"

namespace pbf::campaign_module {
namespace {

class SuiteReader : StrictReader {
 public:
  using StrictReader::StrictReader;

  std::vector<StabilityCase> read() {
    const Node root = load_tree(path_, "stability suite");
    read_map(root, "", {{"cases", [&](const Node& list) {
                           if (list.kind != Node::Kind::list)
                             return bad(list, "cases", "expected a list of cases");
                           for (const Node& item : list.items) read_case(item);
                         }}});
    if (problems_.empty() && cases_.empty()) bad(root, "cases", "missing; required");
    check_names();
    problems_.raise();
    return std::move(cases_);
  }

 private:
  Read word(std::string& out) {
    return [this, &out](const Node& n) { text(n, "", out); };
  }
  /// Reads a number that is not negative into a double or an optional.
  Read number(auto& out) { return StrictReader::number("", 0., 1e9, out); }
  Read keys(Settings& out) {
    return [this, &out](const Node& n) { out = settings(n, ""); };
  }

  void read_case(const Node& n) {
    StabilityCase c;
    Criteria& m = c.must;
    const auto seen = read_map(n, "",
                               {{"name", word(c.name)},
                                {"group", word(c.group)},
                                {"about", word(c.about)},
                                {"scene", word(c.scene)},
                                {"set", keys(c.set)},
                                {"reduced", keys(c.small)},
                                {"must", [&](const Node& must) {
                                   read_map(must, "",
                                            {{"speed", number(m.speed)},
                                             {"energy", number(m.energy)},
                                             {"compression_mean", number(m.compression_mean)},
                                             {"compression_max", number(m.compression_max)},
                                             {"nearest", number(m.nearest)},
                                             {"still", number(m.still)},
                                             {"height", number(m.height)},
                                             {"momentum", number(m.momentum)},
                                             {"penetration", number(m.penetration)},
                                             {"through", number(m.through)},
                                             {"loads", number(m.loads)},
                                             {"like", word(m.like)},
                                             {"error", StrictReader::number("", 0, 255, m.error)},
                                             {"says", word(m.says)},
                                             {"warns", word(m.warns)},
                                             {"guard", word(m.guard)}});
                                 }}});
    for (const char* key : {"name", "group", "scene", "must"})
      if (!seen.count(key)) bad(n, key, "missing; required");
    if (!m.guard.empty() && m.guard != "allowed" && std::ranges::count(kAlarmNames, m.guard) == 0)
      bad(n, "must.guard", "\"" + m.guard + "\" is no alarm of the guard, nor \"allowed\"");
    c.scene = (std::filesystem::path(path_).parent_path() / c.scene).string();
    places_.push_back(n);
    cases_.push_back(std::move(c));
  }

  void check_names() {
    std::set<std::string> names;
    for (std::size_t k = 0; k < cases_.size(); ++k)
      if (!names.insert(cases_[k].name).second)
        bad(places_[k], "name", cases_[k].name + " is given twice");
    for (std::size_t k = 0; k < cases_.size(); ++k)
      if (!cases_[k].must.like.empty() && !names.count(cases_[k].must.like))
        bad(places_[k], "must.like", "there is no case " + cases_[k].must.like);
  }

  std::vector<StabilityCase> cases_;
  std::vector<Node> places_;
};

}  // namespace

std::vector<StabilityCase> read_stability_suite(const std::string& path) {
  return SuiteReader(path).read();
}

}  // namespace pbf::campaign_module
