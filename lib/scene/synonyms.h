// What users of other programs write for keys and words of ours: the contents of synonyms.yaml,
// which says what its entries mean.
#pragma once

#include <string>
#include <vector>

namespace pbf::inline scene_module {

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

/// Reads the text when it is asked for the first time.
const Synonyms& synonyms();

extern const char* const kSynonymText;  ///< lib/scene/synonyms.yaml, made by .cmake/synonyms.cmake

}  // namespace pbf::inline scene_module
