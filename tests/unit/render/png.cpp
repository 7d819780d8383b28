// Writing PNG files; no OpenGL needed.
#include <png.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>

#include "tests/support/render_support.h"

using namespace pbf;
using namespace pbf_test;
namespace fs = std::filesystem;

namespace {

Image pattern(int width, int height) {
  Image image{width, height,
              std::vector<std::uint8_t>(3 * static_cast<std::size_t>(width) * height)};
  std::uint32_t state = 1;
  for (auto& byte : image.rgb)
    byte = static_cast<std::uint8_t>((state = state * 1664525u + 1013904223u) >> 24);
  return image;
}

fs::path folder(const std::string& name) {
  const fs::path path =
      fs::temp_directory_path() / ("pbf_" + name + "_" + std::to_string(getpid()));
  fs::remove_all(path);
  fs::create_directories(path);
  return path;
}

}  // namespace

TEST_CASE("a PNG holds exactly the pixels that were written", "[render]") {
  const fs::path dir = folder("png_round");
  const Image image = pattern(37, 23);
  write_png((dir / "a.png").string(), image);
  png_image reader{};
  reader.version = PNG_IMAGE_VERSION;
  REQUIRE(png_image_begin_read_from_file(&reader, (dir / "a.png").c_str()));
  reader.format = PNG_FORMAT_RGB;
  CHECK(reader.width == 37);
  CHECK(reader.height == 23);
  std::vector<std::uint8_t> rgb(PNG_IMAGE_SIZE(reader));
  REQUIRE(png_image_finish_read(&reader, nullptr, rgb.data(), 0, nullptr));
  CHECK(rgb == image.rgb);
  CHECK(std::distance(fs::directory_iterator(dir), {}) == 1);  // nothing half-written is left
  fs::remove_all(dir);
}

TEST_CASE("a picture in a folder that is not there names the file and the reason", "[render]") {
  const auto [code, text] = error_of([] { write_png("/no/such/folder/a.png", pattern(2, 2)); });
  CHECK(code == 5);
  CHECK(text.find("/no/such/folder/a.png") != std::string::npos);
  CHECK(text.find("No such file") != std::string::npos);
}

TEST_CASE("a disk that fills up while a picture is written is an error and leaves no file",
          "[render]") {
  const fs::path dir = folder("png_full");
  rlimit old{};
  REQUIRE(getrlimit(RLIMIT_FSIZE, &old) == 0);
  const rlimit tight{4096, old.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  REQUIRE(setrlimit(RLIMIT_FSIZE, &tight) == 0);
  const auto [code, text] =
      error_of([&] { write_png((dir / "a.png").string(), pattern(200, 200)); });
  REQUIRE(setrlimit(RLIMIT_FSIZE, &old) == 0);
  std::signal(SIGXFSZ, handler);
  CHECK(code == 5);
  CHECK(text.find("File too large") != std::string::npos);
  CHECK(fs::is_empty(dir));
  fs::remove_all(dir);
}

TEST_CASE("an image whose size does not fit its pixels is refused", "[render]") {
  Image image = pattern(4, 4);
  image.height = 5;
  CHECK(error_of([&] { write_png("/tmp/never.png", image); }).first == 1);
}
