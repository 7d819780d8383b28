// What the table of keys says about itself in words, and the search for a misspelt key.
#include <algorithm>

#include "lib/base/text.h"
#include "lib/scene/keys.h"
#include "lib/scene/number.h"
#include "lib/scene/value.h"

namespace pbf::inline scene_module {
namespace {

/// Edit distance with transpositions of neighbours (optimal string alignment).
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before.swap(last);
    last.swap(row);
  }
  return last[b.size()];
}

}  // namespace

std::string nearest_word(const std::string& word, const std::vector<std::string>& words) {
  std::string best;
  if (word.size() > 100) return best;
  std::size_t least = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const std::string& candidate : words) {
    const std::size_t d = distance(word, candidate);
    if (d < least) {
      least = d;
      best = candidate;
    }
  }
  return best;
}

std::string KeyTable::nearest_path(const std::string& path) const {
  std::vector<std::pair<std::string, std::string>> names;  // block and leaf
  for (const Block& block : blocks)
    if (block.parent != nullptr) names.emplace_back(block.parent->path, block.leaf());
  for (const Key& key : keys) names.emplace_back(key.block->path, key.leaf());
  // First among the block's own keys: `solver.step` is near solver.sor, not time.step.
  const std::size_t dot = path.rfind('.');
  const std::string in = dot == std::string::npos ? "" : path.substr(0, dot);
  const std::string wrong = path.substr(dot + 1);
  std::vector<std::string> siblings, paths;
  for (const auto& [block, leaf] : names) {
    if (block == in) siblings.push_back(leaf);
    paths.push_back(join(block, leaf));
  }
  const std::string sibling = nearest_word(wrong, siblings);
  if (!sibling.empty()) return join(in, sibling);
  // Then a key of the same name that lives elsewhere, then anything near.
  for (const auto& [block, leaf] : names)
    if (leaf == wrong) return join(block, leaf);
  return nearest_word(path, paths);
}

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
