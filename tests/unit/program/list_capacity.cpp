// The memory of lists on a device: how it grows.
#include "lib/program/list_capacity.h"

#include "tests/support/catch.h"

using namespace pbf;

TEST_CASE("lists that have grown are neither short of memory nor nearly") {
  for (const int longest : {0, 65, 68, 69, 100, 1000, 100000})
    for (const std::int64_t overflows : {0, 90, 100, 101, 5000}) {
      CAPTURE(longest, overflows);
      const ListCapacity before{9, 8, 100};
      const ListCapacity after = larger_list_capacity(before, overflows, longest, 100000);
      CHECK(longest <= after.nearly_longest());
      CHECK(overflows <= after.nearly_overflows());
      CHECK(after.longest() >= before.longest());
    }
}

TEST_CASE("if one list in eight outgrows its first words, all have half as many more") {
  const ListCapacity after = larger_list_capacity({9, 8, 157}, 160, 0, 1000);
  CHECK(after.first == 14);
  CHECK(after.overflow == 8);
  CHECK(after.overflows == 157);
}
