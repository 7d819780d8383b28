// Lines of a run's summary about what comes, goes and floats.
#pragma once

#include <string>
#include <vector>

#include "lib/program/column.h"
#include "lib/solver/diagnostics.h"

namespace pbf::run_module {

/// What has come from each emitter and gone into each sink.
std::string emission_lines(const Diagnostics& last, const std::vector<ReadingColumn>& columns);
/// Where the free bodies are at the end.
std::string body_lines(const Diagnostics& last, const Scene& scene);

}  // namespace pbf::run_module
