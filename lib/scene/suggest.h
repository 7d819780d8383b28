// What someone may have meant who wrote a key or a word that is not known: the nearest spelling, or
// what other programs call it. Where nothing is near, nothing is guessed.
#pragma once

#include <string>
#include <vector>

namespace pbf::inline scene_module {

struct KeyTable;

/// Nearest of `words`, or empty when nothing is near. Capitals, "_" and "-" do not count.
std::string nearest_word(const std::string& word, const std::vector<std::string>& words);
/// The one of `choices` that is written like this elsewhere ("gpu": cuda), or the nearest; empty
/// when there is none.
std::string nearest_choice(const std::string& word, const std::vector<std::string>& choices);

/// For an unknown key.
struct Suggestion {
  std::vector<std::string> keys;  ///< paths of the table that may have been meant, the best first
  std::string note;               ///< what else is to be known; alone where no key does it
};

/// `path`: of the unknown key as the table would have it, "bodies[].mni".
Suggestion suggest_key(const KeyTable& table, const std::string& path);

}  // namespace pbf::inline scene_module
