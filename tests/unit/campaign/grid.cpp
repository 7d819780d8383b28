// Axes of values, their product, and the texts they come from.
#include "lib/campaign/grid.h"

#include <cmath>

#include "lib/base/error.h"
#include "tests/support/catch.h"

using namespace pbf;

namespace {

using Texts = std::vector<std::string>;

std::string error_of(const std::string& key, const std::string& text, bool whole = false) {
  try {
    numbers_listed(key, text, whole);
  } catch (const Error& e) {
    CHECK(e.code() == ExitCode::bad_input);
    return e.what();
  }
  return "none";
}

}  // namespace

TEST_CASE("grid: every combination once, in the order of nested loops, with all its settings") {
  const Texts a{"1", "2"}, b{"x", "y", "z"};
  GridAxis together{{"one", {}}, {"two", {}}};  // two keys that vary together
  for (std::size_t k = 0; k < 2; ++k)
    for (const char* key : {"p", "q"})
      together[k].settings.push_back(grid_axis(key, std::vector<int>{int(k) * 7})[0].settings[0]);
  const auto members =
      grid_members({grid_axis("a", a), together, grid_axis("b", b)}, 12, "f: grid");
  REQUIRE(members.size() == 12);
  std::size_t n = 0;
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < 2; ++j)
      for (std::size_t k = 0; k < 3; ++k, ++n) {
        const GridMember& m = members[n];
        CAPTURE(n);
        CHECK(m.name == "a=" + a[i] + (j ? " two " : " one ") + "b=" + b[k]);
        const std::string of_j = j ? "7" : "0";
        CHECK(override_texts(m.settings) ==
              Texts{"a=" + a[i], "p=" + of_j, "q=" + of_j, "b=" + b[k]});
        CHECK(m.at == std::vector<std::size_t>{i, j, k});
      }
}

TEST_CASE("grid: without axes there is one member, without a value none") {
  REQUIRE(grid_members({}, 1, "").size() == 1);
  CHECK(grid_members({}, 1, "")[0].name.empty());
  CHECK(grid_members({grid_axis("a", Texts{})}, 1, "").empty());
}

TEST_CASE("grid: too many members are refused by the place, before they are made") {
  const GridAxis many(100000);
  try {
    grid_members({many, many, many, many}, 100000, "file.yaml: grid");
    FAIL("no error");
  } catch (const Error& e) {
    CHECK(e.code() == ExitCode::bad_input);
    CHECK(std::string(e.what()) == "file.yaml: grid: makes more than 100000 runs");
  }
}

TEST_CASE("grid: commas in brackets, braces and quotes belong to a value") {
  CHECK(listed_values("1,2") == Texts{"1", "2"});
  CHECK(listed_values("[0, 0, -1],{a: 1, b: [2,3]},\"x,y\",'[',z") ==
        Texts{"[0, 0, -1]", "{a: 1, b: [2,3]}", "\"x,y\"", "'['", "z"});
  CHECK(listed_values("") == Texts{""});
  CHECK(listed_values("1,,2") == Texts{"1", "", "2"});
}

TEST_CASE("grid: numbers as a list or a range in equal ratios") {
  CHECK(numbers_listed("k", "0.5,-2,1e3", false) == std::vector<double>{0.5, -2, 1000});
  const auto range = numbers_listed("k", "0.1:12.8:8", false);
  REQUIRE(range.size() == 8);
  for (std::size_t k = 0; k < 8; ++k) CHECK(range[k] == Approx(0.1 * std::pow(2, double(k))));
  CHECK(numbers_listed("k", "1:4:5", true) == std::vector<double>{1, 2, 3, 4});  // whole, each once
  CHECK(error_of("k", "1,x") == "values of k: \"x\" is not a number");
  CHECK(error_of("k", "1,,2") == "values of k: \"\" is not a number");
  CHECK(error_of("k", "1.5", true) == "values of k: 1.5 is not a whole number");
  for (const char* text : {"1:2", "1:2:3:4"})
    CHECK(error_of("k", text) == "values of k: expected V1,V2,... or FIRST:LAST:COUNT");
  for (const char* text : {"2:1:3", "0:1:3", "1:2:1", "1:2:1001", "1:2:2.5"})
    CHECK(error_of("k", text) == "values of k: " + std::string(text) +
                                     " is no range with 0 < FIRST < LAST and 2 to 1000 values");
}

TEST_CASE("grid: a range goes from its first to its last value in equal steps") {
  CHECK(range_values("w", "0.02:0.04:5") == Texts{"0.02", "0.025", "0.03", "0.035", "0.04"});
  CHECK(range_values("w", "8:2:4") == Texts{"8", "6", "4", "2"});
  CHECK(range_values("w", "-1:1:3") == Texts{"-1", "0", "1"});
  CHECK(range_values("w", "0:0.3:4") == Texts{"0", "0.1", "0.2", "0.3"});
  // What does not begin like one is a value.
  for (const char* text : {"4", "jet", "a:b:c", "{x: 1}", "[0, 0, 1]", "C:/p.csv", ""})
    CHECK(range_values("w", text) == Texts{text});
  for (const char* text : {"1:2", "1:2:", "1:2:x", "1:2:1", "1:2:1001", "1:2:2.5", "1:1:3", "1::3",
                           "1:2:3:4", "1:nan:3"}) {
    CAPTURE(text);
    CHECK_THROWS_WITH(range_values("w", text),
                      Catch::Matchers::StartsWith("w: \"" + std::string(text)));
  }
}
