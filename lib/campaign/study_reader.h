// Reader of study files: study_file.cpp reads the keys, study_grid.cpp makes the runs.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lib/campaign/strict_reader.h"
#include "lib/campaign/study.h"

namespace pbf::inline campaign_module {

class StudyReader : StrictReader {
 public:
  StudyReader(Node root, const std::string& path) : StrictReader(path), root_(std::move(root)) {}
  Study read(const std::vector<std::string>& overrides, const std::string& base_folder);

 private:
  template <class T>
  void number(const Node& n, const std::string& key, T low, T high, T& out);
  void energy_limit(const Node& n, const std::string& key, double& out);
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
  Settings base_, reference_;
  bool has_reference_ = false;
  GridAxis variants_;
  std::vector<std::optional<double>> limits_;  ///< energy_limit per variant
  std::vector<GridAxis> axes_;
};

}  // namespace pbf::inline campaign_module
