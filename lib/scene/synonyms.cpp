#include "lib/scene/synonyms.h"

#include <yaml-cpp/yaml.h>

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

}  // namespace

const Synonyms& synonyms() {
  static const Synonyms all = read_synonyms();
  return all;
}

}  // namespace pbf::scene_module
