// Reads study files (YAML).
#include <algorithm>
#include <filesystem>

#include "lib/base/error.h"
#include "lib/base/text.h"
#include "lib/campaign/study_reader.h"
#include "lib/scene/load.h"
#include "lib/scene/suggest.h"

namespace pbf::campaign_module {
namespace fs = std::filesystem;
using Kind = Node::Kind;

void StudyReader::numbers(const Node& n, const std::string& key, double low,
                          std::vector<double>& out) {
  if (n.kind != Kind::list || n.items.empty())
    return bad(n, key, "is " + n.shown() + ", expected a list of numbers");
  out.assign(n.items.size(), 0);
  for (std::size_t i = 0; i < n.items.size(); ++i) number(key, low, 1e9, out[i])(n.items[i]);
}

void StudyReader::front(const Node& n) {
  Front front;
  read_map(n, "front",
           {{"axis",
             [&](const Node& at) {
               front.axis = at.text == "x" ? 0 : at.text == "y" ? 1 : at.text == "z" ? 2 : -1;
               if (front.axis < 0)
                 bad(at, "front.axis", "is " + at.shown() + ", expected x, y or z");
             }},
            {"origin", number("front.origin", -1e12, 1e12, front.origin)},
            {"length", number("front.length", 1e-9, 1e9, front.length)},
            {"factor", number("front.factor", 1e-9, 1e9, front.factor)},
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
                {"error", [&](const Node& n) { text(n, "error", study_.error); }},
                {"targets", [&](const Node& n) { numbers(n, "targets", 0, study_.targets); }},
                {"from", number("from", 0., 1e9, study_.from)},
                {"energy_limit", number("energy_limit", 0., 1e9, study_.energy_limit)},
                {"reference", [&](const Node& n) { reference_ = settings(n, "reference"); }},
                {"front", [&](const Node& n) { front(n); }}});
  if (!seen.contains("scene"))
    problems_.add(path_, "scene", "is missing: the scene to vary, a path from this file's folder");
  problems_.raise();
  study_.scene_dir = fs::path(scene_path_).parent_path().string();
  make_members(load_scene_tree(scene_path_, base_folder), overrides);
  const auto known = study_error_measures(study_);
  if (std::find(known.begin(), known.end(), study_.error) == known.end()) {
    const std::string near = nearest_word(study_.error, known);
    problems_.add(
        root_.find("error")->place(), "error",
        "\"" + study_.error + "\" is no measure of this study" +
            (near.empty() ? "; there are " + joined(known, " ") : ", did you mean " + near + "?"));
  }
  problems_.raise();
  for (const StudyMember& m : study_.members)
    if (study_.from >= m.scene.time.end)
      throw Error(ExitCode::bad_input, root_.find("from")->place() + ": from: " +
                                           to_text(study_.from) + " s is not before time.end (" +
                                           to_text(m.scene.time.end) + " s) of " + m.label);
  return study_;
}

Study load_study(const std::string& path, const std::vector<std::string>& overrides,
                 const std::string& base_folder) {
  return StudyReader(load_tree(path, "study"), path).read(overrides, base_folder);
}

}  // namespace pbf::campaign_module
