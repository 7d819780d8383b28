// Study files: YAML in, members out.
#include <algorithm>
#include <filesystem>
#include <functional>
#include <set>

#include "lib/base/error.h"
#include "lib/diag/study.h"
#include "lib/scene/load.h"
#include "lib/scene/number.h"
#include "lib/scene/overrides.h"
#include "lib/scene/value.h"

namespace pbf {
namespace {

namespace fs = std::filesystem;
using Kind = Node::Kind;

constexpr std::size_t kMostMembers = 10000;

/// A value as the study file has it, on one line.
std::string text_of(const Node& node) {
  if (node.kind == Kind::scalar) return node.text;
  std::string out;
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    if (i > 0) out += ", ";
    if (node.kind == Kind::map) out += text_of(node.keys[i]) + ": ";
    out += text_of(node.items[i]);
  }
  if (node.kind == Kind::null) return "off";
  std::string text = node.kind == Kind::map ? "{" : "[";
  text += out;
  return text += node.kind == Kind::map ? "}" : "]";
}

/// Keys of the scene with one value each.
using Settings = std::vector<std::pair<std::string, Node>>;

/// Keys that vary together: values[k] is what keys[k] goes through.
struct Axis {
  std::vector<std::string> keys;
  std::vector<std::vector<Node>> values;
};

struct Variant {
  std::string name;
  Settings settings;
};

class Reader {
 public:
  Reader(Node root, const std::string& path) : root_(std::move(root)), path_(path) {}
  Study read(const std::vector<std::string>& overrides);

 private:
  void bad(const Node& at, const std::string& key, const std::string& what) {
    problems_.add(at.place(), key, what);
  }
  /// The map's entries by the function of their key; other keys are problems.
  using Entries = std::vector<std::pair<std::string, std::function<void(const Node&)>>>;
  void read_map(const Node& map, const std::string& block, const Entries& entries);
  void number(const Node& n, const std::string& key, double low, double high, double& out);
  void numbers(const Node& n, const std::string& key, double low, std::vector<double>& out);
  void text(const Node& n, const std::string& key, std::string& out);
  std::string file(const Node& n, const std::string& key);
  Settings settings(const Node& n, const std::string& key);
  void grid(const Node& n);
  void axis(const Node& n);
  void variants(const Node& n);
  void front(const Node& n);
  void make_members(const Node& scene, const std::vector<std::string>& overrides);
  StudyMember member(Node scene, const Settings& more);

  Node root_;
  std::string path_;
  Problems problems_;
  Study study_;
  std::string scene_path_;
  Settings base_, reference_;
  bool has_reference_ = false;
  std::vector<Axis> axes_;
  std::vector<Variant> variants_;
};

void Reader::read_map(const Node& map, const std::string& block, const Entries& entries) {
  if (map.kind != Kind::map)
    return bad(map, block, "is " + map.shown() + ", expected a block of keys");
  std::set<std::string> seen;
  for (std::size_t i = 0; i < map.items.size(); ++i) {
    const std::string key = text_of(map.keys[i]);
    const std::string full = block.empty() ? key : block + "." + key;
    const auto found =
        std::find_if(entries.begin(), entries.end(), [&](const auto& e) { return e.first == key; });
    if (found == entries.end()) {
      std::vector<std::string> names;
      for (const auto& e : entries) names.push_back(e.first);
      const std::string near = nearest_word(key, names);
      std::string all;
      for (const auto& name : names) all += (all.empty() ? "" : " ") + name;
      bad(map.keys[i], full,
          "unknown key, " +
              (near.empty() ? "the keys here are " + all : "did you mean " + near + "?"));
    } else if (!seen.insert(key).second) {
      bad(map.keys[i], full, "is given twice");
    } else {
      found->second(map.items[i]);
    }
  }
}

void Reader::number(const Node& n, const std::string& key, double low, double high, double& out) {
  double v = 0;
  const NumberError e = n.kind == Kind::scalar ? read_double(n.text, v) : NumberError::not_a_number;
  if (e != NumberError::none)
    bad(n, key, n.shown() + " " + describe(e));
  else if (v < low || v > high)
    bad(n, key, n.shown() + " is out of range, " + to_text(low) + " .. " + to_text(high));
  else
    out = v;
}

void Reader::numbers(const Node& n, const std::string& key, double low, std::vector<double>& out) {
  if (n.kind != Kind::list || n.items.empty())
    return bad(n, key, "is " + n.shown() + ", expected a list of numbers");
  out.assign(n.items.size(), 0);
  for (std::size_t i = 0; i < n.items.size(); ++i) number(n.items[i], key, low, 1e9, out[i]);
}

void Reader::text(const Node& n, const std::string& key, std::string& out) {
  if (n.kind != Kind::scalar || n.text.empty())
    return bad(n, key, "is " + n.shown() + ", expected text");
  out = n.text;
}

/// A path, taken from the folder of the study file.
std::string Reader::file(const Node& n, const std::string& key) {
  std::string name;
  text(n, key, name);
  return (fs::path(path_).parent_path() / name).string();
}

Settings Reader::settings(const Node& n, const std::string& key) {
  Settings out;
  if (n.kind != Kind::map) {
    bad(n, key,
        "is " + n.shown() + ", expected keys of the scene with values, {solver.iterations: 4}");
    return out;
  }
  for (std::size_t i = 0; i < n.items.size(); ++i) out.emplace_back(text_of(n.keys[i]), n.items[i]);
  return out;
}

void Reader::axis(const Node& n) {
  Axis axis;
  for (const auto& [key, values] : settings(n, "grid")) {
    if (values.kind != Kind::list || values.items.empty())
      return bad(values, "grid." + key,
                 "is " + values.shown() + ", expected the list of its values");
    if (!axis.values.empty() && values.items.size() != axis.values[0].size())
      return bad(values, "grid." + key,
                 "has " + std::to_string(values.items.size()) + " values, " + axis.keys[0] +
                     " beside it " + std::to_string(axis.values[0].size()) +
                     "; keys of one entry vary together");
    for (const Axis& other : axes_)
      for (const std::string& taken : other.keys)
        if (taken == key) return bad(values, "grid." + key, "is given twice");
    axis.keys.push_back(key);
    axis.values.push_back(values.items);
    study_.keys.push_back(key);
  }
  if (!axis.keys.empty()) axes_.push_back(axis);
}

void Reader::grid(const Node& n) {
  if (n.kind == Kind::list) {
    for (const Node& entry : n.items) axis(entry);
    return;
  }
  if (n.kind != Kind::map)
    return bad(n, "grid", "is " + n.shown() + ", expected keys of the scene with lists of values");
  for (std::size_t i = 0; i < n.items.size(); ++i) {
    Node one = n;  // every key of a block is an axis of its own
    one.keys = {n.keys[i]};
    one.items = {n.items[i]};
    axis(one);
  }
}

void Reader::variants(const Node& n) {
  if (n.kind != Kind::list || n.items.empty())
    return bad(n, "variants", "is " + n.shown() + ", expected a list of {name: ..., set: {...}}");
  study_.has_variants = true;
  for (const Node& entry : n.items) {
    Variant v;
    read_map(entry, "variants",
             {{"name", [&](const Node& at) { text(at, "variants.name", v.name); }},
              {"set", [&](const Node& at) { v.settings = settings(at, "variants.set"); }}});
    if (v.name.empty()) bad(entry, "variants", "has an entry without a name");
    for (const Variant& other : variants_)
      if (other.name == v.name) bad(entry, "variants", "has two entries named " + v.name);
    variants_.push_back(v);
  }
}

void Reader::front(const Node& n) {
  Front front;
  read_map(
      n, "front",
      {{"axis",
        [&](const Node& at) {
          front.axis = at.text == "x" ? 0 : at.text == "y" ? 1 : at.text == "z" ? 2 : -1;
          if (front.axis < 0) bad(at, "front.axis", "is " + at.shown() + ", expected x, y or z");
        }},
       {"origin", [&](const Node& at) { number(at, "front.origin", -1e12, 1e12, front.origin); }},
       {"length", [&](const Node& at) { number(at, "front.length", 1e-9, 1e9, front.length); }},
       {"factor", [&](const Node& at) { number(at, "front.factor", 1e-9, 1e9, front.factor); }},
       {"data", [&](const Node& at) {
          if (at.kind != Kind::list)
            return bad(at, "front.data", "is " + at.shown() + ", expected a list of files");
          for (const Node& item : at.items) {
            try {
              front.data.push_back(read_front_data(file(item, "front.data")));
            } catch (const Error& e) {
              bad(item, "front.data", e.what());
            }
          }
        }}});
  if (front.length == 0) bad(n, "front.length", "is missing: the width of the column, m");
  study_.front = front;
}

StudyMember Reader::member(Node scene, const Settings& more) {
  for (const auto& [key, value] : more) set_value(scene, key, value, problems_);
  StudyMember m;
  m.scene = scene_of_tree(scene, problems_);
  return m;
}

void Reader::make_members(const Node& scene, const std::vector<std::string>& overrides) {
  Node base = scene;
  for (const auto& [key, value] : base_) set_value(base, key, value, problems_);
  for (const std::string& o : overrides) apply_override(base, o, problems_);
  std::size_t count = std::max<std::size_t>(1, variants_.size());
  for (const Axis& a : axes_) {
    count *= a.values[0].size();
    if (count > kMostMembers)
      return problems_.add(path_, "grid",
                           "makes more than " + std::to_string(kMostMembers) + " runs");
  }
  if (variants_.empty()) variants_.emplace_back();
  for (const Variant& variant : variants_)
    for (std::size_t k = 0; k < count / variants_.size() && !problems_.full(); ++k) {
      Settings more = variant.settings;
      std::string label = variant.name;
      std::vector<std::string> values;
      std::size_t rest = k, block = count / variants_.size();
      for (const Axis& a : axes_) {  // the last axis runs fastest
        block /= a.values[0].size();
        const std::size_t at = rest / block;
        rest %= block;
        for (std::size_t key = 0; key < a.keys.size(); ++key) {
          more.emplace_back(a.keys[key], a.values[key][at]);
          values.push_back(text_of(a.values[key][at]));
        }
        label += (label.empty() ? "" : " ") + a.keys[0] + "=" + text_of(a.values[0][at]);
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

Study Reader::read(const std::vector<std::string>& overrides) {
  study_.path = path_;
  study_.name = fs::path(path_).stem().string();
  double repeats = study_.repeats;
  bool has_scene = false;
  read_map(root_, "",
           {{"name", [&](const Node& n) { text(n, "name", study_.name); }},
            {"scene",
             [&](const Node& n) {
               scene_path_ = file(n, "scene");
               has_scene = true;
             }},
            {"set", [&](const Node& n) { base_ = settings(n, "set"); }},
            {"variants", [&](const Node& n) { variants(n); }},
            {"grid", [&](const Node& n) { grid(n); }},
            {"repeats", [&](const Node& n) { number(n, "repeats", 1, 1000, repeats); }},
            {"clock",
             [&](const Node& n) {
               study_.cpu_clock = n.text == "cpu";
               if (n.text != "cpu" && n.text != "wall")
                 bad(n, "clock", "is " + n.shown() + ", expected wall or cpu");
             }},
            {"error", [&](const Node& n) { text(n, "error", study_.error); }},
            {"targets", [&](const Node& n) { numbers(n, "targets", 0, study_.targets); }},
            {"from", [&](const Node& n) { number(n, "from", 0, 1e9, study_.from); }},
            {"energy_limit",
             [&](const Node& n) { number(n, "energy_limit", 0, 1e9, study_.energy_limit); }},
            {"projection", [&](const Node& n) { numbers(n, "projection", 0, study_.projection); }},
            {"reference",
             [&](const Node& n) {
               reference_ = settings(n, "reference");
               has_reference_ = true;
             }},
            {"front", [&](const Node& n) { front(n); }}});
  study_.repeats = int(repeats);
  if (!has_scene)
    problems_.add(path_, "scene", "is missing: the scene to vary, a path from this file's folder");
  problems_.raise();
  study_.scene_dir = fs::path(scene_path_).parent_path().string();
  make_members(load_tree(scene_path_, "scene"), overrides);
  const auto known = study_error_measures(study_);
  if (std::find(known.begin(), known.end(), study_.error) == known.end()) {
    const std::string near = nearest_word(study_.error, known);
    std::string all;
    for (const auto& k : known) all += " " + k;
    problems_.add(root_.find("error")->place(), "error",
                  "\"" + study_.error + "\" is no measure of this study" +
                      (near.empty() ? "; there are" + all : ", did you mean " + near + "?"));
  }
  problems_.raise();
  for (const StudyMember& m : study_.members)
    if (study_.from >= m.scene.time.end)
      throw Error(ExitCode::bad_input, root_.find("from")->place() + ": from: " +
                                           to_text(study_.from) + " s is not before time.end (" +
                                           to_text(m.scene.time.end) + " s) of " + m.label);
  return study_;
}

}  // namespace

Study load_study(const std::string& path, const std::vector<std::string>& overrides) {
  return Reader(load_tree(path, "study"), path).read(overrides);
}

}  // namespace pbf
