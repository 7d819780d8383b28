// pbf info: this build and this machine.
#include <fmt/core.h>

#include "app/commands.h"
#include "lib/base/log.h"
#include "lib/base/machine.h"
#include "lib/base/text.h"
#include "lib/base/version.h"
#include "lib/exec/devices.h"
#include "lib/program/simd.h"

namespace pbf::app_module {

namespace {

int command_info() {
  const BuildInfo b = build_info();
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
  CLI::App* c = app.add_subcommand("info", "Version, build features, libraries, devices");
  c->footer("Example:\n  pbf info")->callback([&code] { code = command_info(); });
}

}  // namespace pbf::app_module
