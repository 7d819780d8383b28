#include "lib/campaign/strict_reader.h"

#include <algorithm>
#include <filesystem>

#include "lib/base/text.h"
#include "lib/scene/suggest.h"

namespace pbf::campaign_module {
using Kind = Node::Kind;

std::set<std::string> StrictReader::read_map(const Node& map, const std::string& block,
                                             const Entries& entries) {
  std::set<std::string> seen;
  if (map.kind != Kind::map) {
    bad(map, block, "is " + map.shown() + ", expected a block of keys");
    return seen;
  }
  for (std::size_t i = 0; i < map.items.size(); ++i) {
    const std::string key = setting_text(map.keys[i]);
    const std::string full = block.empty() ? key : block + "." + key;
    const auto found = std::ranges::find(entries, key, &Entries::value_type::first);
    if (found == entries.end()) {
      std::vector<std::string> names;
      for (const auto& e : entries) names.push_back(e.first);
      const std::string near = nearest_word(key, names);
      bad(map.keys[i], full,
          "unknown key, " + (near.empty() ? "the keys here are " + joined(names, " ")
                                          : "did you mean " + near + "?"));
    } else if (!seen.insert(key).second) {
      bad(map.keys[i], full, "is given twice");
    } else {
      found->second(map.items[i]);
    }
  }
  return seen;
}

void StrictReader::text(const Node& n, const std::string& key, std::string& out) {
  if (n.kind != Kind::scalar || n.text.empty())
    return bad(n, key, "is " + n.shown() + ", expected text");
  out = n.text;
}

std::string StrictReader::file(const Node& n, const std::string& key) {
  std::string name;
  text(n, key, name);
  return (std::filesystem::path(path_).parent_path() / name).string();
}

Settings StrictReader::settings(const Node& n, const std::string& key) {
  Settings out;
  if (n.kind != Kind::map) {
    bad(n, key,
        "is " + n.shown() + ", expected keys of the scene with values, {solver.iterations: 4}");
    return out;
  }
  for (std::size_t i = 0; i < n.items.size(); ++i)
    out.emplace_back(setting_text(n.keys[i]), n.items[i]);
  return out;
}

}  // namespace pbf::campaign_module
