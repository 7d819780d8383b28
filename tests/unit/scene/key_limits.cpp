// The ends of the ranges that the table of keys documents are those that are taken.
#include <cmath>
#include <limits>

#include "lib/scene/number.h"
#include "lib/scene/value.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

/// Every number of a key set to this text; the problem.
std::string problem_of(const Key& key, const std::string& number) {
  const std::string now = value_text(key, key.standard);
  const Field field = key.field(key.standard);
  std::string text = number;
  if (std::holds_alternative<Double3*>(field) ||
      std::holds_alternative<std::optional<Double3>*>(field))
    text = "[" + number + ", " + number + ", " + number + "]";
  if (std::holds_alternative<std::array<int, 2>*>(field) ||
      std::holds_alternative<std::optional<std::array<double, 2>>*>(field))
    text = "[" + number + ", " + number + "]";
  if (const auto* list = std::get_if<std::vector<double>*>(&field)) {
    const std::vector<double> before = **list;  // which may be empty, and could not be read
    const std::string problem =
        read_field(key, parse_yaml("[" + number + "]", "test", false), field);
    **list = before;
    return problem;
  }
  const std::string problem = read_field(key, parse_yaml(text, "test", false), field);
  read_field(key, parse_yaml(now, "test", false), field);  // the standard stays what it is
  return problem;
}

/// "> 0 .. 100" -> the two, as range_text() has them.
std::pair<std::string, std::string> documented(const Key& key) {
  const std::string text = range_text(key);
  const std::size_t dots = text.find(" .. ");
  std::string low = text.substr(0, dots), high = text.substr(dots + 4);
  high = high.substr(0, high.find(" | "));
  if (low.rfind("> ", 0) == 0) low = low.substr(2);
  if (high.rfind("< ", 0) == 0) high = high.substr(2);
  return {low, high};
}

bool is_whole(const Key& key) {
  const Field field = key.field(key.standard);
  return std::holds_alternative<int*>(field) || std::holds_alternative<std::int64_t*>(field) ||
         std::holds_alternative<std::uint64_t*>(field) ||
         std::holds_alternative<std::array<int, 2>*>(field);
}

/// The next number in plain digits; those here do not end in 9 or 0.
std::string next_whole(std::string digits, int step) {
  if (digits == "0") return step < 0 ? "-1" : "1";
  if (digits.back() == '0') return std::to_string(std::stoll(digits) + step);
  digits.back() = char(digits.back() + step);
  return digits;
}

}  // namespace

TEST_CASE("limits: what is documented as the least and the most is taken, the next is not") {
  int looked_at = 0;
  for (const Key& key : scene_table().keys) {
    if (!is_numeric(key.field(key.standard)) || !std::isfinite(key.range.min)) continue;
    const auto [low, high] = documented(key);
    CAPTURE(key.path, low, high);
    ++looked_at;
    CHECK((problem_of(key, low) == "") == !key.range.above_min);
    CHECK((problem_of(key, high) == "") == !key.range.below_max);
    if (is_whole(key)) {
      CHECK(problem_of(key, next_whole(low, -1)) != "");
      CHECK(problem_of(key, next_whole(high, 1)) != "");
      continue;
    }
    constexpr double infinite = std::numeric_limits<double>::infinity();
    const double least = std::numeric_limits<double>::min();
    const auto beside = [&](double x, double toward) {
      return x == 0 ? std::copysign(least, toward) : std::nextafter(x, toward);
    };
    CHECK(problem_of(key, to_text(beside(key.range.min, -infinite))) != "");
    CHECK(problem_of(key, to_text(beside(key.range.max, infinite))) != "");
    CHECK(problem_of(key, to_text(beside(key.range.min, infinite))) == "");
    CHECK(problem_of(key, to_text(beside(key.range.max, -infinite))) == "");
  }
  CHECK(looked_at > 60);
}

TEST_CASE("limits: the largest seed, in a file, with --set and in the schema") {
  const std::string box = "[{shape: random_box, min: [0, 0, 0], max: [1, 1, 1], count: 5, seed: ";
  const std::string most = "9223372036854775807";
  CHECK(parse(with_bodies(box + most + "}]")).bodies[0].seed == 9223372036854775807u);
  CHECK(contains(resolved_yaml(parse(with_bodies(box + most + "}]"))), "seed: " + most));
  const std::string scene = with_bodies(box + "1}]");
  CHECK(parse(scene, {"bodies.0.seed=" + most}).bodies[0].seed == 9223372036854775807u);
  CHECK(parse(scene, {"bodies.0.seed=9007199254740993"}).bodies[0].seed == 9007199254740993u);
  for (const char* beyond : {"9223372036854775808", "18446744073709551615", "1e30"})
    CHECK(contains(parse_error(scene, {std::string("bodies.0.seed=") + beyond}), "too large"));
  CHECK(contains(parse_error(scene, {"bodies.0.seed=-1"}),
                 "\"-1\" is out of range, allowed: 0 .. " + most));
  for (const char* rounded : {"9.223372036854775807e18", "1e18", "9007199254740994.0"})
    CHECK(contains(parse_error(scene, {std::string("bodies.0.seed=") + rounded}),
                   "is too large to be exact with a point or an exponent; write all its digits"));
  CHECK(parse(scene, {"bodies.0.seed=9.007199254740992e15"}).bodies[0].seed == 1ull << 53);
  CHECK(contains(json_schema(), "\"maximum\": " + most));
  CHECK(contains(reference_markdown(), "| `seed` | 1 | 0 .. " + most + " |"));
}

}  // namespace pbf::scene_test
