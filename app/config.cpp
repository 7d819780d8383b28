// pbf config: the scene format, as an example with every key or as a JSON Schema.
#include "app/commands.h"
#include "lib/base/log.h"
#include "lib/scene/load.h"

namespace pbf::inline app_module {

int command_config(const ConfigOptions& options) {
  std::string text = options.schema ? json_schema() : reference_yaml();
  if (!text.empty() && text.back() == '\n') text.pop_back();  // result() ends the line
  Log(false).result(text);
  return 0;
}

}  // namespace pbf::inline app_module
