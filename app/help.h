// The long texts of --help.
#pragma once

#include <string>

namespace pbf::inline app_module::help {

extern const char* const kExitCodes;
/// The measures of a run, a line each.
std::string diagnostics_text();
extern const char* const kPlanHelp;
extern const char* const kRenderHelp;
extern const char* const kCompareHelp;
extern const char* const kBenchHelp;
extern const char* const kBatchHelp;
extern const char* const kStabilityHelp;
extern const char* const kRunHelp;
extern const char* const kStudyHelp;
extern const char* const kStudyMeasures;

}  // namespace pbf::inline app_module::help
