// Reads what a study reports of its runs: errors, the reference that motion is compared with,
// fronts.
#include <fmt/core.h>
#include <algorithm>

#include "lib/base/error.h"
#include "lib/base/text.h"
#include "lib/campaign/study_reader.h"
#include "lib/data/series.h"
#include "lib/program/schedule.h"
#include "lib/scene/number.h"
#include "lib/scene/suggest.h"
#include "lib/solver/diagnostics.h"

namespace pbf::campaign_module {
namespace {

constexpr const char* kGauge = "gauge/";

/// "did you mean energy?", or all of them.
std::string meant(const std::string& word, const std::vector<std::string>& words) {
  const std::string near = nearest_word(word, words);
  return near.empty() ? "; there are " + joined(words, " ") : ", did you mean " + near + "?";
}

/// Columns of the log that say something about motion; some runs have `work`.
std::vector<std::string> motion_columns() {
  std::vector<std::string> names;
  for (const Diagnostic& d : diagnostics()) names.push_back(d.name);
  names.push_back("work");
  return names;
}

std::string unit_of_column(const std::string& name) {
  for (const Diagnostic& d : diagnostics())
    if (d.name == name) return d.unit;
  return "J";  // work
}

/// Texts of the same value: 0.01 and 1e-2.
bool alike(const std::string& a, const std::string& b) {
  double x = 0, y = 0;
  if (read_number(a, x) == NumberError::none && read_number(b, y) == NumberError::none)
    return x == y;
  return a == b;
}

/// s: of a substep, which is the step of the physics.
double substep(const StudyMember& m) { return m.scene.time.step / m.scene.solver.substeps; }

/// Negative if a is finer than b: in space, then in time, then by iterations.
int finer(const StudyMember& a, const StudyMember& b) {
  const auto order = [](double x, double y) {
    return x < y * (1 - 1e-9) ? -1 : x > y * (1 + 1e-9);
  };
  if (const int d = order(a.scene.fluid.spacing, b.scene.fluid.spacing)) return d;
  if (const int d = order(substep(a), substep(b))) return d;
  return b.scene.solver.iterations - a.scene.solver.iterations;
}

/// s: when a run is measured.
std::vector<double> measured_times(const Scene& scene) {
  const Schedule schedule = make_schedule(scene);
  std::vector<double> times;
  for (std::int64_t k = 0; k < schedule.measures_until(schedule.updates); ++k)
    times.push_back(double(schedule.update_of_measure(k)) * scene.time.step);
  return times;
}

}  // namespace

std::string StudyReader::place(const char* key) const {
  const Node* n = root_.find(key);
  return n ? n->place() : path_;
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
               if (at.kind != Node::Kind::list)
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

void StudyReader::errors(const Node& n) {
  study_.errors.clear();
  if (n.kind != Node::Kind::list) return error(n);
  if (n.items.empty()) bad(n, "error", "is an empty list; name a measure, or remove the key");
  for (const Node& entry : n.items) error(entry);
}

void StudyReader::error(const Node& n) {
  if (n.kind == Node::Kind::map) return motion_error(n);
  if (n.kind != Node::Kind::scalar || n.text.empty())
    return bad(n, "error",
               "is " + n.shown() + ", expected a measure, {log: COLUMN} or {gauge: NAME}");
  if (std::ranges::find(study_.errors, n.text) != study_.errors.end())
    return bad(n, "error", n.text + " is given twice");
  study_.errors.push_back(n.text);
}

void StudyReader::motion_error(const Node& n) {
  MotionError e;
  std::string log, gauge;
  const auto seen = read_map(n, "error",
                             {{"log", [&](const Node& at) { text(at, "error.log", log); }},
                              {"gauge", [&](const Node& at) { text(at, "error.gauge", gauge); }}});
  if (seen.size() != 1)
    return bad(n, "error", "needs one of log and gauge in an entry; give each an entry of its own");
  if (log.empty() == gauge.empty()) return;  // a problem by now
  const std::vector<std::string> known = motion_columns();
  if (!log.empty() && std::ranges::find(known, log) == known.end())
    return bad(n, "error.log", "\"" + log + "\" is no column for errors" + meant(log, known));
  e.column = gauge.empty() ? log : kGauge + gauge;
  if (!log.empty()) e.unit = unit_of_column(log);
  if (std::ranges::find(study_.motion, e.column, &MotionError::column) != study_.motion.end())
    return bad(n, "error", e.column + " is given twice");
  study_.motion.push_back(e);
  study_.errors.push_back(e.relative());
}

std::vector<std::size_t> StudyReader::finest() const {
  std::vector<std::size_t> best;
  for (std::size_t k = 0; k < study_.members.size(); ++k) {
    const int d = best.empty() ? -1 : finer(study_.members[k], study_.members[best[0]]);
    if (d < 0) best.clear();
    if (d <= 0) best.push_back(k);
  }
  return best;
}

/// The members of that variant and with those values of the grid.
std::vector<std::size_t> StudyReader::with_values(const Settings& values) const {
  std::vector<std::size_t> found;
  for (std::size_t k = 0; k < study_.members.size(); ++k) {
    const StudyMember& m = study_.members[k];
    const bool has_all = std::ranges::all_of(values, [&](const auto& setting) {
      const std::string value = setting_text(setting.second);
      if (setting.first == "variant") return value == m.variant;
      const auto at = std::ranges::find(study_.keys, setting.first);
      return at != study_.keys.end() &&
             alike(value, m.values[std::size_t(at - study_.keys.begin())]);
    });
    if (has_all) found.push_back(k);
  }
  return found;
}

void StudyReader::take_member(const std::vector<std::size_t>& found, const std::string& what) {
  if (found.size() == 1) {
    study_.reference_member = found[0];
    study_.reference = study_.members[found[0]];
    return;
  }
  std::vector<std::string> labels;
  for (std::size_t k = 0; k < std::min<std::size_t>(found.size(), 3); ++k)
    labels.push_back(study_.members[found[k]].label);
  problems_.add(
      place("reference"), "reference",
      fmt::format("{} {} runs: {}{}; name one by its values, such as {{time.step: 0.001}}"
                  "{}",
                  what, found.size(), joined(labels, ", "), found.size() > 3 ? ", ..." : "",
                  study_.has_variants ? " and its variant: NAME" : ""));
}

void StudyReader::make_reference(const Node& base) {
  const Node* n = root_.find("reference");
  if (!n && study_.motion.empty()) return;
  study_.reference_key = place("reference") + ": reference";
  if (!n || n->is_word({"finest"})) {
    if (study_.members.size() < 2)
      return problems_.add(place("reference"), "reference",
                           "is the finest run, and there is only one; give its keys, "
                           "{time.step: 0.001}, or a grid");
    return take_member(finest(), "the finest is not one run but");
  }
  if (n->kind != Node::Kind::map)
    return bad(*n, "reference",
               "is " + n->shown() +
                   ", expected finest, or keys of the scene with values and "
                   "variant: NAME");
  Settings values = settings(*n, "reference");
  if (const auto found = with_values(values); !found.empty() && !values.empty())
    return take_member(found, "these values are those of");
  double limit = study_.energy_limit;
  Settings more;
  std::string variant;
  for (const auto& [key, value] : values) {
    if (key != "variant") continue;
    variant = setting_text(value);
    std::vector<std::string> names;
    for (const GridStep& v : variants_) names.push_back(v.name);
    const auto at = std::ranges::find(names, variant);
    if (at == names.end() || !study_.has_variants)
      return bad(value, "reference.variant",
                 "\"" + variant + "\" is no variant of this study" +
                     (study_.has_variants ? meant(variant, names) : ""));
    const auto k = std::size_t(at - names.begin());
    more = variants_[k].settings;
    limit = limits_[k].value_or(limit);
  }
  for (const auto& setting : values)
    if (setting.first != "variant") more.push_back(setting);
  study_.reference = member(base, more);
  study_.reference->variant = variant;
  study_.reference->energy_limit = limit;
  study_.reference->label = "reference";
}

/// A gauge, or the work, must be recorded by every run; other columns are.
bool StudyReader::check_column(MotionError& e, const StudyMember& m) {
  const bool gauge = e.column.rfind(kGauge, 0) == 0;
  if (!gauge && e.column != "work") return true;
  std::vector<std::string> gauges;
  for (const FurtherColumn& c : further_columns(m.scene)) {
    if (c.name == e.column) e.unit = c.unit;
    if (c.name == e.column) return true;
    if (c.name.rfind(kGauge, 0) == 0) gauges.push_back(c.name.substr(6));
  }
  const std::string name = gauge ? e.column.substr(6) : e.column;
  if (!gauge)
    problems_.add(place("error"), "error.log",
                  name + " is not in the log of " + m.label +
                      ", where nothing moves; remove it, or give the scene a motion");
  else
    problems_.add(place("error"), "error.gauge",
                  "\"" + name + "\" is no gauge of " + m.label +
                      (gauges.empty() ? ", which has none; add it to the scene under gauges"
                                      : meant(name, gauges)));
  return false;
}

/// Said before hours of runs, not after them.
void StudyReader::check_times(const StudyMember& m) {
  const auto own = measured_times(m.scene), there = measured_times(study_.reference->scene);
  const auto [times, common] = common_times({own, own}, {there, there}, {.from = study_.from});
  if (enough_points(common, times)) return;
  if (times < kFewestPoints)
    return problems_.add(
        place("reference"), "reference",
        fmt::format("{} is measured at {} times from {} s on, and a difference over time needs {}: "
                    "lower {}measure_every or `from`",
                    study_.reference_member ? study_.reference->label : "this run", times,
                    to_text(study_.from), kFewestPoints, study_.reference_member ? "" : "its "));
  problems_.add(place("error"), "error",
                fmt::format("{} can be compared at {} of the {} times from {} s on at which the "
                            "reference is measured; at least {} and half of them are needed: "
                            "lower measure_every or `from`, or let both have the same time.end",
                            m.label, common, times, to_text(study_.from), kFewestPoints));
}

void StudyReader::check_errors() {
  for (MotionError& e : study_.motion)  // one run that lacks a column is enough to say
    if (std::ranges::all_of(study_.members, [&](auto& m) { return check_column(e, m); }))
      check_column(e, *study_.reference);
  if (!study_.motion.empty())
    for (const StudyMember& m : study_.members) check_times(m);
  const auto known = study_error_measures(study_);
  for (const std::string& name : study_.errors)
    if (std::ranges::find(known, name) == known.end())
      problems_.add(place("error"), "error",
                    "\"" + name + "\" is no measure of this study" + meant(name, known));
}

}  // namespace pbf::campaign_module
