// Text for people and machines: numbers, durations, progress lines, JSON, and the stage clock.
#include "lib/base/text.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "lib/base/json.h"
#include "lib/base/log.h"
#include "lib/base/stage_clock.h"
#include "tests/support/catch.h"

using namespace pbf;

TEST_CASE("numbers get three digits and a prefix, also just below a power of a thousand") {
  CHECK(si_number(0) == "0");
  CHECK(si_number(999) == "999");
  CHECK(si_number(999.9) == "1 k");
  CHECK(si_number(12345678) == "12.3 M");
  CHECK(si_number(2e15) == "2e+03 T");
  CHECK(bytes_text(1023) == "1023 B");
  CHECK(bytes_text(1536) == "1.5 KiB");
  CHECK(bytes_text(1024.0 * 1024 * 1024) == "1.0 GiB");
}

TEST_CASE("durations never show 60 seconds or 60 minutes, and tell when they are unknown") {
  CHECK(duration_text(0.04) == "0.0 s");
  CHECK(duration_text(9.96) == "10 s");
  CHECK(duration_text(59.6) == "1 min 00 s");
  CHECK(duration_text(3599.9) == "1 h 00 min");
  CHECK(duration_text(7500) == "2 h 05 min");
  CHECK(duration_text(std::numeric_limits<double>::infinity()) == "unknown");
}

TEST_CASE("JSON keeps the order, escapes text and has null for what it lacks") {
  const Json o{{"z", 1.5},
               {"a", "q\"\\\n\t\x01"},
               {"none", nullptr},
               {"inf", -std::numeric_limits<double>::infinity()},
               {"nan", std::nan("")},
               {"list", {true, 3}}};
  CHECK(json_text(o) ==
        "{\"z\":1.5,\"a\":\"q\\\"\\\\\\n\\t\\u0001\",\"none\":null,\"inf\":null,"
        "\"nan\":null,\"list\":[true,3]}");
}

TEST_CASE("a progress line gives the rate since the last line and the time left at the mean rate") {
  ProgressState s{250, 1000, 2000, 0.5, 0.001, 0.02};
  // 50 updates of 2000 particles in the last 2 s; a quarter of the work took 10 s.
  const std::string line = progress_line(s, 10, 2, 50);
  CHECK(line ==
        " 25 %  update 250/1000  0.5 s simulated  50 k particle-updates/s  compression mean 0.1 %, "
        "max 2 %  30 s to go");
  s.update = 1000;
  CHECK(progress_line(s, 40, 2, 50).find("to go") == std::string::npos);
}

TEST_CASE("the stage clock sums per name, keeps the order, and books nothing before begin") {
  StageClock clock;
  clock.add("grid", 1.5);
  clock.add("lambda", 2);
  clock.add("grid", 0.5, 3);
  REQUIRE(clock.entries().size() == 2);
  CHECK(clock.entries()[0].name == "grid");
  CHECK(clock.entries()[0].seconds == Approx(2));
  CHECK(clock.entries()[0].calls == 4);
  const Stopwatch wait;
  while (wait.seconds() < 0.02) {
  }
  clock.begin();
  clock.mark("delta");
  CHECK(clock.entries()[2].seconds >= 0);
  CHECK(clock.entries()[2].seconds < 0.02);
}
