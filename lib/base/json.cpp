#include "lib/base/json.h"

#include <nlohmann/json.hpp>

#include "lib/base/plain_text.h"

namespace pbf::base_module {
namespace {

void only_utf8(Json& value) {
  if (value.is_string()) value = utf8(value.get_ref<const std::string&>());
  if (value.is_structured())
    for (Json& item : value) only_utf8(item);
}

}  // namespace

std::string json_text(Json value, int indent) {
  only_utf8(value);
  return value.dump(indent, ' ', true);
}

}  // namespace pbf::base_module
