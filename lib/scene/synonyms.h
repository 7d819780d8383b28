// What users of other programs write for keys and words of ours.
#pragma once

#include <string>
#include <vector>

namespace pbf::inline scene_module {

/// Words in small letters without "_", "-" and spaces.
struct KeySynonym {
  std::vector<std::string> written;
  std::vector<const char*> keys;  ///< paths of the table; those in the block at hand come first
  std::string note{};             ///< behind the question, or alone without keys
  bool anywhere = true;           ///< false: so common a word means these in their blocks only
  std::string in{};               ///< counts in this block alone, before all others: "obstacles[]"
};

struct WordSynonym {
  std::string written, meant;
};

const std::vector<KeySynonym>& key_synonyms();
/// Of one word perhaps several: the one counts that is allowed.
const std::vector<WordSynonym>& word_synonyms();

}  // namespace pbf::inline scene_module
