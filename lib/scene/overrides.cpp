#include "lib/scene/overrides.h"

#include <charconv>

#include "lib/base/plain_text.h"

namespace pbf::scene_module {
namespace {

/// Largest number of keys in a block that settings extend; searches are linear.
constexpr std::size_t kMostKeys = 10000;

/// "bodies[0].count" -> bodies, 0, count. Empty if a segment is empty.
std::vector<std::string> segments(const std::string& path) {
  std::string dotted;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (path[i] == '[') {
      const std::size_t close = path.find(']', i);
      if (close == std::string::npos || i == 0) return {};
      if (close + 1 < path.size() && path[close + 1] != '.' && path[close + 1] != '[') return {};
      dotted += '.';
    } else if (path[i] != ']') {
      dotted += path[i];
    }
  }
  std::vector<std::string> parts;
  for (std::size_t start = 0; start <= dotted.size();) {
    std::size_t dot = dotted.find('.', start);
    if (dot == std::string::npos) dot = dotted.size();
    if (dot == start) return {};
    parts.push_back(dotted.substr(start, dot - start));
    start = dot + 1;
  }
  return parts;
}

/// Child of `at` named by `segment`, made if a block lacks it; nullptr with the reason in `why`.
Node* child(Node& at, const std::string& segment, const Node& value, const std::string& so_far,
            std::string& why) {
  const std::string here = so_far.empty() ? "the scene" : so_far;
  if (at.kind == Node::Kind::list) {
    std::size_t index = 0;
    const char* end = segment.data() + segment.size();
    const auto result = std::from_chars(segment.data(), end, index);
    if (result.ec == std::errc{} && result.ptr == end && index < at.items.size())
      return &at.items[index];
    why = here + " is a list of " + std::to_string(at.items.size()) + ", \"" + segment +
          "\" is no index of it (the first is 0)";
    return nullptr;
  }
  // An empty block, or one that is only a word (on, off), becomes a mapping.
  if (at.kind == Node::Kind::null || at.is_word({"off", "false", "on", "true"}))
    at = value.here(Node::Kind::map);
  if (at.kind != Node::Kind::map) {
    why = here + " is no block, it has no key \"" + segment + "\"";
    return nullptr;
  }
  if (Node* found = at.find(segment)) return found;
  if (at.keys.size() >= kMostKeys) {
    why = here + " has more than " + std::to_string(kMostKeys) + " keys; leave some out";
    return nullptr;
  }
  at.append(value.here(Node::Kind::scalar, segment), value.here(Node::Kind::null));
  return &at.items.back();
}

bool is_path(const std::string& path, const std::string& place, Problems& problems) {
  const auto parts = segments(path);
  if (!parts.empty() && parts.size() <= 8) return true;
  problems.add(
      place, "",
      std::string("\"").append(one_line(path)) + "\" is no path of keys such as bodies[0].count");
  return false;
}

void put(Node& root, const std::string& path, const Node& value, const std::string& place,
         Problems& problems) {
  if (problems.full()) return;
  Node* at = &root;
  std::string so_far, why;
  for (const std::string& part : segments(path)) {
    at = child(*at, part, value, so_far, why);
    if (at == nullptr) return problems.add(place, path, why);
    so_far += (so_far.empty() ? "" : ".") + part;
  }
  *at = value;
}

}  // namespace

void apply_override(Node& root, const std::string& argument, Problems& problems) {
  const std::string place = "--set " + one_line(argument);
  if (const auto found = find_bad_text(argument))
    return problems.add(place, "", found->what + "; leave it out");
  const std::size_t equals = argument.find('=');
  if (equals == std::string::npos || equals == 0)
    return problems.add(place, "", "expected key.path=value, e.g. --set solver.iterations=8");
  const std::string path = argument.substr(0, equals);
  if (path.find_first_of(" \t") != std::string::npos)
    return problems.add(place, "", "has a space before the =; write KEY.PATH=VALUE without");
  if (!is_path(path, place, problems)) return;
  Node value;
  try {
    value = parse_yaml(argument.substr(equals + 1), place, false);
  } catch (const YamlError& e) {
    return problems.add(e.place, path, e.what);
  }
  // An explicit null or ~ stays null: it removes an optional block.
  if (argument.find_first_not_of(" \t", equals + 1) == std::string::npos)
    return problems.add(place, path, "has no value; write " + path + "=VALUE");
  put(root, path, value, place, problems);
}

void set_value(Node& root, const std::string& path, const Node& value, Problems& problems) {
  if (is_path(path, value.place(), problems)) put(root, path, value, value.place(), problems);
}

}  // namespace pbf::scene_module
