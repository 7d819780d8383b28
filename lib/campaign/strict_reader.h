// Shared code of the readers of study and suite files: blocks of known keys, texts, scene settings.
#pragma once

#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "lib/campaign/grid.h"
#include "lib/scene/number.h"
#include "lib/scene/problems.h"
#include "lib/scene/yaml_tree.h"

namespace pbf::campaign_module {

/// Collects problems, each with file, line, column and key.
class StrictReader {
 public:
  explicit StrictReader(const std::string& path) : path_(path) {}

 protected:
  void bad(const Node& at, const std::string& key, const std::string& what) {
    problems_.add(at.place(), key, what);
  }
  /// Calls the function of each key with its value. Unknown and repeated keys are problems, with
  /// the path "block.key". Returns the keys that are present.
  using Read = std::function<void(const Node&)>;
  using Entries = std::vector<std::pair<std::string, Read>>;
  std::set<std::string> read_map(const Node& map, const std::string& block, const Entries& entries);
  void text(const Node& n, const std::string& key, std::string& out);
  /// A path relative to the folder of the file that is read.
  std::string file(const Node& n, const std::string& key);
  Settings settings(const Node& n, const std::string& key);
  /// Reads a number from `low` to `high` into a number or an optional.
  template <class T>
  Read number(const std::string& key, T low, T high, auto& out) {
    return [=, this, &out](const Node& n) {
      std::conditional_t<std::is_integral_v<T>, std::int64_t, double> v = 0;
      const NumberError e =
          n.kind == Node::Kind::scalar ? read_number(n.text, v) : NumberError::not_a_number;
      if (e != NumberError::none)
        bad(n, key, n.shown() + " " + describe(e));
      else if (v < low || v > high)
        bad(n, key, n.shown() + " is out of range, " + to_text(low) + " .. " + to_text(high));
      else
        out = T(v);
    };
  }

  std::string path_;
  Problems problems_;
};

}  // namespace pbf::campaign_module
