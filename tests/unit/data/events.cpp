// Lags, means and events of series whose answers are known.
#include <cmath>

#include "lib/data/series.h"
#include "tests/support/catch.h"

using namespace pbf;

namespace {

struct Waves {
  std::vector<double> time, value;
  Waves(double from, double to, double step, auto&& f) {
    for (int k = 0; from + k * step <= to + 1e-12; ++k)
      time.push_back(from + k * step), value.push_back(f(from + k * step));
  }
  TimeSeries series(bool means = false) const { return {time, value, means}; }
};

/// A pulse without symmetry.
double pulse(double t) {
  return std::exp(-(t - 2) * (t - 2)) + 0.3 * std::exp(-9 * (t - 3) * (t - 3));
}

}  // namespace

TEST_CASE(
    "a copy of the readings that is shifted by whole readings is found without a difference") {
  const Waves own(0, 6, 0.01, pulse);
  for (const int shift : {0, 7, -13}) {
    Waves data = own;
    for (double& t : data.time) t -= 0.01 * shift;
    const auto lag = fit_lag(own.series(), data.series(), {}, -0.2, 0.2);
    REQUIRE(lag);
    CHECK(lag->lag == Approx(0.01 * shift).margin(1e-12));
    CHECK_FALSE(lag->at_end);
    SeriesOptions o;
    o.lag = lag->lag;
    CHECK(compare_series(own.series(), data.series(), o).rms < 1e-12);
  }
}

TEST_CASE("a lag between two readings is found to a tenth of a reading") {
  const Waves own(0, 6, 0.02, [](double t) { return pulse(t - 0.0537); });
  const Waves data(0.5, 5, 0.05, pulse);
  const auto lag = fit_lag(own.series(), data.series(), {}, -0.2, 0.2);
  REQUIRE(lag);
  CHECK(lag->lag == Approx(0.0537).margin(0.002));
}

TEST_CASE(
    "a fitted lag at the end of its range says so, and nothing is fitted to what never changes") {
  const Waves own(0, 6, 0.02, [](double t) { return pulse(t - 0.5); });
  const Waves data(0.5, 5, 0.05, pulse);
  const auto lag = fit_lag(own.series(), data.series(), {}, -0.2, 0.2);
  REQUIRE(lag);
  CHECK(lag->at_end);
  CHECK(lag->lag == Approx(0.2).margin(0.01));
  const Waves still(0, 6, 0.02, [](double) { return 3.0; });
  CHECK_FALSE(fit_lag(still.series(), data.series(), {}, -0.2, 0.2));
  CHECK_FALSE(fit_lag(own.series(), Waves(40, 50, 0.1, pulse).series(), {}, -0.2, 0.2));
}

TEST_CASE("the lag of a wave is that within its range, not one period away") {
  const auto wave = [](double t) { return std::sin(2 * M_PI * t); };
  const Waves own(0, 20, 0.01, [&](double t) { return wave(t - 0.1); });
  const Waves data(1, 18, 0.013, wave);
  const auto lag = fit_lag(own.series(), data.series(), {}, -0.4, 0.4);
  REQUIRE(lag);
  CHECK(lag->lag == Approx(0.1).margin(0.001));
}

TEST_CASE("the area under readings is that of the line through them, or of means") {
  const std::vector<double> time{0, 1, 3}, value{2, 4, 0};
  const TimeSeries line{time, value}, means{time, value, true};
  CHECK(area_under(line, 0, 3).integral == Approx(3 + 4));
  CHECK(area_under(line, 0.5, 1).integral == Approx(0.5 * 3.5));
  CHECK(area_under(line, -5, 9).length == Approx(3));
  CHECK(area_under(means, 0, 3).integral == Approx(4));
  CHECK(area_under(means, 0.5, 2).integral == Approx(2));
  CHECK(area_under(line, 4, 5).length == 0);
  const std::vector<double> gap{2, NAN, 0};
  CHECK(area_under({time, gap}, 0, 3).length == 0);
}

TEST_CASE("a mean over a window has no value where less than half of it was measured") {
  const Waves line(0, 1, 0.1, [](double t) { return t; });
  CHECK(mean_about(line.series(), 0.5, 0.4) == Approx(0.5));
  CHECK(mean_about(line.series(), 0.0, 0.4) == Approx(0.1));  // half of it is there
  CHECK(std::isnan(mean_about(line.series(), -0.05, 0.4)));
  CHECK(mean_about(line.series(), 0.5, 0) == Approx(0.5));
}

TEST_CASE("peak and arrival are found on both sides, with their times") {
  const Waves own(0, 6, 0.01, pulse);
  const SeriesEvents up = events_of(own.series(), 0, 6, 1, 0.5);
  CHECK(up.peak_time == Approx(2).margin(0.01));
  CHECK(up.peak == Approx(1).margin(0.01));
  // exp(-(t - 2)^2) = 0.5
  CHECK(up.arrival == Approx(2 - std::sqrt(std::log(2.0))).margin(1e-3));
  Waves down = own;
  for (double& v : down.value) v = -v;
  const SeriesEvents low = events_of(down.series(), 0, 6, -1, -0.5);
  CHECK(low.peak == Approx(-up.peak));
  CHECK(low.arrival == Approx(up.arrival));
  CHECK(std::isnan(events_of(own.series(), 0, 6, 1, 7).arrival));
  CHECK(std::isnan(events_of(own.series(), 8, 9, 1, 0).peak));
}
