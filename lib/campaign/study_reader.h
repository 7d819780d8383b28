// What reads a study file: study_file.cpp its keys, study_grid.cpp the runs they make.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "lib/campaign/study.h"
#include "lib/scene/problems.h"
#include "lib/scene/yaml_tree.h"

namespace pbf::inline campaign_module {

/// A value as the study file has it, on one line.
std::string study_text_of(const Node& node);

/// Keys of the scene with one value each.
using StudySettings = std::vector<std::pair<std::string, Node>>;

/// Keys that vary together: values[k] is what keys[k] goes through.
struct StudyAxis {
  std::vector<std::string> keys;
  std::vector<std::vector<Node>> values;
};

struct StudyVariant {
  std::string name;
  StudySettings settings;
};

class StudyReader {
 public:
  StudyReader(Node root, const std::string& path) : root_(std::move(root)), path_(path) {}
  Study read(const std::vector<std::string>& overrides);

 private:
  void bad(const Node& at, const std::string& key, const std::string& what) {
    problems_.add(at.place(), key, what);
  }
  /// The map's entries by the function of their key; other keys are problems.
  using Entries = std::vector<std::pair<std::string, std::function<void(const Node&)>>>;
  void read_map(const Node& map, const std::string& block, const Entries& entries);
  void number(const Node& n, const std::string& key, double low, double high, double& out);
  void whole(const Node& n, const std::string& key, int low, int high, int& out);
  void numbers(const Node& n, const std::string& key, double low, std::vector<double>& out);
  void text(const Node& n, const std::string& key, std::string& out);
  std::string file(const Node& n, const std::string& key);
  StudySettings settings(const Node& n, const std::string& key);
  void grid(const Node& n);
  void axis(const Node& n);
  void variants(const Node& n);
  void front(const Node& n);
  void make_members(const Node& scene, const std::vector<std::string>& overrides);
  StudyMember member(Node scene, const StudySettings& more);

  Node root_;
  std::string path_;
  Problems problems_;
  Study study_;
  std::string scene_path_;
  StudySettings base_, reference_;
  bool has_reference_ = false;
  std::vector<StudyAxis> axes_;
  std::vector<StudyVariant> variants_;
};

}  // namespace pbf::inline campaign_module
