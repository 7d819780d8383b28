// Reading grows with the text, not with its square. Texts as large as a scene may be are read in
// parts of a second; with anything quadratic they took from half a minute to hours, which the
// timeout of the test catches.
#include <algorithm>

#include "lib/scene/problems.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

constexpr std::size_t kBytes = (std::size_t{4} << 20) - 4096;

/// `piece(i)` again and again, up to the size that a scene may have, or a part of it.
template <class Piece>
std::string many(Piece piece, std::size_t part = 1) {
  std::string text;
  for (int i = 0; text.size() < kBytes / part; ++i) text += piece(i);
  return text;
}

}  // namespace

TEST_CASE("4 MiB of comments, of empty lines or of lines of one text are read", "[slow]") {
  CHECK(parse_error(many([](int) { return "#\n"; }) + kMinimal) == "no error");
  CHECK(parse_error(many([](int) { return "\n"; }) + kMinimal) == "no error");
  CHECK(contains(parse_error(kMinimal + "name: >\n" + many([](int) { return "  x\n\n"; })),
                 "longer than 1000 bytes"));
}

TEST_CASE("4 MiB of unknown keys, wrong entries or repeated keys are counted, 100 shown",
          "[slow]") {
  const auto key = [](int i) { return std::to_string(i).append(": 1\n"); };
  const auto entry = [](int) { return "  - {shape: block, mn: [0, 0, 0], max: [9, 9, 9]}\n"; };
  const std::string before = kMinimal.substr(0, kMinimal.find("bodies:"));
  for (const std::string& text :
       {kMinimal + many(key), kMinimal + many([](int) { return "? a\n: b\n"; }, 4),
        before + "bodies:\n" + many(entry, 4)}) {
    const std::string error = parse_error(text);
    CAPTURE(error.substr(0, 200));
    CHECK(std::count(error.begin(), error.end(), '\n') == 100);
    CHECK(contains(error, " more problems"));
  }
}

TEST_CASE("a problem met many times is said once, and the count of the others is right") {
  Problems problems;
  for (int repeat = 0; repeat < 3; ++repeat)
    for (int i = 0; i < 150; ++i)
      problems.add("scene.yaml:" + std::to_string(i), "key", "is wrong");
  std::string text;
  try {
    problems.raise();
  } catch (const Error& e) {
    text = e.what();
  }
  CHECK(std::count(text.begin(), text.end(), '\n') == 100);
  CHECK(contains(text, "scene.yaml:99: key: is wrong\n... and 50 more problems"));
}

}  // namespace pbf::scene_test
