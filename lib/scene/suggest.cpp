#include "lib/scene/suggest.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cctype>

#include "lib/scene/base_scene.h"
#include "lib/scene/keys.h"

namespace pbf::scene_module {
namespace {

using Words = std::vector<std::string>;

Synonyms read_synonyms() {
  const YAML::Node root = YAML::Load(kSynonymText);
  Synonyms all;
  for (const YAML::Node& n : root["keys"])
    all.keys.push_back({n["words"].as<Words>(), n["keys"].as<Words>(Words{}),
                        n["note"].as<std::string>(""), n["own_block"].as<bool>(false),
                        n["in"].as<std::string>("")});
  for (const auto& meant : root["words"])
    for (const std::string& written : meant.second.as<Words>())
      all.words.push_back({written, meant.first.as<std::string>()});
  return all;
}

/// Normalizes spelling: "Time-Step", "timeStep" and "time_step" become "timestep".
std::string bare(const std::string& word) {
  std::string out;
  for (const char c : word)
    if (c != '_' && c != '-' && c != ' ')
      out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

/// Edit distance with transpositions of neighbors (optimal string alignment).
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

/// Number of errors up to which a word of so many letters is recognized.
std::size_t allowed(std::size_t letters) {
  return letters < 3 ? 0 : letters < 6 ? 1 : letters < 9 ? 2 : 3;
}

/// Stricter for short words: "gpu" and "wind" do not mean "cpu" and "kind". Swapped, missing and
/// extra letters count as typing errors; a different first or last letter makes another word.
bool is_near(const std::string& a, const std::string& b, std::size_t mistakes) {
  const std::size_t letters = std::max(a.size(), b.size());
  if (mistakes == 0) return true;
  if (mistakes > allowed(letters)) return false;
  const bool same_letters = std::is_permutation(a.begin(), a.end(), b.begin(), b.end());
  if (letters < 5 && a[0] != b[0] && !same_letters) return false;
  return letters > 3 || a.size() != b.size() || same_letters || a.back() == b.back();
}

/// The `paths` in the block; if there are none, all, unless they are too many for a hint.
std::vector<std::string> preferred(const std::vector<std::string>& paths,
                                   const std::string& block) {
  constexpr std::size_t kMost = 3;
  std::vector<std::string> own;
  for (const std::string& path : paths)
    if (block_of(path) == block) own.push_back(path);
  if (!own.empty()) return own;
  return paths.size() <= kMost ? paths : std::vector<std::string>{};
}

/// Whether this is the block, or a block or list around it.
bool is_around(const std::string& name, const std::string& block) {
  return block.rfind(name, 0) == 0 &&
         (block.size() == name.size() || block[name.size()] == '.' || block[name.size()] == '[');
}

}  // namespace

const Synonyms& synonyms() {
  static const Synonyms all = read_synonyms();
  return all;
}

std::string nearest_word(const std::string& word, const std::vector<std::string>& words) {
  std::string best;
  if (word.size() > 100) return best;
  const std::string wrong = bare(word);
  std::size_t least = allowed(wrong.size()) + 1;  // exact matches count at any length
  for (const std::string& candidate : words) {
    const std::string right = bare(candidate);
    const std::size_t d = distance(wrong, right);
    if (d < least && is_near(wrong, right, d)) {
      least = d;
      best = candidate;
    }
  }
  return best;
}

std::string nearest_choice(const std::string& word, const std::vector<std::string>& choices) {
  std::string written = bare(word);
  for (const std::string rest : {"wall", "face"})  // the left wall
    if (written.size() > rest.size() && written.ends_with(rest))
      written.resize(written.size() - rest.size());
  for (const WordSynonym& s : synonyms().words)
    if (written == s.written && std::ranges::count(choices, s.meant)) return s.meant;
  return nearest_word(word, choices);
}

Suggestion suggest_key(const KeyTable& table, const std::string& path) {
  std::vector<std::string> paths, siblings, leaves;
  const std::string in = block_of(path), wrong = leaf_of(path);
  // Do not suggest the block that the key is in, or one around it: {solver: {sovler: 4}}.
  for (const Block& block : table.blocks)
    if (block.parent != nullptr)
      if (const std::string name = join(block.parent->path, block.leaf()); !is_around(name, in))
        paths.push_back(name);
  for (const Key& key : table.keys) paths.push_back(key.path);
  if (in.empty() && &table == &scene_table()) paths.push_back(kBaseKey);
  // Keys of the same block come first: `solver.step` is near solver.sor, not time.step.
  for (const std::string& p : paths) {
    if (block_of(p) == in) siblings.push_back(leaf_of(p));
    leaves.push_back(leaf_of(p));
  }
  Suggestion of_synonym;
  for (const KeySynonym& s : synonyms().keys)
    if (!s.in.empty() && s.in == in && std::ranges::count(s.written, bare(wrong)))
      return {s.keys, s.note};
  for (const KeySynonym& s : synonyms().keys) {
    if (!s.in.empty() || !std::ranges::count(s.written, bare(wrong))) continue;
    std::vector<std::string> known;
    for (const std::string& key : s.keys)
      if (std::ranges::count(paths, key)) known.push_back(key);
    if (known.empty() && !s.keys.empty()) continue;  // a synonym of another table
    known = preferred(known, in);
    if (s.own_block && !known.empty() && block_of(known[0]) != in) continue;
    if (known.empty() && !s.keys.empty()) continue;
    of_synonym = {known, s.note};
    if (known.empty() || block_of(known[0]) == in) return of_synonym;
  }
  if (const std::string sibling = nearest_word(wrong, siblings); !sibling.empty())
    return {{join(in, sibling)}, ""};
  // Then names in other programs, and similar keys in other blocks.
  if (!of_synonym.keys.empty() || !of_synonym.note.empty()) return of_synonym;
  std::vector<std::string> elsewhere;
  const std::string leaf = nearest_word(wrong, leaves);
  // In an entry of a list, suggest only keys of that list.
  const std::string list = in.substr(0, in.find("[]") == in.npos ? 0 : in.find("[]") + 2);
  for (std::size_t i = 0; i < paths.size(); ++i)
    if (!leaf.empty() && leaves[i] == leaf && paths[i].rfind(list, 0) == 0)
      elsewhere.push_back(paths[i]);
  return {preferred(elsewhere, in), ""};
}

}  // namespace pbf::scene_module
