// Where pbf run writes, and what is told of that before the run.
#pragma once

#include <string>

#include "lib/scene/load.h"

namespace pbf::inline app_module {

/// The run folder: `given` by --out; of a run that is resumed by its own file or folder that
/// folder; else out/<scene name>.
std::string run_place(const LoadedScene& loaded, const std::string& given, bool resume);

/// Error(bad_input) where the run would repeat itself into the folder that it is in.
void refuse_own_folder(const LoadedScene& loaded, const std::string& out);

/// What --resume says of a folder that is not there. `given`: by --out.
std::string not_there_note(const LoadedScene& loaded, const std::string& out, bool given);

/// Refuses --log-json where its folder is missing, or the run in `out` writes that file itself.
void check_log_json(const std::string& path, const std::string& out);

}  // namespace pbf::inline app_module
