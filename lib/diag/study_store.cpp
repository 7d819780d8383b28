// Results of members on disk: what makes two runs the same, and JSON both ways.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>

#include "lib/base/error.h"
#include "lib/base/hash.h"
#include "lib/base/text.h"
#include "lib/base/version.h"
#include "lib/diag/study_member.h"
#include "lib/io/report.h"
#include "lib/scene/load.h"
#include "lib/scene/number.h"
#include "lib/solver/devices.h"

namespace pbf {
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

double number_of(const Node& n) {
  double v = std::numeric_limits<double>::quiet_NaN();
  if (n.kind == Node::Kind::null) return v;
  const NumberError e =
      n.kind == Node::Kind::scalar ? read_double(n.text, v) : NumberError::not_a_number;
  if (e == NumberError::too_small) return 0;
  if (e != NumberError::none) bad(n, n.shown() + " " + describe(e));
  return v;
}

std::vector<double> numbers_of(const Node& n) {
  if (n.kind != Node::Kind::list) bad(n, "is " + n.shown() + ", expected a list");
  std::vector<double> out;
  for (const Node& item : n.items) out.push_back(number_of(item));
  return out;
}

Node& child(Node& n, const std::string& key) {
  Node* found = n.find(key);
  if (!found) bad(n, "has no " + key);
  return *found;
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
  write_text_file(path, object.text() + "\n");
}

std::optional<MemberResult> read_member(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return std::nullopt;
  Node root = load_tree(path, "result of a study");  // JSON is YAML
  MemberResult r;
  for_each_text(r, [&](const char* name, std::string& v) { v = child(root, name).text; });
  for_each_integer(r, [&](const char* name, std::int64_t& v) {
    v = std::llround(number_of(child(root, name)));
  });
  for_each_number(r, [&](const char* name, double& v) { v = number_of(child(root, name)); });
  r.ratios = numbers_of(child(root, "ratios"));
  Node& log = child(root, "log");
  for (std::size_t k = 0; k < log.items.size(); ++k) {
    r.names.push_back(log.keys[k].text);
    r.columns.push_back(numbers_of(log.items[k]));
  }
  return r;
}

}  // namespace pbf
