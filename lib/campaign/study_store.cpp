// Stores results of members: the key that identifies a run, and JSON in both directions.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>

#include "lib/base/error.h"
#include "lib/base/json.h"
#include "lib/base/machine.h"
#include "lib/base/output_file.h"
#include "lib/base/sha256.h"
#include "lib/base/version.h"
#include "lib/campaign/study.h"
#include "lib/exec/devices.h"
#include "lib/io/run_layout.h"
#include "lib/run/emit.h"
#include "lib/run/linked_files.h"
#include "lib/scene/load.h"
#include "lib/scene/scene_files.h"

namespace pbf::campaign_module {
namespace {

/// Identifies the program: version and commit or, if these are not exact, a hash of its file.
std::string program_text() {
  const BuildInfo build = build_info();
  const std::string text = build.version + " " + build.commit;
  if (build.commit != "unknown" && build.commit.find('+') == std::string::npos) return text;
  std::ifstream in("/proc/self/exe", std::ios::binary);
  return text + sha256(std::string(std::istreambuf_iterator<char>(in), {}));
}

/// The members of a result, for reading and writing.
template <class Result, class F>
void for_each_member(Result& r, F&& f) {
  f("status", r.status);
  f("message", r.message);
  f("backend", r.backend);
  f("precision", r.precision);
  f("device", r.device);
  f("threads", r.threads);
  f("particles", r.particles);
  f("updates", r.updates);
  f("seconds", r.seconds);
}

[[noreturn]] void bad(const std::string& what) { throw Error(ExitCode::bad_input, what); }

void expect(bool good, const Json& value, const std::string& key, const char* kind) {
  if (!good) bad(key + " is " + json_text(value) + ", expected " + kind);
}

void read(const Json& value, const std::string& key, std::string& out) {
  expect(value.is_string(), value, key, "text");
  out = value.get<std::string>();
}

void read(const Json& value, const std::string& key, std::int64_t& out) {
  out = value.is_number_integer() ? value.get<std::int64_t>() : -1;  // -1 also if it is too large
  expect(out >= 0, value, key, "a whole number not below 0");
}

/// null is NaN: an undefined measure.
void read(const Json& value, const std::string& key, double& out) {
  expect(value.is_null() || value.is_number(), value, key, "a number");
  out = value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

void read(const Json& value, const std::string& key, std::vector<double>& out) {
  expect(value.is_array(), value, key, "a list");
  for (const Json& item : value) read(item, key, out.emplace_back());
}

/// Checks that the log has all columns of run_member(), of equal length, and at least one row.
void check_log(const MemberResult& r, const Scene& scene) {
  const auto need = [&](const std::string& name) {
    if (!r.log.contains(name)) bad("log has no column " + name);
  };
  for (const auto& c : run_layout::log_columns()) need(c.name);
  for (const FurtherColumn& c : further_columns(scene)) need(c.name);
  const std::size_t rows = r.series("time").size();
  for (const auto& [name, column] : r.log)
    if (column.empty() || column.size() != rows)
      bad("log: column " + name + " has " + std::to_string(column.size()) + " rows, time has " +
          std::to_string(rows) + (column.empty() ? "; a run has one at least" : ""));
}

}  // namespace

std::string member_key(const Study& study, const StudyMember& m) {
  static const std::string program = program_text();
  Scene scene = m.scene;
  scene.name.clear();
  scene.compare.clear();  // what is compared and summed up changes no result
  scene.summary.clear(), scene.summary_from = 0;
  read_linked_files(scene, study.scene_dir);
  const Json key{"3",  // version of the format below
                 program,
                 about(m.scene.backend).on_device ? cuda_device_report() : cpu_model(),
                 usable_threads(),
                 resolved_yaml(scene),
                 files_text(StartPoints(scene, study.scene_dir).files()),
                 study.repeats,
                 study.cpu_clock};
  return sha256(json_text(key)).substr(0, 16);
}

void write_member(const std::string& path, const MemberResult& r) {
  Json object;
  for_each_member(r, [&](const char* name, const auto& value) { object[name] = value; });
  object["ratios"] = r.ratios;
  object["log"] = r.log;
  write_text_file(path, json_text(object) + "\n", Naming::own);
}

std::optional<MemberResult> read_member(const std::string& path, const Scene& scene) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return std::nullopt;
  try {
    std::ifstream in(path);
    const Json root = Json::parse(in);
    MemberResult r;
    for_each_member(r, [&](const char* name, auto& value) { read(root.at(name), name, value); });
    if (r.status != "finished" && r.status != "diverged")
      bad("status: \"" + r.status + "\" is neither finished nor diverged");
    if (!(r.seconds >= 0)) bad("seconds: not a time");
    read(root.at("ratios"), "ratios", r.ratios);
    for (const auto& [name, values] : root.at("log").items())
      read(values, "log." + name, r.log[name]);
    check_log(r, scene);
    return r;
  } catch (const std::exception& e) {  // of the library, and those above
    bad(path + ": " + e.what());
  }
}

}  // namespace pbf::campaign_module
