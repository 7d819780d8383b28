// Options that several commands share. Numbers are read as in scenes: "1e3" is 1000, "010" is ten,
// and "1.5" is not a whole number.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "lib/base/error.h"
#include "lib/scene/number.h"

namespace pbf::app_module {

/// Adds the command `name`; its options live as long as `app`. If the command is given, `code` is
/// set to the result of `work`.
template <class Options>
std::pair<CLI::App*, Options&> add_command(CLI::App& app, int& code, int (*work)(const Options&),
                                           const char* name, const char* help,
                                           const std::string& footer) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(name, help)->footer(footer);
  command->callback([options, work, &code] { code = work(*options); });
  return {command, *options};
}

/// The folder of the results of a command.
inline void make_folder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error)
    throw Error(ExitCode::io, path + ": the folder cannot be made: " + error.message() +
                                  "; choose another one with --out");
}

/// An option that can be given several times, with one value each.
inline void add_repeatable(CLI::App* command, const char* name, std::vector<std::string>& values,
                           const char* help) {
  command->add_option(name, values, help)->take_all()->allow_extra_args(false);
}

/// What a command that reads scenes is told about them.
struct SceneOptions {
  std::vector<std::string> overrides;  ///< key.path=value
  std::string base_folder;             ///< further folder below which bases may be
};

inline void add_scene_options(
    CLI::App* command, SceneOptions& options,
    const char* set = "Replace one key of the scene, KEY.PATH=VALUE; repeatable") {
  add_repeatable(command, "--set", options.overrides, set);
  command
      ->add_option(
          "--base-folder", options.base_folder,
          "Bases of a scene (base: other.yaml) may lie in the tree of this folder too, not "
          "only in that of the scene's own")
      ->check(CLI::ExistingDirectory);
}

inline void add_backend(CLI::App* command, std::string& backend, std::string& precision) {
  command->add_option("--backend", backend, "Where to run")
      ->check(CLI::IsMember(words_of<Backend>()));
  command->add_option("--precision", precision, "Of the computation")
      ->check(CLI::IsMember(words_of<Precision>()));
}

inline void add_quiet(CLI::App* command, bool& quiet) {
  command->add_flag("--quiet", quiet, "No progress on stderr");
}

/// For names of folders and files: "" usually comes from an unset variable in a script.
inline CLI::Validator not_empty() {
  return CLI::Validator(
      [](std::string& text) { return text.empty() ? "is empty; give a name" : std::string(); },
      "NAME");
}

/// For Option::transform: a whole number from `low` to `high`, converted to plain digits.
inline CLI::Validator whole_number(std::int64_t low,
                                   std::int64_t high = std::numeric_limits<int>::max()) {
  const std::string range = std::to_string(low) + " to " + std::to_string(high);
  return CLI::Validator(
      [low, high, range](std::string& text) -> std::string {
        std::int64_t v = 0;
        if (const NumberError e = read_number(text, v); e != NumberError::none)
          return "\"" + text + "\" " + describe(e) + "; give a whole number from " + range;
        if (v < low || v > high) return text + " is out of range, " + range;
        text = std::to_string(v);
        return "";
      },
      range);
}

/// For Option::transform: a number from `low` on (above it, if `above`), in `unit`.
inline CLI::Validator number_from(double low, bool above, const std::string& unit) {
  const std::string what = "a number" + (unit.empty() ? unit : " of " + unit) +
                           (above ? " above " : " from ") + to_text(low) + (above ? "" : " on");
  return CLI::Validator(
      [low, above, what](std::string& text) -> std::string {
        double v = 0;
        if (const NumberError e = read_number(text, v); e != NumberError::none)
          return "\"" + text + "\" " + describe(e) + "; give " + what;
        return v < low || (above && v <= low) ? text + " is not " + what : std::string();
      },
      what);
}

}  // namespace pbf::app_module
