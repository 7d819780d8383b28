// Texts about the rows of the table of keys.
#include "lib/base/text.h"
#include "lib/scene/keys.h"
#include "lib/scene/number.h"
#include "lib/scene/value.h"

namespace pbf::scene_module {
std::string unit_text(const Key& key) {
  return key.unit.empty() && is_numeric(key.field(key.standard)) ? "1" : key.unit;
}

std::string bound_text(const Key& key, double bound) {
  const Field field = key.field(key.standard);
  const bool whole = std::holds_alternative<int*>(field) ||
                     std::holds_alternative<std::int64_t*>(field) ||
                     std::holds_alternative<std::uint64_t*>(field) ||
                     std::holds_alternative<std::array<int, 2>*>(field);
  if (!whole) return to_text(bound);
  // The largest bound is read as 2^63, which a double can represent.
  const bool largest = bound >= 0x1p63;
  return std::to_string(largest ? std::numeric_limits<std::int64_t>::max() : std::int64_t(bound));
}

std::string range_text(const Key& key) {
  std::vector<std::string> parts;
  const Range& r = key.range;
  if (!unit_text(key).empty() && r.min > -std::numeric_limits<double>::infinity())
    parts.push_back((r.above_min ? "> " : "") + bound_text(key, r.min) + " .. " +
                    (r.below_max ? "< " : "") + bound_text(key, r.max));
  parts.insert(parts.end(), key.choices.begin(), key.choices.end());
  if (std::holds_alternative<bool*>(key.field(key.standard))) parts.push_back("true | false");
  if (key.automatic) parts.push_back("auto");
  return joined(parts, " | ");
}

std::string value_text(const Key& key, const Object& holder) {
  return format_field(key, key.field(holder));
}

std::string default_text(const Key& key) {
  return key.usually ? key.usually : value_text(key, key.standard);
}

std::string Key::kinds_text(unsigned bits) const {
  std::vector<std::string> words;
  for (std::size_t k = 0; k < choices.size(); ++k)
    if (bits & (1u << k)) words.push_back(choices[k]);
  return joined(words, ", ");
}

}  // namespace pbf::scene_module
