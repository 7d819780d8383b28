// Collects all problems of a scene, so that one attempt shows all of them.
#pragma once

#include <string>
#include <unordered_set>
#include <vector>

#include "lib/base/error.h"
#include "lib/base/text.h"

namespace pbf::scene_module {

class Problems {
 public:
  /// Adds "place: key: what"; `key` may be empty. Duplicates, as from runs of a study, are dropped.
  void add(const std::string& place, const std::string& key, const std::string& what) {
    const std::string line = place + ": " + (key.empty() ? "" : key + ": ") + what;
    if (known_.insert(line).second && !full()) lines_.push_back(line);
  }

  bool empty() const { return lines_.empty(); }
  /// Whether further problems would not be shown, so that their texts can be short.
  bool full() const { return lines_.size() >= kShown; }

  /// Throws Error(bad_input) with one line per problem, if there is any; at most kShown lines,
  /// because a file that is no scene at all would fill the terminal.
  void raise() const {
    if (lines_.empty()) return;
    std::string text = joined(lines_, "\n");
    if (known_.size() > lines_.size())
      text += "\n... and " + std::to_string(known_.size() - lines_.size()) + " more problems";
    throw Error(ExitCode::bad_input, text);
  }

 private:
  static constexpr std::size_t kShown = 100;
  std::unordered_set<std::string> known_;
  std::vector<std::string> lines_;  ///< the first ones, to be shown
};

}  // namespace pbf::scene_module
