// What is said of a command line that CLI11 refuses.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace pbf::inline app_module {

/// CLI11's message, or a better one for arguments that nobody takes (unknown options and commands,
/// a second scene, a setting without --set), with what may have been meant and where to read on.
std::string explain(const CLI::App& app, const CLI::ParseError& e);

}  // namespace pbf::inline app_module
