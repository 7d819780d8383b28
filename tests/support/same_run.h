// Whether two run files hold the same run.
#pragma once

#include <filesystem>
#include <string>

namespace pbf::test {

/// Empty when every dataset of both files has the same shape and bytes, apart from the seconds of
/// the stages and the sessions (who ran it, and when); else the first one that differs.
std::string run_difference(const std::filesystem::path& a, const std::filesystem::path& b);

}  // namespace pbf::test
