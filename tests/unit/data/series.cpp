// Comparison of two series of readings, on series whose differences are known.
#include <cmath>
#include <limits>

#include "lib/base/error.h"
#include "lib/data/series.h"
#include "tests/support/catch.h"

using namespace pbf;

namespace {

struct Samples {
  std::vector<double> time, value;
  Samples(std::size_t n, double step, auto&& f) {
    for (std::size_t k = 0; k < n; ++k) time.push_back(double(k) * step), value.push_back(f(k));
  }
  TimeSeries series() const { return {time, value}; }
};

double at(std::size_t k) { return double(k); }

}  // namespace

TEST_CASE("between two readings a value is on the line, at a reading it is the reading") {
  const std::vector<double> time{0, 1, 3}, value{2, 4, 0};
  const TimeSeries s{time, value};
  CHECK(value_at(s, 0) == 2);
  CHECK(value_at(s, 0.25) == Approx(2.5));
  CHECK(value_at(s, 1 + 1e-12) == 4);
  CHECK(value_at(s, 1 - 1e-12) == 4);
  CHECK(value_at(s, 2) == Approx(2));
  CHECK(value_at(s, 3) == 0);
  CHECK(std::isnan(value_at(s, -0.1)));
  CHECK(std::isnan(value_at(s, 3.1)));
  CHECK(std::isnan(value_at({}, 0)));
}

TEST_CASE("the RMS of a known difference is known, in the unit and relative to the range") {
  // Off by 3 and by 4 in turns: RMS sqrt(12.5), mean 3.5; the reference goes from 0 to 19.
  const Samples reference(20, 0.1, at);
  const Samples own(20, 0.1, [](std::size_t k) { return double(k) + (k % 2 ? 4 : 3); });
  const SeriesDifference d = compare_series(own.series(), reference.series());
  CHECK(d.rms == Approx(std::sqrt(12.5)));
  CHECK(d.bias == Approx(3.5));
  CHECK(d.range == 19);
  CHECK(d.rms_relative.value() == Approx(std::sqrt(12.5) / 19));
  CHECK(d.correlation.value() > 0.99);
  CHECK(d.points == 20);
  const Samples falls(20, 0.1, [](std::size_t k) { return -2 * double(k); });
  CHECK(compare_series(falls.series(), reference.series()).correlation.value() == Approx(-1));
}

TEST_CASE("a series has no difference from itself, and none from its own line at other times") {
  const Samples fine(41, 0.05, [](std::size_t k) { return 0.3 * double(k); });
  const Samples coarse(11, 0.2, [](std::size_t k) { return 1.2 * double(k); });
  const SeriesDifference d = compare_series(fine.series(), fine.series());
  CHECK(d.rms == 0);
  CHECK(d.rms_relative == 0);
  CHECK(d.correlation.value() == Approx(1));
  CHECK(compare_series(coarse.series(), fine.series()).rms < 1e-14);
  CHECK(compare_series(coarse.series(), fine.series()).points == 41);
  CHECK(compare_series(coarse.series(), fine.series()).interpolated == 30);
  CHECK(compare_series(fine.series(), coarse.series()).interpolated == 0);
  CHECK(compare_series(fine.series(), coarse.series()).points == 11);
}

TEST_CASE("times before `from` do not count, neither for the error nor for the range") {
  const Samples reference(40, 0.1, [](std::size_t k) { return k < 20 ? 1000.0 : double(k); });
  const Samples own(40, 0.1, [](std::size_t k) { return k < 20 ? 0 : double(k) + 2; });
  const SeriesDifference d = compare_series(own.series(), reference.series(), {.from = 2});
  CHECK(d.points == 20);
  CHECK(d.rms == Approx(2));
  CHECK(d.range == 19);
}

TEST_CASE("a reference that never changes has an RMS, but no share of its range") {
  const Samples still(12, 0.1, [](std::size_t) { return 5.0; });
  const SeriesDifference d = compare_series(Samples(12, 0.1, at).series(), still.series());
  CHECK(d.rms > 0);
  CHECK(d.range == 0);
  CHECK_FALSE(d.rms_relative);
  CHECK_FALSE(d.correlation);
}

TEST_CASE("too few common readings are an error with their numbers, never NaN") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto error = [](const Samples& own, const Samples& reference) {
    try {
      compare_series(own.series(), reference.series());
    } catch (const Error& e) {
      CHECK(e.code() == ExitCode::bad_input);
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  const Samples all(30, 0.1, at);
  CHECK(error(Samples(9, 0.1, at), Samples(9, 0.1, at)).rfind("9 of the reference's 9 rea", 0) ==
        0);
  CHECK(error(Samples(10, 0.1, at), Samples(10, 0.1, at)) == "accepted");
  CHECK(error(Samples(14, 0.1, at), all).rfind("14 of the reference's 30", 0) == 0);
  CHECK(error(Samples(15, 0.1, at), all) == "accepted");
  CHECK(error(Samples(30, 0.1, [&](std::size_t) { return nan; }), all).rfind("0 of the", 0) == 0);
  CHECK(error(all, Samples(30, 0.1, [&](std::size_t) { return nan; })).rfind("0 of the refer", 0) ==
        0);
  CHECK(error(all, Samples(0, 0.1, at)).rfind("0 of the reference's 0", 0) == 0);
  // A gauge that is dry at first is compared where both are wet.
  const Samples dry(30, 0.1, [&](std::size_t k) { return k < 10 ? nan : double(k) + 1; });
  const SeriesDifference d = compare_series(dry.series(), all.series());
  CHECK(d.points == 20);
  CHECK(d.rms == Approx(1));
}

TEST_CASE("at a step of a digitised curve both of its values count") {
  Samples data(24, 0.1, at);
  for (std::size_t k = 1; k < 24; k += 2) data.time[k] = data.time[k - 1];
  for (std::size_t k = 0; k < 24; ++k) data.value[k] = k % 2 ? 5 : 0;
  const Samples own(24, 0.1, [](std::size_t) { return 0.0; });
  const SeriesDifference d = compare_series(own.series(), data.series());
  CHECK(d.points == 24);
  CHECK(d.bias == Approx(-2.5));
  CHECK(d.range == 5);
}
