// What the table of keys says about itself in words.
#include "lib/base/text.h"
#include "lib/scene/keys.h"
#include "lib/scene/number.h"
#include "lib/scene/value.h"

namespace pbf::inline scene_module {
std::string unit_text(const Key& key) {
  return key.unit.empty() && is_numeric(key.field(key.standard)) ? "1" : key.unit;
}

std::string range_text(const Key& key) {
  std::vector<std::string> parts;
  const Range& r = key.range;
  if (!unit_text(key).empty() && r.min > -std::numeric_limits<double>::infinity())
    parts.push_back((r.above_min ? "> " : "") + to_text(r.min) + " .. " +
                    (r.below_max ? "< " : "") + to_text(r.max));
  parts.insert(parts.end(), key.choices.begin(), key.choices.end());
  if (std::holds_alternative<bool*>(key.field(key.standard))) parts.push_back("true | false");
  if (key.automatic) parts.push_back("auto");
  return joined(parts, " | ");
}

std::string value_text(const Key& key, const Object& holder) {
  return format_field(key, key.field(holder));
}

std::string Key::kinds_text(unsigned bits) const {
  std::vector<std::string> words;
  for (std::size_t k = 0; k < choices.size(); ++k)
    if (bits & (1u << k)) words.push_back(choices[k]);
  return joined(words, ", ");
}

}  // namespace pbf::inline scene_module
