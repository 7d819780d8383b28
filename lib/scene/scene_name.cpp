#include "lib/scene/scene_name.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace pbf::scene_module {

std::string plain_name(const std::string& text) {
  std::string out;
  for (const char c : text)
    if (std::isalnum(static_cast<unsigned char>(c)) || std::string(".-=_").find(c) != text.npos)
      out += c;
    else if (!out.empty() && out.back() != '-')
      out += '-';
  out.resize(std::min<std::size_t>(out.size(), 150));
  while (!out.empty() && out.back() == '-') out.pop_back();
  return out;
}

bool name_by_file(Node& root, const std::string& path) {
  if (root.kind != Node::Kind::map || root.find("name") != nullptr) return false;
  // /dev/stdin may be a regular file, but is no name either.
  const std::string whole = std::filesystem::absolute(path).lexically_normal().string();
  std::error_code error;
  if (whole.starts_with("/dev/") || whole.starts_with("/proc/") ||
      !std::filesystem::is_regular_file(path, error))
    return false;
  const std::string name = plain_name(std::filesystem::path(path).stem().string());
  if (name.empty() || name[0] == '.') return false;
  Node value = root.here(Node::Kind::scalar, name);
  value.quoted = true;
  root.append(root.here(Node::Kind::scalar, "name"), value);
  return true;
}

}  // namespace pbf::scene_module
