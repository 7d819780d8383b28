// All keys of a scene as a page: configs/keys.md.
#include <fmt/core.h>
#include <algorithm>

#include "lib/scene/base_scene.h"
#include "lib/scene/keys.h"
#include "lib/scene/load.h"

namespace pbf::scene_module {
namespace {

/// Escapes bars, which would end the cell of a table.
std::string cell(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '|') out += '\\';
    out += c;
  }
  return out;
}
std::string code(const std::string& text) {
  return text.empty() ? text : fmt::format("`{}`", cell(text));
}

std::string row(const Key& key) {
  const Key* kind = key.block->kind;
  std::string help = cell(key.help);
  if (kind != nullptr && kind != &key)
    help = fmt::format("({}) {}", cell(kind->kinds_text(key.kinds)), help);
  const std::string standard = key.required  ? "required"
                               : key.usually ? default_text(key)
                                             : code(default_text(key));
  return fmt::format("| {} | {} | {} | {} | {} |\n", code(key.leaf()), cell(unit_text(key)),
                     cell(range_text(key)), standard, help);
}

std::string heading(const Block& block) {
  if (block.path.empty()) return "At the top of the file";
  const char* how = block.list            ? ", a list"
                    : !block.optional     ? ""
                    : block.on_by_default ? ", on unless `off`"
                                          : ", optional";
  return code(block.path) + how;
}

}  // namespace

std::string reference_markdown() {
  std::string out =
      "# Keys of a scene\n"
      "Every key with its unit, the values that it may have, and its default; written by `pbf "
      "config --markdown`. Words in brackets say which kinds of an entry have a key. An optional "
      "block that is not there, or `off`, is not done; one that is there takes the defaults for "
      "what it does not say. [How to use them](README.md); [the same as a scene that "
      "runs](reference.yaml).\n";
  for (const Block& block : scene_table().blocks) {
    if (block.keys.empty()) continue;
    out += "\n## " + heading(block) + "\n";
    if (!block.help.empty()) out += block.help + (block.help.back() == '.' ? "\n\n" : ".\n\n");
    out += "| key | unit | values | default | meaning |\n|---|---|---|---|---|\n";
    if (block.path.empty())
      out += fmt::format("| `{}` |  |  |  | {} |\n", kBaseKey, cell(kBaseHelp));
    for (const Key* key : block.keys) out += row(*key);
  }
  return out;
}

}  // namespace pbf::scene_module
