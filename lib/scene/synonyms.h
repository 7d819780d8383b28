// Names in other programs for our keys and words: the contents of synonyms.yaml, which explains its
// entries.
#pragma once

#include <string>
#include <vector>

namespace pbf::scene_module {

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
