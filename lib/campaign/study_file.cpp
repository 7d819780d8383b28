// Reads study files (YAML), and makes the runs that follow from their variants and grid.
#include <algorithm>
#include <filesystem>
#include <optional>

#include "lib/base/error.h"
#include "lib/base/text.h"
#include "lib/campaign/study_reader.h"
#include "lib/run/linked_files.h"
#include "lib/scene/load.h"
#include "lib/scene/number.h"
#include "lib/scene/overrides.h"
#include "lib/scene/suggest.h"

namespace pbf::campaign_module {
namespace {

namespace fs = std::filesystem;
using Kind = Node::Kind;

constexpr std::size_t kMostMembers = 10000;

/// Limited because the search for duplicates is quadratic.
bool too_many(const Node& n) { return n.items.size() > kMostMembers; }

std::string too_many_text(const Node& n) {
  return "has " + std::to_string(n.items.size()) + " entries, at most " +
         std::to_string(kMostMembers) + " are possible; leave some out";
}

}  // namespace

Study StudyReader::read(const std::vector<std::string>& overrides, const std::string& base_folder) {
  study_.path = path_;
  study_.name = fs::path(path_).stem().string();
  if (const Node* gone = root_.find("projection")) {
    bad(*gone, "projection",
        "studies no longer measure the distance from the exact projection; the page "
        "lib/solver/DIAGNOSTICS.md has it. Remove the key");
    problems_.raise();
  }
  const auto seen =
      read_map(root_, "",
               {{"name",
                 [&](const Node& n) {
                   text(n, "name", study_.name);
                   if (!is_file_name(study_.name))
                     bad(n, "name",
                         "is " + n.shown() +
                             ", and tables are kept in out/study_<name>; give a word without "
                             "slashes, not . or ..");
                 }},
                {"scene", [&](const Node& n) { scene_path_ = file(n, "scene"); }},
                {"set", [&](const Node& n) { base_ = settings(n, "set"); }},
                {"variants", [&](const Node& n) { variants(n); }},
                {"grid", [&](const Node& n) { grid(n); }},
                {"repeats", number("repeats", 1, 1000, study_.repeats)},
                {"clock",
                 [&](const Node& n) {
                   study_.cpu_clock = n.text == "cpu";
                   if (n.text != "cpu" && n.text != "wall")
                     bad(n, "clock", "is " + n.shown() + ", expected wall or cpu");
                 }},
                {"error", [&](const Node& n) { errors(n); }},
                {"targets", [&](const Node& n) { numbers(n, "targets", 0, study_.targets); }},
                {"from", number("from", 0., 1e9, study_.from)},
                {"energy_limit", number("energy_limit", 0., 1e9, study_.energy_limit)},
                {"reference", [](const Node&) {}},  // make_reference(), which needs the members
                {"front", [&](const Node& n) { front(n); }}});
  if (!seen.contains("scene"))
    problems_.add(path_, "scene", "is missing: the scene to vary, a path from this file's folder");
  problems_.raise();
  study_.scene_dir = fs::path(scene_path_).parent_path().string();
  Node scene = load_scene_tree(scene_path_, base_folder);
  for (const auto& [key, value] : base_) set_value(scene, key, value, problems_);
  for (const std::string& o : overrides) apply_override(scene, o, problems_);
  make_members(scene);
  problems_.raise();
  make_reference(scene);
  problems_.raise();
  for (const StudyMember& m : study_.members)
    if (study_.from >= m.scene.time.end)
      bad_input(root_.find("from")->place() + ": from",
                to_text(study_.from) + " s is not before time.end (" + to_text(m.scene.time.end) +
                    " s) of " + m.label);
  read_data();
  check_errors();
  problems_.raise();
  return study_;
}

void StudyReader::numbers(const Node& n, const std::string& key, double low,
                          std::vector<double>& out) {
  if (n.kind != Kind::list || n.items.empty())
    return bad(n, key, "is " + n.shown() + ", expected a list of numbers");
  out.assign(n.items.size(), 0);
  for (std::size_t i = 0; i < n.items.size(); ++i) number(key, low, 1e9, out[i])(n.items[i]);
}

void StudyReader::axis(const Node& n) {
  GridAxis axis;
  if (too_many(n)) return bad(n, "grid", too_many_text(n));
  for (const auto& [key, values] : settings(n, "grid")) {
    if (values.kind != Kind::list || values.items.empty())
      return bad(values, "grid." + key,
                 "is " + values.shown() + ", expected the list of its values");
    if (!axis.empty() && values.items.size() != axis.size())
      return bad(values, "grid." + key,
                 "has " + std::to_string(values.items.size()) + " values, " +
                     axis[0].settings[0].first + " beside it " + std::to_string(axis.size()) +
                     "; keys of one entry vary together");
    if (std::ranges::find(study_.keys, key) != study_.keys.end())
      return bad(values, "grid." + key, "is given twice");
    study_.keys.push_back(key);
    axis.resize(values.items.size());
    for (std::size_t k = 0; k < axis.size(); ++k) {
      if (axis[k].settings.empty()) axis[k].name = key + "=" + setting_text(values.items[k]);
      axis[k].settings.emplace_back(key, values.items[k]);
    }
  }
  if (!axis.empty()) axes_.push_back(axis);
}

void StudyReader::grid(const Node& n) {
  if (too_many(n)) return bad(n, "grid", too_many_text(n));
  if (n.kind == Kind::list) {
    for (const Node& entry : n.items) axis(entry);
    return;
  }
  if (n.kind != Kind::map)
    return bad(n, "grid", "is " + n.shown() + ", expected keys of the scene with lists of values");
  for (std::size_t i = 0; i < n.items.size(); ++i) {
    Node one = n.keys[i];  // every key of a block is an axis of its own
    one.kind = Kind::map;
    one.keys = {n.keys[i]};
    one.items = {n.items[i]};
    axis(one);
  }
}

void StudyReader::variants(const Node& n) {
  if (n.kind != Kind::list || n.items.empty())
    return bad(n, "variants", "is " + n.shown() + ", expected a list of {name: ..., set: {...}}");
  if (too_many(n)) return bad(n, "variants", too_many_text(n));
  study_.has_variants = true;
  for (const Node& entry : n.items) {
    GridStep v;
    std::optional<double>& limit = limits_.emplace_back();
    read_map(entry, "variants",
             {{"name", [&](const Node& at) { text(at, "variants.name", v.name); }},
              {"set", [&](const Node& at) { v.settings = settings(at, "variants.set"); }},
              {"energy_limit", number("variants.energy_limit", 0., 1e9, limit)}});
    if (v.name.empty()) bad(entry, "variants", "has an entry without a name");
    for (const GridStep& other : variants_)
      if (other.name == v.name) bad(entry, "variants", "has two entries named " + v.name);
    variants_.push_back(v);
  }
}

StudyMember StudyReader::member(Node scene, const Settings& more) {
  for (const auto& [key, value] : more) set_value(scene, key, value, problems_);
  StudyMember m;
  const bool fine = problems_.empty();
  bool auto_step = false;
  m.scene = scene_of_tree(scene, problems_, &auto_step);
  if (auto_step && fine && problems_.empty()) read_linked_files(m.scene, study_.scene_dir, true);
  if (m.scene.time.adaptive)
    problems_.add(path_, "time.adaptive",
                  "a study compares steps that stay as they are; add time.adaptive: off to `set`");
  return m;
}

void StudyReader::make_members(const Node& base) {
  if (variants_.empty()) variants_.emplace_back(), limits_.emplace_back();
  axes_.insert(axes_.begin(), variants_);
  for (const GridMember& m : grid_members(axes_, kMostMembers, path_ + ": grid")) {
    if (problems_.full()) break;
    StudyMember& made = study_.members.emplace_back(member(base, m.settings));
    made.variant = variants_[m.at[0]].name;
    made.energy_limit = limits_[m.at[0]].value_or(study_.energy_limit);
    for (std::size_t k = m.settings.size() - study_.keys.size(); k < m.settings.size(); ++k)
      made.values.push_back(setting_text(m.settings[k].second));
    made.label = m.name.empty() ? study_.name : m.name;
  }
  for (const StudyMember& m : study_.members)
    if (study_.cpu_clock && about(m.scene.backend).on_device)
      problems_.add(root_.find("clock")->place(), "clock",
                    "cpu does not count the time of a GPU (" + m.label + "); use wall");
}

Study load_study(const std::string& path, const std::vector<std::string>& overrides,
                 const std::string& base_folder) {
  return StudyReader(load_tree(path, "study"), path).read(overrides, base_folder);
}

}  // namespace pbf::campaign_module
