// Reads a study file: the runs that follow from its variants and grid (study_file.cpp), then what
// is reported of them (study_errors.cpp).
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lib/campaign/strict_reader.h"
#include "lib/campaign/study.h"

namespace pbf::campaign_module {

class StudyReader : StrictReader {
 public:
  StudyReader(Node root, const std::string& path) : StrictReader(path), root_(std::move(root)) {}
  /// As load_study().
  Study read(const std::vector<std::string>& overrides, const std::string& base_folder);

 private:
  void numbers(const Node& n, const std::string& key, double low, std::vector<double>& out);
  void axis(const Node& n);
  void grid(const Node& n);
  void variants(const Node& n);
  StudyMember member(Node scene, const Settings& more);
  void make_members(const Node& base);

  /// Of the value of a key, or of the file where it is not given.
  std::string place(const char* key) const;
  void front(const Node& n);
  void errors(const Node& n);
  void error(const Node& n);
  void motion_error(const Node& n);
  void make_reference(const Node& base);
  void take_member(const std::vector<std::size_t>& found, const std::string& what);
  std::vector<std::size_t> finest() const;
  std::vector<std::size_t> with_values(const Settings& values) const;
  void check_errors();
  void read_data();
  bool check_column(MotionError& e, const StudyMember& m);
  void check_times(const StudyMember& m);

  Node root_;
  Study study_;
  std::string scene_path_;
  Settings base_;
  GridAxis variants_;
  std::vector<std::optional<double>> limits_;  ///< energy_limit per variant
  std::vector<GridAxis> axes_;
};

}  // namespace pbf::campaign_module
