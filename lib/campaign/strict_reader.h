// Shared code of the readers of study and suite files: blocks of known keys, texts, scene settings.
#pragma once

#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "lib/campaign/grid.h"
#include "lib/scene/problems.h"
#include "lib/scene/yaml_tree.h"

namespace pbf::inline campaign_module {

/// Gathers what is wrong, each with file, line, column and key.
class StrictReader {
 public:
  explicit StrictReader(const std::string& path) : path_(path) {}

 protected:
  void bad(const Node& at, const std::string& key, const std::string& what) {
    problems_.add(at.place(), key, what);
  }
  /// The map's entries by the function of their key; other keys are problems, with the path
  /// "block.key", and so is a key that comes again. Returns the keys that are there.
  using Entries = std::vector<std::pair<std::string, std::function<void(const Node&)>>>;
  std::set<std::string> read_map(const Node& map, const std::string& block, const Entries& entries);
  void text(const Node& n, const std::string& key, std::string& out);
  /// A path, taken from the folder of the file that is read.
  std::string file(const Node& n, const std::string& key);
  Settings settings(const Node& n, const std::string& key);

  std::string path_;
  Problems problems_;
};

}  // namespace pbf::inline campaign_module
