// JSON Schema of a scene file, for editors that complete and check while one types.
#include "lib/base/text.h"
#include "lib/scene/keys.h"
#include "lib/scene/load.h"
#include "lib/scene/number.h"
#include "lib/scene/value.h"

namespace pbf::inline scene_module {
namespace {

std::string enumeration(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words)
    text.append(text.empty() ? "" : ",").append(json_string(word));
  return "\"enum\":[" + text + "]";
}

/// Type and range of one number of the key.
std::string number_schema(const Key& key, bool whole) {
  std::string text = whole ? "\"type\":\"integer\"" : "\"type\":\"number\"";
  const Range& r = key.range;
  if (r.min > -std::numeric_limits<double>::infinity())
    text += std::string(r.above_min ? ",\"exclusiveMinimum\":" : ",\"minimum\":") + to_text(r.min);
  if (r.max < std::numeric_limits<double>::infinity())
    text += std::string(r.below_max ? ",\"exclusiveMaximum\":" : ",\"maximum\":") + to_text(r.max);
  return text;
}

std::string list_schema(const Key& key, bool whole, int n) {
  const std::string count = std::to_string(n);
  return "\"type\":\"array\",\"items\":{" + number_schema(key, whole) + "},\"minItems\":" + count +
         ",\"maxItems\":" + count;
}

struct TypeSchema {
  const Key& key;
  std::string operator()(const double*) const { return number_schema(key, false); }
  std::string operator()(const std::optional<double>*) const { return number_schema(key, false); }
  std::string operator()(const int*) const { return number_schema(key, true); }
  std::string operator()(const std::int64_t*) const { return number_schema(key, true); }
  std::string operator()(const std::uint64_t*) const { return number_schema(key, true); }
  std::string operator()(const bool*) const { return "\"type\":\"boolean\""; }
  std::string operator()(const std::string*) const { return "\"type\":\"string\",\"minLength\":1"; }
  std::string operator()(const std::vector<std::string>*) const {
    return "\"type\":\"array\",\"uniqueItems\":true,\"items\":{" + enumeration(key.choices) + "}";
  }
  std::string operator()(const Double3*) const { return list_schema(key, false, 3); }
  std::string operator()(const std::optional<Double3>*) const { return list_schema(key, false, 3); }
  std::string operator()(const std::optional<std::array<double, 2>>*) const {
    return list_schema(key, false, 2);
  }
  std::string operator()(const std::array<int, 2>*) const { return list_schema(key, true, 2); }
  std::string operator()(const ChoiceField&) const { return enumeration(key.choices); }
};

std::string key_schema(const Key& key) {
  Scene scene = scene_with_all_blocks();
  Body body;
  const Field field = key.field(scene, body);
  const std::string type = std::visit(TypeSchema{key}, field);
  const std::string unit = unit_text(key);
  std::string text =
      "{\"description\":" + json_string(key.help + (unit.empty() ? "" : " Unit: " + unit + "."));
  text += key.automatic ? ",\"anyOf\":[{\"const\":\"auto\"},{" + type + "}]" : "," + type;
  if (!key.required) {
    // Lists of words are the only values whose YAML text is no JSON.
    std::string value = format_field(key, field);
    if (const auto* list = std::get_if<std::vector<std::string>*>(&field)) {
      value.clear();
      for (const std::string& word : **list)
        value.append(value.empty() ? "" : ",").append(json_string(word));
      value = std::string("[").append(value).append("]");
    } else if (!is_numeric(field) && !std::holds_alternative<bool*>(field)) {
      value = json_string(value);
    } else if (value == "auto") {
      value = "\"auto\"";
    }
    text += ",\"default\":" + value;
  }
  return text + "}";
}

/// Object with the keys and blocks that stand directly in `block`. shape < 0: not a body.
std::string object_schema(const std::string& block, int shape);

std::string block_schema(const Block& block) {
  const std::string object = object_schema(block.path, -1);
  if (!block.optional) return object;
  return "{\"description\":" + json_string(block.help) + ",\"anyOf\":[" + object +
         ",{\"enum\":[\"on\",\"off\",true,false]}]}";
}

std::string bodies_schema() {
  std::string shapes;
  for (std::size_t s = 0; s < shape_names().size(); ++s)
    shapes.append(s > 0 ? "," : "").append(object_schema("bodies[]", static_cast<int>(s)));
  return "{\"description\":\"Bodies of fluid.\",\"type\":\"array\",\"minItems\":1,\"items\":"
         "{\"oneOf\":[" +
         shapes + "]}}";
}

std::string object_schema(const std::string& block, int shape) {
  std::string properties, required;
  const auto property = [&properties](const std::string& name, const std::string& schema) {
    properties += (properties.empty() ? "" : ",\n") + json_string(name) + ":" + schema;
  };
  const auto require = [&required](const std::string& name) {
    required.append(required.empty() ? "" : ",").append(json_string(name));
  };
  for (const Key& key : scene_keys()) {
    if (key.block() != block) continue;
    if (shape >= 0 && !(key.shapes & (1u << shape))) continue;
    const bool is_shape = shape >= 0 && key.leaf() == "shape";
    property(key.leaf(),
             is_shape
                 ? "{\"const\":" + json_string(shape_names()[static_cast<std::size_t>(shape)]) + "}"
                 : key_schema(key));
    if (key.required) require(key.leaf());
  }
  for (const Block& child : scene_blocks()) {
    const std::size_t dot = child.path.rfind('.');
    const std::string parent = dot == std::string::npos ? "" : child.path.substr(0, dot);
    if (child.path.empty() || child.path == "bodies[]" || parent != block || shape >= 0) continue;
    const std::string leaf = child.path.substr(dot == std::string::npos ? 0 : dot + 1);
    property(leaf, block_schema(child));
    for (const Key& key : scene_keys())
      if (key.required && key.block() == child.path) {
        require(leaf);
        break;
      }
  }
  if (block.empty()) {
    property("bodies", bodies_schema());
    require("bodies");
  }
  std::string text = "{\"type\":\"object\",\"additionalProperties\":false";
  if (!block.empty() && shape < 0)
    text += ",\"description\":" + json_string(find_block(block)->help);
  if (!required.empty()) text += ",\"required\":[" + required + "]";
  return text + ",\"properties\":{\n" + properties + "}}";
}

}  // namespace

std::string json_schema() {
  const std::string object = object_schema("", -1);
  return "{\"$schema\":\"https://json-schema.org/draft/2020-12/schema\",\"title\":\"Scene of "
         "pbf\"," +
         object.substr(1) + "\n";
}

}  // namespace pbf::inline scene_module
