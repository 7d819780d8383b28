// Reader of study files: study_file.cpp reads the keys, study_grid.cpp makes the runs.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lib/campaign/strict_reader.h"
#include "lib/campaign/study.h"
#include "lib/scene/number.h"

namespace pbf::campaign_module {

class StudyReader : StrictReader {
 public:
  StudyReader(Node root, const std::string& path) : StrictReader(path), root_(std::move(root)) {}
  Study read(const std::vector<std::string>& overrides, const std::string& base_folder);

 private:
  /// Reads a number from `low` to `high`.
  template <class T>
  Read number(const std::string& key, T low, T high, T& out) {
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
  void numbers(const Node& n, const std::string& key, double low, std::vector<double>& out);
  void grid(const Node& n);
  void axis(const Node& n);
  void variants(const Node& n);
  void front(const Node& n);
  void make_members(const Node& scene, const std::vector<std::string>& overrides);
  StudyMember member(Node scene, const Settings& more);

  Node root_;
  Study study_;
  std::string scene_path_;
  Settings base_;
  std::optional<Settings> reference_;
  GridAxis variants_;
  std::vector<std::optional<double>> limits_;  ///< energy_limit per variant
  std::vector<GridAxis> axes_;
};

}  // namespace pbf::campaign_module
