// JSON Schema of a scene file, for completion and checks in editors.
#include <nlohmann/json.hpp>

#include "lib/base/json.h"
#include "lib/scene/base_scene.h"
#include "lib/scene/keys.h"
#include "lib/scene/load.h"
#include "lib/scene/number.h"
#include "lib/scene/value.h"

namespace pbf::scene_module {
namespace {

Json enumeration(const std::vector<std::string>& words) { return {{"enum", words}}; }

/// Type and range of one number of the key.
Json number_schema(const Key& key, bool whole) {
  Json out{{"type", whole ? "integer" : "number"}};
  const Range& r = key.range;
  if (std::isfinite(r.min))
    out[r.above_min ? "exclusiveMinimum" : "minimum"] = Json::parse(bound_text(key, r.min));
  if (std::isfinite(r.max))
    out[r.below_max ? "exclusiveMaximum" : "maximum"] = Json::parse(bound_text(key, r.max));
  return out;
}

Json list_schema(const Key& key, bool whole, int n) {
  const int least = key.flat == FlatY::none || n < 3 ? n : 2;
  return {{"type", "array"},
          {"items", number_schema(key, whole)},
          {"minItems", least},
          {"maxItems", n}};
}

struct TypeSchema {
  const Key& key;
  template <class T>
  Json operator()(const std::optional<T>*) const {
    return (*this)(static_cast<const T*>(nullptr));
  }
  template <class T>
  requires std::is_arithmetic_v<T> Json operator()(const T*) const {
    return number_schema(key, std::is_integral_v<T>);
  }
  template <class T, std::size_t N>
  Json operator()(const std::array<T, N>*) const {
    return list_schema(key, std::is_integral_v<T>, N);
  }
  Json operator()(const bool*) const { return {{"type", "boolean"}}; }
  Json operator()(const std::string*) const {
    return {{"type", "string"}, {"minLength", may_be_empty(key) ? 0 : 1}};
  }
  Json operator()(const std::vector<std::string>*) const {
    const Json free{{"type", "string"}, {"minLength", 1}};
    return {{"type", "array"},
            {"uniqueItems", true},
            {"items", key.choices.empty() ? free : enumeration(key.choices)}};
  }
  Json operator()(const std::vector<double>*) const {
    Json list = list_schema(key, false, 1);
    list["maxItems"] = key.most;
    return list;
  }
  Json operator()(const ChoiceField&) const { return enumeration(key.choices); }
};

Json default_value(const Key& key, const Field& field) {
  if (const auto* list = std::get_if<std::vector<std::string>*>(&field)) return **list;
  if (const auto* text = std::get_if<std::string*>(&field)) return **text;
  const std::string text = format_field(key, field);
  const bool word = text == "auto" || !(is_numeric(field) || std::holds_alternative<bool*>(field));
  return word ? Json(text) : Json::parse(text);  // numbers in YAML are JSON
}

Json form_schema(const Key& key);

Json key_schema(const Key& key) {
  const Field field = key.field(key.standard);
  const Json type = std::visit(TypeSchema{key}, field);
  const std::string unit = unit_text(key);
  Json out{{"description", key.help + (unit.empty() ? "" : " Unit: " + unit + ".")}};
  if (key.form != nullptr)
    out["anyOf"] = {type, {{"type", "number"}, {"minimum", 0}}, form_schema(key)};
  else if (key.automatic)
    out["anyOf"] = {{{"const", "auto"}}, type};
  else
    out.update(type);
  if (!key.required && !key.usually) out["default"] = default_value(key, field);
  return out;
}

/// Whether required keys must be present, or may come from a base.
enum class Extent { whole, part };

/// Object with the keys and blocks directly in `block`. kind < 0: the block has no kinds.
Json object_schema(const KeyTable& table, const Block& block, int kind, Extent extent);

/// Schema of the mapping that may replace a key's value.
Json form_schema(const Key& key) {
  const KeyTable& table = key.form();
  return object_schema(table, *table.find_block(key.leaf()), -1, Extent::whole);
}

/// One schema per kind, or a single one without kinds.
Json kinds_schema(const KeyTable& table, const Block& block, Extent extent) {
  Json kinds = Json::array();
  for (int k = 0; block.kind != nullptr && k < int(block.kind->choices.size()); ++k)
    kinds.push_back(object_schema(table, block, k, extent));
  if (kinds.empty()) return object_schema(table, block, -1, extent);
  return {{extent == Extent::whole ? "oneOf" : "anyOf", kinds}};  // a part may match several
}

Json block_schema(const KeyTable& table, const Block& block, Extent extent) {
  const Json object = kinds_schema(table, block, extent);
  if (!block.optional) return object;
  const Json words =
      table.has_required(block) ? Json{"off", false} : Json{"on", "off", true, false};
  return {{"description", block.help}, {"anyOf", {object, {{"enum", words}}}}};
}

Json list_schema(const KeyTable& table, const Block& block) {
  return {{"description", block.help + "."},
          {"type", "array"},
          {"minItems", block.list->unless.empty() ? block.list->least : 0},
          {"items", kinds_schema(table, block, Extent::whole)}};
}

Json object_schema(const KeyTable& table, const Block& block, int kind, Extent extent) {
  Json properties = Json::object(), required = Json::array(), corners = Json::array();
  for (const Key* key : block.keys) {
    if (kind >= 0 && !(key->kinds & (1u << kind))) continue;
    properties[key->leaf()] = key->is_kind
                                  ? Json{{"const", key->choices[static_cast<std::size_t>(kind)]}}
                                  : key_schema(*key);
    if (key->required) (key->by_center ? corners : required).push_back(key->leaf());
    if (!key->by_center) continue;
    Key middle = *key, edges = *key;
    middle.help = "Middle of the box, in place of min and max.";
    edges.help = "Edges of the box, with center.";
    edges.range = {0, 1e12, true};
    properties["center"] = key_schema(middle);
    properties["size"] = key_schema(edges);
  }
  for (const bool lists : {false, true})
    for (const Block& child : table.blocks) {
      if (bool(child.list) != lists || child.parent != &block) continue;
      properties[child.leaf()] =
          lists ? list_schema(table, child) : block_schema(table, child, extent);
      if (table.is_required(child)) required.push_back(child.leaf());
    }
  Json out{{"type", "object"}, {"additionalProperties", false}};
  if (block.parent != nullptr && !block.list) out["description"] = block.help;
  if (!required.empty() && extent == Extent::whole) out["required"] = required;
  if (!corners.empty())
    out["oneOf"] = {{{"required", corners}}, {{"required", {"center", "size"}}}};
  out["properties"] = properties;
  return out;
}

/// The requirements that Extent::part leaves out, for a scene without a base.
Json required_schema(const KeyTable& table, const Block& block) {
  Json children = Json::object(), blocks = Json::array(), kinds = Json::array();
  for (const Block& child : table.blocks) {
    if (child.parent != &block) continue;
    if (table.is_required(child)) blocks.push_back(child.leaf());
    if (child.list) continue;
    if (Json inner = required_schema(table, child); !inner.empty()) children[child.leaf()] = inner;
  }
  const auto of_kind = [&](int kind) {
    Json required = blocks, out = Json::object();
    for (const Key* key : block.keys)
      if (key->required && (kind < 0 || (key->kinds & (1u << kind))))
        required.push_back(key->leaf());
    if (!required.empty()) out["required"] = required;
    return out;
  };
  Json out = of_kind(-1);
  if (block.kind != nullptr) {
    for (int k = 0; k < int(block.kind->choices.size()); ++k) {
      kinds.push_back(of_kind(k));
      kinds.back()["properties"][block.kind->leaf()] = {
          {"const", block.kind->choices[std::size_t(k)]}};
    }
    out = {{"anyOf", kinds}};
  }
  if (!children.empty()) out["properties"] = children;
  return out;
}

}  // namespace

std::string schema_of(const KeyTable& table) {
  return json_text(object_schema(table, *table.find_block(""), -1, Extent::whole));
}

std::string json_schema() {
  Json out{{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "Scene of pbf"}};
  const Block& top = *scene_table().find_block("");
  out.update(object_schema(scene_table(), top, -1, Extent::part));
  out["properties"][kBaseKey] = {{"description", kBaseHelp}, {"type", "string"}, {"minLength", 1}};
  out["if"] = {{"required", {kBaseKey}}};
  out["else"] = required_schema(scene_table(), top);
  return json_text(out, 1) + "\n";
}

}  // namespace pbf::scene_module
