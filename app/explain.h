// Messages for a command line that CLI11 rejects.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace pbf::app_module {

/// CLI11's message, or a better one for unexpected arguments (unknown options and commands, a
/// second scene, a setting without --set), with a suggestion and where to find help.
std::string explain(const CLI::App& app, const CLI::ParseError& e);

}  // namespace pbf::app_module
