// The commands of pbf.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace pbf::app_module {

/// Each function adds a command with its options to the command line. Parsing runs the given
/// command and stores its exit code in `code`; errors are thrown as Error.
void add_run(CLI::App& app, int& code);
void add_plan(CLI::App& app, int& code);
void add_render(CLI::App& app, int& code);
void add_compare(CLI::App& app, int& code);
void add_compare_data(CLI::App& app, int& code);
void add_probe(CLI::App& app, int& code);
void add_config(CLI::App& app, int& code);
void add_bench(CLI::App& app, int& code);
void add_study(CLI::App& app, int& code);
void add_batch(CLI::App& app, int& code);
void add_stability(CLI::App& app, int& code);
void add_info(CLI::App& app, int& code);
void add_serve_batch(CLI::App& app, int& code);  ///< not in the help: pbf batch starts it

/// How a command line ended.
struct Ending {
  int code = 0;
  std::string message{};  ///< of an error; empty: none
};
/// Does what the command line says, without an exception. words: without the name of the program.
Ending execute(const std::vector<std::string>& words);

/// For a command line that CLI11 rejects: its message, or a better one for unexpected arguments
/// (unknown options and commands, a second scene, a setting without --set), with a suggestion and
/// where to find help.
std::string explain(const CLI::App& app, const CLI::ParseError& e);

}  // namespace pbf::app_module
