// A study's variants and grid, and the runs that they make.
#include <algorithm>

#include "lib/campaign/study_reader.h"
#include "lib/scene/load.h"
#include "lib/scene/overrides.h"

namespace pbf::inline campaign_module {
namespace {

constexpr std::size_t kMostMembers = 10000;

/// Variants and keys of a grid are looked for among each other.
bool too_many(const Node& n) { return n.items.size() > kMostMembers; }

std::string too_many_text(const Node& n) {
  return "has " + std::to_string(n.items.size()) + " entries, at most " +
         std::to_string(kMostMembers) + " are possible; leave some out";
}

}  // namespace

using Kind = Node::Kind;

/// A value as the study file has it, on one line.
std::string study_text_of(const Node& node) {
  if (node.kind == Kind::scalar) return node.text;
  std::string out;
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    if (i > 0) out += ", ";
    if (node.kind == Kind::map) out += study_text_of(node.keys[i]) + ": ";
    out += study_text_of(node.items[i]);
  }
  if (node.kind == Kind::null) return "off";
  std::string text = node.kind == Kind::map ? "{" : "[";
  text += out;
  return text += node.kind == Kind::map ? "}" : "]";
}

void StudyReader::axis(const Node& n) {
  StudyAxis axis;
  if (too_many(n)) return bad(n, "grid", too_many_text(n));
  for (const auto& [key, values] : settings(n, "grid")) {
    if (values.kind != Kind::list || values.items.empty())
      return bad(values, "grid." + key,
                 "is " + values.shown() + ", expected the list of its values");
    if (!axis.values.empty() && values.items.size() != axis.values[0].size())
      return bad(values, "grid." + key,
                 "has " + std::to_string(values.items.size()) + " values, " + axis.keys[0] +
                     " beside it " + std::to_string(axis.values[0].size()) +
                     "; keys of one entry vary together");
    for (const StudyAxis& other : axes_)
      for (const std::string& taken : other.keys)
        if (taken == key) return bad(values, "grid." + key, "is given twice");
    axis.keys.push_back(key);
    axis.values.push_back(values.items);
    study_.keys.push_back(key);
  }
  if (!axis.keys.empty()) axes_.push_back(axis);
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
    StudyVariant v;
    read_map(entry, "variants",
             {{"name", [&](const Node& at) { text(at, "variants.name", v.name); }},
              {"set", [&](const Node& at) { v.settings = settings(at, "variants.set"); }}});
    if (v.name.empty()) bad(entry, "variants", "has an entry without a name");
    for (const StudyVariant& other : variants_)
      if (other.name == v.name) bad(entry, "variants", "has two entries named " + v.name);
    variants_.push_back(v);
  }
}

StudyMember StudyReader::member(Node scene, const StudySettings& more) {
  for (const auto& [key, value] : more) set_value(scene, key, value, problems_);
  StudyMember m;
  m.scene = scene_of_tree(scene, problems_);
  if (m.scene.time.adaptive)
    problems_.add(path_, "time.adaptive",
                  "a study compares steps that stay as they are; add time.adaptive: off to `set`");
  return m;
}

void StudyReader::make_members(const Node& scene, const std::vector<std::string>& overrides) {
  Node base = scene;
  for (const auto& [key, value] : base_) set_value(base, key, value, problems_);
  for (const std::string& o : overrides) apply_override(base, o, problems_);
  std::size_t count = std::max<std::size_t>(1, variants_.size());
  for (const StudyAxis& a : axes_) {
    count *= a.values[0].size();
    if (count > kMostMembers)
      return problems_.add(path_, "grid",
                           "makes more than " + std::to_string(kMostMembers) + " runs");
  }
  if (variants_.empty()) variants_.emplace_back();
  for (const StudyVariant& variant : variants_)
    for (std::size_t k = 0; k < count / variants_.size() && !problems_.full(); ++k) {
      StudySettings more = variant.settings;
      std::string label = variant.name;
      std::vector<std::string> values;
      std::size_t rest = k, block = count / variants_.size();
      for (const StudyAxis& a : axes_) {  // the last axis runs fastest
        block /= a.values[0].size();
        const std::size_t at = rest / block;
        rest %= block;
        for (std::size_t key = 0; key < a.keys.size(); ++key) {
          more.emplace_back(a.keys[key], a.values[key][at]);
          values.push_back(study_text_of(a.values[key][at]));
        }
        label += (label.empty() ? "" : " ") + a.keys[0] + "=" + study_text_of(a.values[0][at]);
      }
      study_.members.push_back(member(base, more));
      study_.members.back().variant = variant.name;
      study_.members.back().values = values;
      study_.members.back().label = label.empty() ? study_.name : label;
    }
  for (const StudyMember& m : study_.members)
    if (study_.cpu_clock && m.scene.backend == Backend::cuda)
      problems_.add(root_.find("clock")->place(), "clock",
                    "cpu does not count the time of a GPU (" + m.label + "); use wall");
  if (has_reference_) {
    study_.reference = member(base, reference_);
    study_.reference->label = "reference";
  }
}

}  // namespace pbf::inline campaign_module
