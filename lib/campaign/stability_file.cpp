// Suite files: YAML in, cases out.
#include <filesystem>
#include <map>
#include <set>

#include "lib/base/error.h"
#include "lib/campaign/stability.h"
#include "lib/scene/load.h"
#include "lib/scene/number.h"
#include "lib/scene/value.h"

namespace pbf::inline campaign_module {
namespace {

using Read = std::function<void(const Node&)>;

class SuiteReader {
 public:
  explicit SuiteReader(const std::string& path) : path_(path) {}

  std::vector<StabilityCase> read() {
    const Node root = load_tree(path_, "stability suite");
    block(root, "", {{"cases", [&](const Node& list) {
                        if (list.kind != Node::Kind::list)
                          return problem(list, "cases", "expected a list of cases");
                        for (const Node& item : list.items) read_case(item);
                      }}});
    if (problems_.empty() && cases_.empty()) problem(root, "cases", "missing; required");
    check_names();
    problems_.raise();
    return std::move(cases_);
  }

 private:
  void problem(const Node& at, const std::string& key, const std::string& what) {
    problems_.add(at.place(), key, what);
  }

  /// Every key of a map by its reader; unknown and repeated ones are problems.
  std::set<std::string> block(const Node& map, const std::string& name,
                              const std::map<std::string, Read>& keys) {
    std::set<std::string> seen;
    if (map.kind != Node::Kind::map) {
      problem(map, name, "expected a block of keys, got " + map.shown());
      return seen;
    }
    for (std::size_t i = 0; i < map.keys.size(); ++i) {
      const Node& key = map.keys[i];
      const auto at = keys.find(key.text);
      if (at == keys.end()) {
        std::vector<std::string> words;
        for (const auto& k : keys) words.push_back(k.first);
        const std::string near = nearest_word(key.text, words);
        problem(key, key.text,
                "unknown key" + (near.empty() ? "" : ", did you mean " + near + "?"));
      } else if (!seen.insert(key.text).second) {
        problem(key, key.text, "given twice");
      } else {
        at->second(map.items[i]);
      }
    }
    return seen;
  }

  Read text(std::string& out) {
    return [this, &out](const Node& n) {
      if (n.kind != Node::Kind::scalar || n.text.empty())
        return problem(n, "", "expected text, got " + n.shown());
      out = n.text;
    };
  }
  /// A number not below 0, into a double or an optional.
  template <class Out>
  Read number(Out& out) {
    return [this, &out](const Node& n) {
      double v = 0;
      if (n.kind != Node::Kind::scalar || read_double(n.text, v) != NumberError::none || v < 0)
        return problem(n, "", "expected a number not below 0, got " + n.shown());
      out = v;
    };
  }
  /// An exit code.
  Read exit_code(std::optional<int>& out) {
    return [this, &out](const Node& n) {
      std::int64_t v = 0;
      if (n.kind != Node::Kind::scalar || read_integer(n.text, v) != NumberError::none || v < 0 ||
          v > 255)
        return problem(n, "", "expected an exit code, 0 to 255, got " + n.shown());
      out = int(v);
    };
  }
  Read settings(std::vector<std::pair<std::string, Node>>& out) {
    return [this, &out](const Node& n) {
      if (n.kind != Node::Kind::map)
        return problem(n, "", "expected keys of the scene, {time.step: 0.01}, got " + n.shown());
      for (std::size_t i = 0; i < n.keys.size(); ++i) out.emplace_back(n.keys[i].text, n.items[i]);
    };
  }

  void read_case(const Node& n) {
    StabilityCase c;
    Criteria& m = c.must;
    const auto seen = block(n, "cases",
                            {{"name", text(c.name)},
                             {"group", text(c.group)},
                             {"about", text(c.about)},
                             {"scene", text(c.scene)},
                             {"set", settings(c.set)},
                             {"reduced", settings(c.small)},
                             {"must", [&](const Node& must) {
                                block(must, "must",
                                      {{"speed", number(m.speed)},
                                       {"energy", number(m.energy)},
                                       {"compression_mean", number(m.compression_mean)},
                                       {"compression_max", number(m.compression_max)},
                                       {"nearest", number(m.nearest)},
                                       {"still", number(m.still)},
                                       {"height", number(m.height)},
                                       {"momentum", number(m.momentum)},
                                       {"like", text(m.like)},
                                       {"error", exit_code(m.error)},
                                       {"says", text(m.says)},
                                       {"guard", text(m.guard)}});
                              }}});
    for (const char* key : {"name", "group", "scene", "must"})
      if (!seen.count(key)) problem(n, key, "missing; required");
    if (!m.guard.empty() && m.guard != "allowed") {
      bool known = false;
      for (const char* alarm : kAlarmNames) known = known || m.guard == alarm;
      if (!known)
        problem(n, "must.guard", "\"" + m.guard + "\" is no alarm of the guard, nor \"allowed\"");
    }
    c.scene = (std::filesystem::path(path_).parent_path() / c.scene).string();
    places_.push_back(n);
    cases_.push_back(std::move(c));
  }

  void check_names() {
    std::set<std::string> names;
    for (std::size_t k = 0; k < cases_.size(); ++k)
      if (!names.insert(cases_[k].name).second)
        problem(places_[k], "name", cases_[k].name + " is given twice");
    for (std::size_t k = 0; k < cases_.size(); ++k)
      if (!cases_[k].must.like.empty() && !names.count(cases_[k].must.like))
        problem(places_[k], "must.like", "there is no case " + cases_[k].must.like);
  }

  std::string path_;
  Problems problems_;
  std::vector<StabilityCase> cases_;
  std::vector<Node> places_;
};

}  // namespace

std::vector<StabilityCase> read_stability_suite(const std::string& path) {
  return SuiteReader(path).read();
}

}  // namespace pbf::inline campaign_module
