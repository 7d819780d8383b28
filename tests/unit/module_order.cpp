// Includes point one way. The order of the modules: lib/README.md.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/catch.h"

namespace fs = std::filesystem;

namespace {

/// From the left to the right: each module may use those that stand left of it.
const std::vector<std::vector<std::string>> kOrder{
    {"base"},         {"kernels"}, {"scene"}, {"program"}, {"solver"},   {"exec"},
    {"io", "render"}, {"data"},    {"run"},   {"verify"},  {"campaign"}, {"app"}};

int place(const std::string& module) {
  for (std::size_t k = 0; k < kOrder.size(); ++k)
    if (std::count(kOrder[k].begin(), kOrder[k].end(), module)) return int(k);
  return -1;
}

/// "run" of lib/run/guard.h, "kernels" of kernels/vec3.h.
std::string module_of(const std::string& path) {
  const fs::path p(path);
  auto part = p.begin();
  return *part == "lib" ? (++part)->string() : part->string();
}

/// What is wrong with the includes of a file; `of` its path.
std::vector<std::string> wrong_includes(const std::string& of, const std::string& text) {
  std::vector<std::string> wrong;
  const std::regex include("#include \"([^\"]+)\"");
  for (std::sregex_iterator i(text.begin(), text.end(), include), end; i != end; ++i) {
    const std::string what = (*i)[1];
    if (what == "pbf_build_info.h" || what == "pbf_shaders.h") continue;  // generated
    const std::string from = module_of(of), to = module_of(what);
    // The kernels hold the physics alone, which knows of no program around it.
    const bool right = from == to || (place(to) >= 0 && place(to) < place(from) &&
                                      !(from == "kernels" && to == "base"));
    if (!right) wrong.push_back(of + " includes " + what);
  }
  return wrong;
}

std::vector<fs::path> sources() {
  std::vector<fs::path> files;
  const fs::path root = PBF_SOURCE_DIR;
  for (const char* folder : {"app", "lib", "kernels"})
    for (const auto& entry : fs::recursive_directory_iterator(root / folder))
      if (const std::string e = entry.path().extension().string();
          e == ".h" || e == ".cpp" || e == ".cu" || e == ".cuh")
        files.push_back(fs::relative(entry.path(), root));
  return files;
}

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(PBF_SOURCE_DIR / file).rdbuf();
  return text.str();
}

}  // namespace

TEST_CASE("includes point one way, from app to base, inside lib too") {
  std::vector<std::string> wrong;
  const std::vector<fs::path> files = sources();
  CHECK(files.size() > 200);
  for (const fs::path& file : files) {
    CHECK(place(module_of(file.string())) >= 0);
    for (std::string& w : wrong_includes(file.string(), text_of(file)))
      wrong.push_back(std::move(w));
  }
  CHECK(wrong == std::vector<std::string>{});
}

TEST_CASE("an arrow that is turned round is found") {
  const auto count = [](const char* of, const char* what) {
    return wrong_includes(of, std::string("#include \"") + what + "\"\n").size();
  };
  CHECK(count("lib/scene/load.cpp", "lib/io/h5.h") == 1);
  CHECK(count("lib/io/checkpoint.cpp", "lib/scene/scene.h") == 0);
  CHECK(count("kernels/vec3.h", "lib/base/text.h") == 1);
  CHECK(count("lib/verify/compare.h", "lib/campaign/study.h") == 1);
  CHECK(count("lib/campaign/study.h", "lib/data/series.h") == 0);
  CHECK(count("lib/render/renderer.h", "lib/io/h5.h") == 1);
  CHECK(count("lib/run/guard.h", "app/commands.h") == 1);
  CHECK(count("app/main.cpp", "lib/run/guard.h") == 0);
  CHECK(count("lib/base/text.h", "tests/support/catch.h") == 1);
}

TEST_CASE("every file of lib and app is in the namespace of its module") {
  for (const fs::path& file : sources()) {
    const std::string module = module_of(file.string()), text = text_of(file);
    if (module == "kernels") continue;  // pbf::PBF_VARIANT: compiled once per executor
    const std::regex opened("\nnamespace (pbf[^\n{]*) \\{");
    CAPTURE(file.string());
    bool own = false;
    for (std::sregex_iterator i(text.begin(), text.end(), opened), end; i != end; ++i) {
      const std::string name = (*i)[1];
      own = own || name.rfind("pbf::" + module + "_module", 0) == 0 ||
            name.rfind("pbf::PBF_VARIANT", 0) == 0 || name == "pbf::defect" ||
            file.filename() == "cuda_variants.h";  // declares both variants by their names
    }
    if (file.filename() != "main.cpp" && text.find("\nnamespace ") != std::string::npos) CHECK(own);
  }
}
