// JSON Schema of a scene file, for editors that complete and check while one types.
#include <algorithm>

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
  const Field field = key.field(key.standard);
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

/// Object with the keys and blocks that stand directly in `block`. kind < 0: of no kind.
std::string object_schema(const KeyTable& table, const Block& block, int kind);

std::string block_schema(const KeyTable& table, const Block& block) {
  const std::string object = object_schema(table, block, -1);
  if (!block.optional) return object;
  return "{\"description\":" + json_string(block.help) + ",\"anyOf\":[" + object +
         ",{\"enum\":[\"on\",\"off\",true,false]}]}";
}

std::string list_schema(const KeyTable& table, const Block& block) {
  std::string items;
  if (block.kind != nullptr) {
    for (std::size_t k = 0; k < block.kind->choices.size(); ++k)
      items.append(k > 0 ? "," : "").append(object_schema(table, block, static_cast<int>(k)));
    items = "{\"oneOf\":[" + items + "]}";
  } else {
    items = object_schema(table, block, -1);
  }
  return "{\"description\":" + json_string(block.help + ".") +
         ",\"type\":\"array\",\"minItems\":" + std::to_string(block.list->least) +
         ",\"items\":" + items + "}";
}

std::string object_schema(const KeyTable& table, const Block& block, int kind) {
  std::string properties, required;
  const auto property = [&properties](const std::string& name, const std::string& schema) {
    properties += (properties.empty() ? "" : ",\n") + json_string(name) + ":" + schema;
  };
  const auto require = [&required](const std::string& name) {
    required.append(required.empty() ? "" : ",").append(json_string(name));
  };
  for (const Key* key : block.keys) {
    if (kind >= 0 && !(key->kinds & (1u << kind))) continue;
    property(key->leaf(),
             key->is_kind
                 ? "{\"const\":" + json_string(key->choices[static_cast<std::size_t>(kind)]) + "}"
                 : key_schema(*key));
    if (key->required) require(key->leaf());
  }
  for (const Block& child : table.blocks) {
    if (child.list || child.parent != &block) continue;
    property(child.leaf(), block_schema(table, child));
    if (std::any_of(child.keys.begin(), child.keys.end(), [](auto* key) { return key->required; }))
      require(child.leaf());
  }
  for (const Block& child : table.blocks) {
    if (!child.list || child.parent != &block) continue;
    property(child.leaf(), list_schema(table, child));
    if (child.list->least > 0) require(child.leaf());
  }
  std::string text = "{\"type\":\"object\",\"additionalProperties\":false";
  if (block.parent != nullptr && !block.list) text += ",\"description\":" + json_string(block.help);
  if (!required.empty()) text += ",\"required\":[" + required + "]";
  return text + ",\"properties\":{\n" + properties + "}}";
}

}  // namespace

std::string schema_of(const KeyTable& table) {
  return object_schema(table, *table.find_block(""), -1);
}

std::string json_schema() {
  const std::string object = schema_of(scene_table());
  return "{\"$schema\":\"https://json-schema.org/draft/2020-12/schema\",\"title\":\"Scene of "
         "pbf\"," +
         object.substr(1) + "\n";
}

}  // namespace pbf::inline scene_module
