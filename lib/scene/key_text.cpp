// What the table of keys says about itself in words, and the search for a misspelt key.
#include <algorithm>

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

std::string after_last_dot(const std::string& path) { return path.substr(path.rfind('.') + 1); }

}  // namespace

std::string Key::block() const {
  const std::size_t dot = path.rfind('.');
  return dot == std::string::npos ? "" : path.substr(0, dot);
}

std::string Key::leaf() const { return after_last_dot(path); }

const Key* find_renamed(const std::string& path) {
  for (const Key& key : scene_keys())
    if (!key.was.empty() && key.was == path) return &key;
  return nullptr;
}

const Key* find_key(const std::string& path) {
  for (const Key& key : scene_keys())
    if (key.path == path) return &key;
  return nullptr;
}

const Block* find_block(const std::string& path) {
  for (const Block& block : scene_blocks())
    if (block.path == path) return &block;
  return nullptr;
}

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

std::string nearest_path(const std::string& path) {
  std::vector<std::string> paths;
  for (const Block& block : scene_blocks())
    if (!block.path.empty()) paths.push_back(block.path == "bodies[]" ? "bodies" : block.path);
  for (const Key& key : scene_keys()) paths.push_back(key.path);
  // First among the block's own keys: `solver.step` is near solver.sor, not time.step.
  const auto parent = [](const std::string& p) {
    const std::size_t dot = p.rfind('.');
    return dot == std::string::npos ? std::string() : p.substr(0, dot);
  };
  const std::string leaf = after_last_dot(path);
  std::vector<std::string> siblings;
  for (const std::string& p : paths)
    if (parent(p) == parent(path)) siblings.push_back(after_last_dot(p));
  const std::string sibling = nearest_word(leaf, siblings);
  if (!sibling.empty()) return parent(path).empty() ? sibling : parent(path) + "." + sibling;
  // Then a key of the same name that lives elsewhere, then anything near.
  for (const std::string& p : paths)
    if (after_last_dot(p) == leaf) return p;
  return nearest_word(path, paths);
}

std::string unit_text(const Key& key) {
  if (!key.unit.empty()) return key.unit;
  Scene scene = scene_with_all_blocks();
  Body body;
  return is_numeric(key.field(scene, body)) ? "1" : "";
}

std::string range_text(const Key& key) {
  std::string text;
  const auto join = [&text](const std::string& part) {
    text += (text.empty() ? "" : " | ") + part;
  };
  if (!unit_text(key).empty()) {
    const bool low = key.range.min > -std::numeric_limits<double>::infinity();
    if (low)
      text = (key.range.above_min ? "> " : "") + to_text(key.range.min) + " .. " +
             (key.range.below_max ? "< " : "") + to_text(key.range.max);
  }
  for (const std::string& word : key.choices) join(word);
  Scene scene = scene_with_all_blocks();
  Body body;
  if (std::holds_alternative<bool*>(key.field(scene, body))) join("true | false");
  if (key.automatic) join("auto");
  return text;
}

std::string value_text(const Key& key, const Scene& scene, const Body& body) {
  // The accessors are written once, for reading and writing; nothing is written here.
  return format_field(key, key.field(const_cast<Scene&>(scene), const_cast<Body&>(body)));
}

}  // namespace pbf::inline scene_module
