// A scene as YAML: the resolved scene and the documented reference.
#include "lib/scene/keys.h"
#include "lib/scene/load.h"
#include "lib/scene/value.h"

namespace pbf::inline scene_module {
namespace {

constexpr std::size_t kWidth = 100;

std::string indent_of(const std::string& block) {
  if (block.empty()) return "";
  std::string indent = "  ";
  for (char c : block)
    if (c == '.') indent += "  ";
  return indent;
}

/// Comment lines, wrapped.
std::string comment(const std::string& text, const std::string& indent) {
  std::string out, line = indent + "#";
  for (std::size_t start = 0; start < text.size();) {
    std::size_t end = text.find(' ', start);
    if (end == std::string::npos) end = text.size();
    const std::string word = text.substr(start, end - start);
    if (line.size() + 1 + word.size() > kWidth) {
      out += line + "\n";
      line = indent + "#";
    }
    line += " " + word;
    start = end + 1;
  }
  return out + line + "\n";
}

/// "Help. [unit; range; default x]"
std::string documentation(const Key& key) {
  static const Scene defaults = scene_with_all_blocks();
  const std::string unit = unit_text(key), range = range_text(key);
  std::string facts;
  const auto add = [&facts](const std::string& fact) {
    facts += (facts.empty() ? "" : "; ") + fact;
  };
  if (key.shapes != 0 && key.leaf() != "shape") {
    std::string names;
    for (std::size_t s = 0; s < shape_names().size(); ++s)
      if (key.shapes & (1u << s)) names += (names.empty() ? "" : ", ") + shape_names()[s];
    add("of " + names);
  }
  if (!unit.empty()) add("unit " + unit);
  if (!range.empty()) add(range);
  if (unit.empty() && range.empty()) add("text");
  add(key.required ? "required" : "default " + value_text(key, defaults, Body{}));
  return key.help + " [" + facts + "]";
}

class Writer {
 public:
  Writer(const Scene& scene, bool comments) : scene_(scene), comments_(comments) {}

  std::string text() {
    for (const Key& key : scene_keys()) {
      const std::string block = key.block();
      if (block != block_) enter(block);
      if (block == "bodies[]" || !is_present(scene_, block)) continue;
      if (comments_) out_ += comment(documentation(key), indent_of(block));
      out_ += indent_of(block) + key.leaf() + ": " + value_text(key, scene_, Body{}) + "\n";
    }
    return out_;
  }

 private:
  void enter(const std::string& block) {
    block_ = block;
    if (comments_) out_ += "\n";
    if (block.empty()) return;
    if (block == "bodies[]") return write_bodies();
    const Block& entry = *find_block(block);
    const std::string leaf = block.substr(block.rfind('.') + 1);
    const std::string indent = indent_of(block).substr(2);
    if (!is_present(scene_, block)) {  // children of an absent block say nothing
      if (entry.optional) out_ += indent + leaf + ": off\n";
      return;
    }
    if (comments_)
      out_ += comment(
          entry.help + (entry.on_by_default ? " Optional: on with the defaults without this "
                                              "block; off with `" +
                                                  leaf + ": off`."
                        : entry.optional ? " Optional: without this block, or with `" + leaf +
                                               ": off`, it is off; {} or `on` turns it "
                                               "on with the defaults."
                                         : ""),
          indent);
    out_ += indent + leaf + ":\n";
  }

  void write_bodies() {
    if (comments_) {
      out_ += comment("Bodies of fluid, at least one; ids count through them in this order.", "");
      for (const Key& key : scene_keys())
        if (key.block() == block_) out_ += comment(key.leaf() + ": " + documentation(key), "");
    }
    out_ += "bodies:\n";
    for (const Body& body : scene_.bodies) {
      std::string line;
      for (const Key& key : scene_keys())
        if (key.block() == block_ && (key.shapes & (1u << static_cast<unsigned>(body.shape))))
          line +=
              (line.empty() ? "  - {" : ", ") + key.leaf() + ": " + value_text(key, scene_, body);
      out_ += line + "}\n";
    }
    if (comments_) out_ += "  # - {shape: file, path: particles.csv, velocity: [0, 0, 0]}\n";
  }

  const Scene& scene_;
  bool comments_;
  std::string block_, out_;
};

/// A small dam break with everything on, which runs as it is.
Scene example_scene() {
  Scene s = scene_with_all_blocks();
  s.name = "reference";
  s.domain.min = {0, 0, 0};
  s.domain.max = {1.6, 0.4, 0.8};
  s.fluid.spacing = 0.02;
  Body block;
  block.shape = Shape::block;
  block.max = {0.4, 0.4, 0.4};
  Body sphere;
  sphere.shape = Shape::sphere;
  sphere.center = {1.2, 0.2, 0.4};
  sphere.radius = 0.1;
  Body random;
  random.shape = Shape::random_box;
  random.min = {0, 0, 0.6};
  random.max = {0.2, 0.4, 0.7};
  random.count = 500;
  s.bodies = {block, sphere, random};
  s.time.step = 0.002;
  s.time.end = 1;
  return s;
}

}  // namespace

std::string resolved_yaml(const Scene& scene) { return Writer(scene, false).text(); }

std::string reference_yaml() {
  return "# The reference scene: every key with its meaning, unit, range and default. SI units.\n"
         "# Only the keys marked `required` must be there. Try it: pbf run reference.yaml\n"
         "# Any key can be changed from the command line: --set solver.iterations=8,\n"
         "# --set bodies[0].velocity=[1,0,0], --set viscosity=off\n" +
         Writer(example_scene(), true).text();
}

}  // namespace pbf::inline scene_module
