// pbf compare-data: readings of a finished run beside measurements.
#include <nlohmann/json.hpp>
#include <set>

#include "app/commands.h"
#include "app/options.h"
#include "lib/base/inputs.h"
#include "lib/base/json.h"
#include "lib/base/log.h"
#include "lib/data/comparison.h"
#include "lib/io/run_path.h"
#include "lib/run/load_run.h"

namespace pbf::app_module {
namespace {

struct CompareDataOptions {
  std::string run, data;
  std::vector<std::string> gauges, loads, logs;  ///< READING=COLUMN
  Comparison shared;                             ///< what all of them have
  std::string time_scale, scale, threshold;      ///< numbers; empty: auto
  std::vector<double> between, lag_range;        ///< two numbers; empty: auto
  bool json = false;
};

const char* const kCompareDataHelp =
    "RMS, bias, correlation, peak, time of arrival and impulse of readings beside measured ones, "
    "at\n"
    "the measured times. The data is a CSV table with a column of times, or another run. Units "
    "come\n"
    "from the ends of columns' names (t_ms, H2_mm, F_kN); one without needs --scale or "
    "--time-scale.\n"
    "Without --data the comparisons of the run's scene (key compare) are made again.\n"
    "Exit code 2 if something cannot be compared; nothing is ever nan.\n"
    "Examples:\n"
    "  pbf compare-data out/dam_break_over_box --data heights.csv --gauge H2=H2_m --gauge H4\n"
    "  pbf compare-data out/post --data force.csv --load post/x=F_N --average 0.02 --lag fit \\\n"
    "      --lag-range=-0.2,0.2\n"
    "  pbf compare-data out/coarse --data out/fine --log front_x --json";

/// "H2=H2_m": the reading and its column.
std::pair<std::string, std::string> parts(const std::string& text) {
  const std::size_t at = text.find('=');
  return {text.substr(0, at), at == text.npos ? "" : text.substr(at + 1)};
}

std::optional<double> number(const std::string& text, const char* option) {
  if (text.empty()) return std::nullopt;
  double value = 0;
  if (read_number(text, value) != NumberError::none)
    throw Error(ExitCode::bad_input, std::string(option) + ": \"" + text + "\" is not a number");
  return value;
}

std::vector<Comparison> entries(const CompareDataOptions& o) {
  std::vector<Comparison> all;
  Comparison shared = o.shared;
  shared.data = o.data;
  shared.time_scale = number(o.time_scale, "--time-scale");
  shared.scale = number(o.scale, "--scale");
  shared.threshold = number(o.threshold, "--threshold");
  const auto span = [](const std::vector<double>& v) {
    return v.size() == 2 ? std::optional(Comparison::Span{v[0], v[1]}) : std::nullopt;
  };
  shared.between = span(o.between), shared.lag_range = span(o.lag_range);
  const auto add = [&](const char* option, const std::vector<std::string>& texts,
                       std::string Comparison::*which, bool vector) {
    for (const std::string& text : texts) {
      Comparison& c = all.emplace_back(shared);
      std::tie(c.*which, c.column) = parts(text);
      c.place.text = std::string(option) + " " + text;
      const std::size_t slash = (c.*which).rfind('/');
      if (!vector || slash == std::string::npos) continue;
      c.component = (c.*which).substr(slash + 1);
      (c.*which).resize(slash);
    }
  };
  add("--gauge", o.gauges, &Comparison::gauge, true);
  add("--load", o.loads, &Comparison::load, true);
  add("--log", o.logs, &Comparison::log, false);
  if (all.empty())
    throw Error(ExitCode::bad_input,
                "--data " + o.data +
                    ": which reading? Give --gauge NAME, --load NAME/x or --log "
                    "COLUMN, each with =COLUMN of the data where it is named otherwise");
  std::set<std::string> names;
  for (const Comparison& c : all)
    if (!names.insert(name_of(c)).second)
      throw Error(ExitCode::bad_input,
                  c.place.text + ": " + name_of(c) + " is compared twice; give each a command");
  if ((shared.time_scale && !(*shared.time_scale > 0)) || !(shared.average >= 0))
    throw Error(ExitCode::bad_input, "--time-scale must be above 0, --average must not be below 0");
  for (const Comparison& c : all)
    if (const auto problem = problem_of(c, all))
      throw Error(ExitCode::bad_input, c.place.text + ": " + problem->key + " " + problem->what);
  return all;
}

int command_compare_data(const CompareDataOptions& o) {
  const std::string path = only_run_path(o.run);
  note_input(path);
  try_run_file(path);
  const RunReader file(path);
  const RunInfo info = file.info();
  std::vector<Comparison> wanted;
  std::string folder;
  if (o.data.empty()) {
    const Scene scene = parse_stored_scene(info.resolved_scene, path + ": its scene", {});
    wanted = scene.compare;
    if (wanted.empty())
      throw Error(ExitCode::bad_input, o.run +
                                           ": its scene compares nothing; give --data FILE "
                                           "and --gauge NAME");
    // Where the data was, if it is still there; else as for the other files of the scene.
    const std::vector<StoredComparison> stored = file.comparisons();
    for (Comparison& c : wanted)
      for (const StoredComparison& before : stored)
        if (const std::string there = text_of(before, "file");
            before.name == name_of(c) && std::filesystem::exists(there))
          c.data = there;
    if (std::ranges::any_of(wanted, [](const Comparison& c) {
          return !std::filesystem::path(c.data).is_absolute();
        }))
      folder = folder_of_files(scene, path, info.scene_path);
  } else {
    wanted = entries(o);
  }
  const std::vector<double> times = file.log_column("time");
  const std::vector<StoredComparison> results = compare_all(
      read_comparisons(wanted, readings_of(file), times.empty() ? 0 : times.back(), folder),
      [&](const Quantity& q) { return read_quantity(file, q); });
  std::string text = o.json ? json_text(comparisons_json(results)) : comparisons_text(results);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  Log(false).result(text);
  for (const StoredComparison& r : results)
    if (std::isnan(number_of(r, "rms")))
      throw Error(ExitCode::bad_input, r.name + " cannot be compared: " + note_of(r));
  return 0;
}

}  // namespace

void add_compare_data(CLI::App& app, int& code) {
  const auto [c, o] = add_command(app, code, command_compare_data, "compare-data",
                                  "Readings of a run beside measurements: RMS, lag, peak, impulse",
                                  kCompareDataHelp);
  c->add_option("RUN", o.run, "A run: its run file or its folder")->required();
  c->add_option("--data", o.data, "CSV table of measurements, or a reference run");
  add_repeatable(c, "--gauge", o.gauges, "GAUGE[/x][=COLUMN]: a gauge, x, y or z of a velocity");
  add_repeatable(c, "--load", o.loads, "SURFACE/x[=COLUMN]: also torque_x ..., force_peak");
  add_repeatable(c, "--log", o.logs, "COLUMN[=COLUMN]: a column of the log");
  c->add_option("--time-column", o.shared.time_column,
                "Column of times (default: the first named t or time)");
  c->add_option("--time-scale", o.time_scale, "Seconds of one unit of the times");
  c->add_option("--scale", o.scale, "The measured value is scale times the column plus offset");
  c->add_option("--offset", o.shared.offset, "In the unit of the reading");
  c->add_option("--average", o.shared.average, "s: both are averaged over such a window");
  c->add_option("--between", o.between, "FROM,TO: the measured times that count (s)")
      ->delimiter(',')
      ->expected(2);
  c->add_option("--lag", o.shared.lag,
                "none, fit, or a number of seconds by which the run is late");
  c->add_option("--lag-range", o.lag_range, "LEAST,LARGEST of --lag fit (s)")
      ->delimiter(',')
      ->expected(2);
  c->add_option("--threshold", o.threshold,
                "Value that is the arrival (default: a tenth of the "
                "way to the peak)");
  c->add_flag("--json", o.json, "Print one JSON object");
}

}  // namespace pbf::app_module
