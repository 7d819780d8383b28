// pbf probe: gauges on the frames of a finished run.
#include <fmt/core.h>

#include "app/commands.h"
#include "app/options.h"
#include "lib/base/inputs.h"
#include "lib/base/log.h"
#include "lib/base/output_file.h"
#include "lib/base/plain_text.h"
#include "lib/data/probe.h"
#include "lib/io/run_path.h"
#include "lib/run/load_run.h"

namespace pbf::app_module {
namespace {

struct ProbeOptions {
  std::string run, gauges, out;
};

const char* const kProbeHelp =
    "Kinds level, line, velocity and flow of gauges (configs/README.md, \"Gauges\"), as in a "
    "scene:\n"
    "  gauges: [{name: H2, kind: level, at: [2.2, 0.5]}]\n"
    "A row per frame; columns have their units in their names (H2_m, U_x_m_s, Q_kg_s, "
    "Q_total_kg),\n"
    "so the table is data for `compare` and pbf compare-data. Levels, lines and velocities are "
    "what the "
    "run\n"
    "itself would have read at these updates, to the precision of the frames. A flow is the net "
    "mass\n"
    "of what is on another side than in the frame before. Pressures and loads cannot be had: no\n"
    "frame holds what they come from.\n"
    "Example: pbf probe out/dam_break --gauges more.yaml -o probe.csv";

int command_probe(const ProbeOptions& o) {
  const std::string path = only_run_path(o.run);
  note_input(path);
  try_run_file(path);
  const RunReader file(path);
  const RunInfo info = file.info();
  Scene scene = scene_with_gauges(info, path, o.gauges);
  check_output("--out", o.out);
  read_files_of_run(scene, path, info.scene_path);
  const auto [table, units] = probe(file, scene);
  const std::string text = "# source: " + one_line("run " + o.run + ", gauges " + o.gauges, 1000) +
                           "\n# units: " + one_line(units, 100000) + "\n" + table.csv();
  Log log(false);
  if (o.out.empty()) {
    log.result(text.substr(0, text.size() - 1));
    return 0;
  }
  write_text_file(o.out, text);
  log.result(fmt::format("{}: {} gauges at {} frames", o.out, scene.gauges.size(), table.rows()));
  return 0;
}

}  // namespace

void add_probe(CLI::App& app, int& code) {
  const auto [c, o] = add_command(app, code, command_probe, "probe",
                                  "Gauges on the frames of a finished run", kProbeHelp);
  c->add_option("RUN", o.run, "A run: its run file or its folder")->required();
  c->add_option("--gauges", o.gauges, "YAML file with the key gauges")->required();
  c->add_option("-o,--out", o.out, "CSV file to write (default: stdout)");
}

}  // namespace pbf::app_module
