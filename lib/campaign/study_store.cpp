// Results of members on disk: what makes two runs the same, and JSON both ways.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <limits>

#include "lib/base/error.h"
#include "lib/base/hash.h"
#include "lib/base/machine.h"
#include "lib/base/text.h"
#include "lib/base/version.h"
#include "lib/campaign/study_member.h"
#include "lib/exec/devices.h"
#include "lib/io/report.h"
#include "lib/io/run_layout.h"
#include "lib/scene/load.h"
#include "lib/scene/number.h"

namespace pbf::inline campaign_module {
namespace {

/// Names the program: version and commit, and where these do not, its bytes.
std::string program_text() {
  const BuildInfo build = build_info();
  std::string text = build.version + " " + build.commit;
  if (build.commit != "unknown" && build.commit.find('+') == std::string::npos) return text;
  Hash hash;
  hash.add_file("/proc/self/exe");
  return text += hash.text();
}

std::string numbers(const std::vector<double>& values) {
  std::string out = "[";
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) out += ",";
    out += json(Cell(values[i]));
  }
  return out += "]";
}

/// Of the members of a result: one list for both directions.
template <class Result, class F>
void for_each_text(Result& r, F&& f) {
  f("status", r.status);
  f("message", r.message);
  f("backend", r.backend);
  f("precision", r.precision);
  f("device", r.device);
}
template <class Result, class F>
void for_each_integer(Result& r, F&& f) {
  f("threads", r.threads);
  f("particles", r.particles);
  f("updates", r.updates);
}
template <class Result, class F>
void for_each_number(Result& r, F&& f) {
  f("seconds", r.seconds);
  f("projection_mean", r.projection_mean);
  f("projection_rms", r.projection_rms);
  f("projection_max", r.projection_max);
}

[[noreturn]] void bad(const Node& at, const std::string& what) {
  throw Error(ExitCode::bad_input, at.place() + ": " + what);
}

/// null is NaN: a measure that is not defined.
double number_of(const Node& n, const std::string& key) {
  double v = std::numeric_limits<double>::quiet_NaN();
  if (n.kind == Node::Kind::null) return v;
  const NumberError e =
      n.kind == Node::Kind::scalar ? read_double(n.text, v) : NumberError::not_a_number;
  if (e == NumberError::too_small) return 0;
  if (e != NumberError::none) bad(n, key + ": " + n.shown() + " " + describe(e));
  return v;
}

/// A count, not below 0.
std::int64_t whole_of(const Node& n, const std::string& key) {
  std::int64_t v = 0;
  const NumberError e =
      n.kind == Node::Kind::scalar ? read_integer(n.text, v) : NumberError::not_a_number;
  if (e != NumberError::none) bad(n, key + ": " + n.shown() + " " + describe(e));
  if (v < 0) bad(n, key + ": " + n.shown() + " is below 0");
  return v;
}

const std::string& text_of(const Node& n, const std::string& key) {
  if (n.kind != Node::Kind::scalar) bad(n, key + " is " + n.shown() + ", expected text");
  return n.text;
}

std::vector<double> numbers_of(const Node& n, const std::string& key) {
  if (n.kind != Node::Kind::list) bad(n, key + " is " + n.shown() + ", expected a list");
  std::vector<double> out;
  for (const Node& item : n.items) out.push_back(number_of(item, key));
  return out;
}

Node& child(Node& n, const std::string& key) {
  Node* found = n.kind == Node::Kind::map ? n.find(key) : nullptr;
  if (!found) bad(n, "has no " + key);
  return *found;
}

/// The log has every column that run_member() writes, of one length, and a row at least.
void check_log(const Node& log, const MemberResult& r) {
  for (const auto& c : run_layout::log_columns())
    if (std::find(r.names.begin(), r.names.end(), c.name) == r.names.end())
      bad(log, std::string("log has no column ") + c.name);
  for (std::size_t k = 0; k < r.names.size(); ++k) {
    const std::size_t n = r.columns[k].size();
    if (n == 0 || n != r.columns[0].size())
      bad(log, "log: column " + r.names[k] + " has " + std::to_string(n) + " rows, " + r.names[0] +
                   " has " + std::to_string(r.columns[0].size()) +
                   (n == 0 ? "; a run has one at least" : ""));
  }
}

}  // namespace

std::string member_key(const Study& study, const StudyMember& m) {
  Hash hash;
  hash.add("1");  // of the format below
  static const std::string program = program_text();
  hash.add(program);
  hash.add(m.scene.backend == Backend::cuda ? cuda_device_report() : cpu_model());
  hash.add(std::to_string(usable_threads()));
  Scene scene = m.scene;
  scene.name.clear();
  hash.add(resolved_yaml(scene));
  for (const Body& b : scene.bodies)
    if (b.shape == Shape::file)
      hash.add_file((std::filesystem::path(study.scene_dir) / b.path).string());
  hash.add(std::to_string(study.repeats));
  hash.add(study.cpu_clock ? "cpu" : "wall");
  hash.add(numbers(study.projection));
  return hash.text();
}

void write_member(const std::string& path, const MemberResult& r) {
  JsonObject object, log;
  for_each_text(r, [&](const char* name, const std::string& v) { object.add(name, v); });
  for_each_integer(r, [&](const char* name, std::int64_t v) { object.add(name, v); });
  for_each_number(r, [&](const char* name, double v) { object.add(name, v); });
  object.add_json("ratios", numbers(r.ratios));
  for (std::size_t k = 0; k < r.names.size(); ++k) log.add_json(r.names[k], numbers(r.columns[k]));
  object.add_json("log", log.text());
  write_text_file(path, object.text() + "\n", Naming::own);
}

std::optional<MemberResult> read_member(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return std::nullopt;
  Node root = load_tree(path, "result of a study");  // JSON is YAML
  MemberResult r;
  for_each_text(r, [&](const char* name, std::string& v) { v = text_of(child(root, name), name); });
  if (r.status != "finished" && r.status != "diverged")
    bad(child(root, "status"), "status: \"" + r.status + "\" is neither finished nor diverged");
  for_each_integer(
      r, [&](const char* name, std::int64_t& v) { v = whole_of(child(root, name), name); });
  for_each_number(r, [&](const char* name, double& v) { v = number_of(child(root, name), name); });
  if (!(r.seconds >= 0)) bad(child(root, "seconds"), "seconds: not a time");
  r.ratios = numbers_of(child(root, "ratios"), "ratios");
  Node& log = child(root, "log");
  if (log.kind != Node::Kind::map) bad(log, "log is " + log.shown() + ", expected columns");
  for (std::size_t k = 0; k < log.items.size(); ++k) {
    r.names.push_back(log.keys[k].text);
    r.columns.push_back(numbers_of(log.items[k], "log." + r.names.back()));
  }
  check_log(log, r);
  return r;
}

}  // namespace pbf::inline campaign_module
