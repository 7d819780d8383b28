// The commands of pbf.
#pragma once

#include <CLI/CLI.hpp>

namespace pbf::app_module {

/// Each function adds a command with its options to the command line. Parsing runs the given
/// command and stores its exit code in `code`; errors are thrown as Error.
void add_run(CLI::App& app, int& code);
void add_plan(CLI::App& app, int& code);
void add_render(CLI::App& app, int& code);
void add_compare(CLI::App& app, int& code);
void add_config(CLI::App& app, int& code);
void add_bench(CLI::App& app, int& code);
void add_study(CLI::App& app, int& code);
void add_batch(CLI::App& app, int& code);
void add_stability(CLI::App& app, int& code);
void add_info(CLI::App& app, int& code);

}  // namespace pbf::app_module
