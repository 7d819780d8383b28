// pbf info: this build and this machine.
#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/options.h"
#include "lib/base/json.h"
#include "lib/base/log.h"
#include "lib/base/machine.h"
#include "lib/base/text.h"
#include "lib/base/version.h"
#include "lib/exec/devices.h"
#include "lib/program/simd.h"

namespace pbf::app_module {

namespace {

struct InfoOptions {
  bool json = false;
};

/// The same as the lines, by their names.
std::string info_json(const BuildInfo& b) {
  Json libraries = Json::object(), usable = Json::array();
  for (const auto& [name, version] : b.libraries) libraries[name] = version;
  for (const Simd simd : usable_simd()) usable.push_back(simd_name(simd));
  return json_text({{"version", b.version},
                    {"commit", b.commit},
                    {"build", {{"type", b.type}, {"compiler", b.compiler}, {"flags", b.flags}}},
                    {"features", b.features},
                    {"libraries", libraries},
                    {"cpu", cpu_model()},
                    {"simd", {{"chosen", simd_name(chosen_simd())}, {"usable", usable}}},
                    {"threads", usable_threads()},
                    {"memory_available_bytes", available_memory()},
                    {"cuda", cuda_device_report()}});
}

int command_info(const InfoOptions& o) {
  const BuildInfo b = build_info();
  if (o.json) {
    Log(false).result(info_json(b));
    return 0;
  }
  std::string text = "pbf " + b.version + "\n";
  const auto line = [&](const std::string& name, const std::string& value) {
    text += fmt::format("{:12} {}\n", name, value);
  };
  std::string usable;
  for (const Simd simd : usable_simd()) usable.append(" ").append(simd_name(simd));
  line("commit", b.commit);
  line("build", b.type + ", " + b.compiler + ", " + b.flags);
  line("features", b.features);
  for (const auto& [name, version] : b.libraries) line(name, version);
  line("cpu", cpu_model());
  line("simd", std::string(simd_name(chosen_simd())) + ", of" + usable);
  line("threads", std::to_string(usable_threads()));
  line("memory", bytes_text(double(available_memory())) + " available");
  line("cuda", cuda_device_report());
  text.pop_back();
  Log(false).result(text);
  return 0;
}

}  // namespace

void add_info(CLI::App& app, int& code) {
  const auto [c, o] =
      add_command(app, code, command_info, "info", "Version, build features, libraries, devices",
                  "Examples:\n  pbf info\n  pbf info --json");
  c->add_flag("--json", o.json, "Print one JSON object");
}

}  // namespace pbf::app_module
