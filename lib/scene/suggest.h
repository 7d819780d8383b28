// Suggestions for an unknown key or word: the nearest spelling, or our name for the word of another
// program. Without a good match there is none.
#pragma once

#include <string>
#include <vector>

namespace pbf::scene_module {

struct KeyTable;

/// The nearest of `words`; empty if none is near. Ignores case, "_" and "-".
std::string nearest_word(const std::string& word, const std::vector<std::string>& words);
/// The one of `choices` that another program calls `word` ("gpu": cuda), or the nearest; empty if
/// there is none.
std::string nearest_choice(const std::string& word, const std::vector<std::string>& choices);

/// For an unknown key.
struct Suggestion {
  std::vector<std::string> keys;  ///< suggested paths of the table, the best first
  std::string note;               ///< further advice; alone if no key fits
};

/// `path`: of the unknown key, in the form of the table: "bodies[].mni".
Suggestion suggest_key(const KeyTable& table, const std::string& path);

// Names in other programs for our keys and words: the contents of synonyms.yaml, which explains its
// entries.

struct KeySynonym {
  std::vector<std::string> written, keys;
  std::string note;
  bool own_block = false;
  std::string in;
};

struct WordSynonym {
  std::string written, meant;
};

struct Synonyms {
  std::vector<KeySynonym> keys;
  std::vector<WordSynonym> words;
};

/// Parses the text on first use.
const Synonyms& synonyms();

extern const char* const kSynonymText;  ///< lib/scene/synonyms.yaml, made by .cmake/synonyms.cmake

}  // namespace pbf::scene_module
