// JSON by nlohmann/json; the members of an object stay in the order in which they were added.
// Sources that make or read JSON include <nlohmann/json.hpp>, headers only this one.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace pbf::base_module {

using Json = nlohmann::ordered_json;

/// The text of a value, on one line or with `indent` more blanks for each level. Always ASCII: a
/// byte that is not UTF-8 becomes an escape such as \x9b (plain_text.h). NaN and infinity, which
/// JSON lacks, become null.
std::string json_text(Json value, int indent = -1);

}  // namespace pbf::base_module
