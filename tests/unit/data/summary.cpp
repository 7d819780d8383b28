// The largest mean of a force over a window, from impulses.
#include <cmath>
#include <vector>

#include "lib/data/summary.h"
#include "tests/support/catch.h"

using namespace pbf;

namespace {

struct Impulses {
  std::vector<double> time{}, value{};
  /// Of forces (N) that each last `step` s.
  Impulses(double step, const std::vector<double>& force) {
    double sum = 0;
    time.push_back(0), value.push_back(0);
    for (std::size_t k = 0; k < force.size(); ++k) {
      sum += step * force[k];
      time.push_back(double(k + 1) * step), value.push_back(sum);
    }
  }
  double peak(double from = 0, double window = kLoadWindow) const {
    return window_peak(time, value, from, window);
  }
};

}  // namespace

TEST_CASE("the peak of a force is that of its window, however often it was measured") {
  std::vector<double> force(100, 1.0);  // of 2 ms
  for (int k = 40; k < 50; ++k) force[std::size_t(k)] = 9;
  force[70] = 30;  // short: (30 + 9 * 1)/10 over 20 ms
  const Impulses fine(0.002, force);
  CHECK(fine.peak() == Approx(9));
  // The same impulses, every fifth and every tenth row.
  for (const std::size_t every : {5, 10}) {
    Impulses some(1, {});
    for (std::size_t k = every; k < fine.time.size(); k += every)
      some.time.push_back(fine.time[k]), some.value.push_back(fine.value[k]);
    CHECK(some.peak() == Approx(fine.peak()).epsilon(1e-12));
  }
  CHECK(fine.peak(0, 0.002) == Approx(30));
  CHECK(fine.peak(0, 0.2) == Approx(2.09));  // the whole of it
  CHECK(fine.peak(0.1) == Approx(3.9));
  CHECK(fine.peak(0.091) == Approx(4.6));  // from between two rows
}

TEST_CASE("the peak of a force has its sign") {
  std::vector<double> force(50, -2.0);
  for (std::size_t k = 20; k < 30; ++k) force[k] = 1.5;
  CHECK(Impulses(0.002, force).peak() == Approx(-2));
}

TEST_CASE("a series that is shorter than the window, or measured too coarsely, has no peak") {
  CHECK(std::isnan(Impulses(0.002, std::vector<double>(9, 1)).peak()));
  CHECK(Impulses(0.002, std::vector<double>(10, 1)).peak() == Approx(1));
  CHECK(std::isnan(Impulses(0.021, std::vector<double>(9, 1)).peak()));
  CHECK(Impulses(0.02, std::vector<double>(9, 1)).peak() == Approx(1));
  CHECK(std::isnan(Impulses(0.002, std::vector<double>(100, 1)).peak(0.19)));
  CHECK(std::isnan(Impulses(0.002, std::vector<double>(100, 1)).peak(5)));
  CHECK(std::isnan(Impulses(1, {}).peak()));
  // One gap in it is enough: the peak may have been there. Before `from` it does not count.
  Impulses gap(0.002, std::vector<double>(100, 1));
  gap.time.erase(gap.time.begin() + 20, gap.time.begin() + 40);
  gap.value.erase(gap.value.begin() + 20, gap.value.begin() + 40);
  CHECK(std::isnan(gap.peak()));
  CHECK(gap.peak(0.1) == Approx(1));
}
