#include "lib/scene/scene_text.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

#include "lib/base/error.h"
#include "lib/base/inputs.h"
#include "lib/base/plain_text.h"
#include "lib/base/shipped_file.h"
#include "lib/scene/file_kind.h"
#include "lib/scene/suggest.h"

namespace pbf::scene_module {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{4} << 20;     // of a scene or a study
constexpr std::size_t kMaxResult = std::size_t{256} << 20;  // of a file that pbf itself wrote

std::size_t limit_of(const std::string& what) {
  return what == "scene" || what == "study" ? kMaxBytes : kMaxResult;
}

void check_text(const std::string& text, const Origin& origin, const std::string& what) {
  if (text.rfind("\x89HDF\r\n\x1a\n", 0) == 0)
    bad_input(origin.shown(), "is an HDF5 file, expected a " + what +
                                  " in YAML; of a run file pbf plan " + origin.name +
                                  " --resolved prints the scene");
  if (text.size() > limit_of(what))
    bad_input(origin.shown(),
              "is larger than 4 MiB; many particles belong into a file body (shape: file)");
  if (const auto found = find_bad_text(text))
    bad_input(origin.name + ":" + std::to_string(found->line + 1) + ":" +
                  std::to_string(found->column + 1) + origin.included,
              "is not plain text: " + found->what + "; " + found->remedy + "; expected a " + what +
                  " in YAML");
}

/// For a missing file: the nearest name in its folder, or a file that comes with the program.
std::string nearest_file(const std::string& path) {
  namespace fs = std::filesystem;
  const fs::path file(path), folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  std::error_code error;
  if (fs::exists(file, error)) return "";
  std::vector<std::string> names;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    if (has_scene_name(it->path().string()) && names.size() < 10000)
      names.push_back(it->path().stem().string());
  std::ranges::sort(names);
  const std::string near = has_scene_name(path) ? nearest_word(file.stem().string(), names) : "";
  if (!near.empty())
    return "; did you mean " + (file.parent_path() / (near + file.extension().string())).string() +
           "?";
  const std::string shipped = shipped_file("configs/" + file.filename().string());
  return fs::exists(shipped, error) ? "; " + shipped + " comes with pbf" : "";
}

}  // namespace

std::string text_of_file(const Origin& file, const std::string& what) {
  namespace fs = std::filesystem;
  std::error_code ec;
  const fs::file_status status = fs::status(file.name, ec);
  if (fs::is_directory(status))
    bad_input(file.shown(), "is a directory, expected a " + what + " file");
  note_input(file.name);
  std::ifstream in(file.name, std::ios::binary);
  if (!in) {
    const std::string reason = std::strerror(errno);
    bad_input(file.shown(), "cannot be opened: " + reason + nearest_file(file.name));
  }
  // Read in blocks, because the text is kept for the whole run with its capacity. One byte more
  // than the limit is enough to detect a file that is too large.
  const std::size_t most = limit_of(what) + 1;
  std::string text;
  std::array<char, 16384> block;
  while (in && text.size() < most) {
    in.read(block.data(), block.size());
    text.append(block.data(), static_cast<std::size_t>(in.gcount()));
  }
  if (in.bad()) bad_input(file.shown(), "reading failed");
  return text;
}

Node tree_of_text(const std::string& text, const Origin& origin, const std::string& what) {
  check_text(text, origin, what);
  if (const std::string other = other_text(text, origin.name, what); !other.empty())
    bad_input(origin.shown(), other);
  try {
    Node root = parse_yaml(text, origin, true);
    if (const std::string other = other_file(root, origin.name, what); !other.empty())
      bad_input(origin.shown(), other);
    if (root.kind != Node::Kind::null) return root;
  } catch (const YamlError& e) {
    bad_input(e.place, e.what);
  }
  bad_input(origin.shown(),
            "is empty" + std::string(what == "scene" ? "; `pbf config --example` prints a scene "
                                                       "to start from"
                                                     : ""));
}

}  // namespace pbf::scene_module
