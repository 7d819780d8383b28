#include "lib/program/list_memory.h"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>

#include "kernels/smoothing.h"
#include "lib/program/list_capacity.h"
#include "lib/program/plan.h"
#include "lib/program/simd.h"
#include "lib/program/threads.h"

namespace pbf::program_module {
namespace {

bool has_random_places(const Scene& s) {
  return std::any_of(s.bodies.begin(), s.bodies.end(),
                     [](const Body& b) { return b.shape == Shape::random_box; });
}

/// Lists are as long as the longest of the particles of a vector: the mean of the largest of 1, 2,
/// 4, 8 or 16 normally distributed numbers, in standard deviations.
double deviations_of_longest(const Scene& s) {
  constexpr double of[] = {0, 0.56, 1.03, 1.42, 1.77};
  return of[lane_bits(chosen_simd(), std::size_t(size_of(word(s.precision))))];
}

/// Entries of the list of a particle with so many within h: it is not in its own list.
int in_list(int count) { return std::max(0, count - 1); }

/// Entries of one list, including padding to the longest of its group: mean and maximum. 0 if the
/// start was not counted.
struct StartEntries {
  double mean = 0, most = 0;
};
StartEntries start_entries(const Scene& s, const Plan& plan) {
  StartEntries e;
  const bool random = has_random_places(s);
  const double n = double(plan.start.count.size()), deviations = deviations_of_longest(s);
  for (std::size_t i = 0; i < plan.start.count.size(); ++i) {
    // At random positions the counts scatter at least like a Poisson distribution. Otherwise they
    // differ by up to a fifth between the surface and the inside of a body.
    const double m = in_list(plan.start.count[i]), poisson = deviations * std::sqrt(m);
    const double entries = m + std::max(random ? poisson : std::min(poisson, 0.2 * m),
                                        deviations * plan.start.scatter[i]);
    e.mean += entries / n;
    e.most = std::max(e.most, entries);
  }
  return e;
}

/// Rows in use at the start; emitters may bring more, up to Plan::capacity.
std::int64_t at_start(const Plan& plan) {
  return std::min(plan.particles + plan.images, plan.capacity);
}

/// The capacity after it has grown for the lists of the start, as in the solver. What emitters
/// bring later comes on a lattice, with fewer neighbors.
ListCapacity list_capacity(const Scene& s, const Plan& plan) {
  const std::int64_t n = plan.capacity;
  ListCapacity capacity = first_list_capacity(rest_neighbors(s), n);
  const std::vector<int>& sample = plan.start.count;
  if (sample.empty()) return capacity;
  const int longest = in_list(*std::max_element(sample.begin(), sample.end()));
  for (;;) {
    const auto more = std::count_if(sample.begin(), sample.end(),
                                    [&](int count) { return in_list(count) > 4 * capacity.first; });
    const auto overflows =
        std::int64_t(double(more) * double(at_start(plan)) / double(sample.size()));
    if (overflows <= capacity.overflows && longest <= capacity.longest()) return capacity;
    capacity =
        larger_list_capacity(capacity, overflows, longest > capacity.longest() ? longest : 0, n);
  }
}

}  // namespace

void add_cpu_lists(const Scene& s, const Plan& plan, const Adder& add) {
  const std::int64_t n = plan.capacity, chunks = (n + 1023) / 1024;
  const int entries = cpu_list_entries(s), threads = solver_threads(s, n);
  const StartEntries start = start_entries(s, plan);
  const double emitted = 1.1 * rest_neighbors(s);
  // Lists that outgrow their first memory get a reserve of an eighth, half of which is used.
  const double each = start.mean > entries ? 1.0625 * start.mean : entries;
  add("lists", "int32", 1,
      std::int64_t(double(at_start(plan)) * each + double(n - at_start(plan)) * emitted));
  add("groups of lists", "int32", 2, chunks * 1024 / 8);
  add("columns of coordinates", word(s.precision), s.dimensions, n);
  add("table of lists", "int64", 3, chunks);
  // The lists of a group, each with room for a vector, and what over-dense starts take beside them;
  // a reserve of a quarter.
  const double all = double(n), longest = std::min(all, std::max(double(entries), start.most));
  const double found =
      std::min(all, 16.0) * longest + std::min(all * all / 4, 8 * longest) + 16 * 16;
  add("neighbors found by each thread", "int32", 1,
      std::min<std::int64_t>(threads, chunks) * std::int64_t(1.25 * found));
}

void add_cuda_lists(const Scene& s, const Plan& plan, std::int64_t bins, bool rank,
                    const Adder& add) {
  const std::int64_t n = plan.capacity;
  const ListCapacity capacity = list_capacity(s, plan);
  if (rank || n > kSortParticles || bins > kSortBins) {
    add("particles of each bin", "int32", 1, bins + 1);
    add("scratch of the scan", "byte", 1, bins / 240 + 1024);  // CUB: 16 bytes a tile
  }
  add("slot", "int32", 1, n);
  add("lists", "int32", 4, std::int64_t(list_stride(int(n))) * capacity.first);
  add("overflow of long lists", "int32", 4, std::int64_t(capacity.overflows) * capacity.overflow);
  add("length of a list", "int32", 1, n);
  add("overflow of a list", "int32", 1, n);
}

double rest_neighbors(const Scene& s) {
  const double ratio = s.fluid.smoothing_ratio;
  return s.dimensions == 2 ? kPi * ratio * ratio : 4.0 / 3.0 * kPi * std::pow(ratio, 3);
}

int cpu_list_entries(const Scene& s) {
  const double mean = rest_neighbors(s);
  const double spread = deviations_of_longest(s) * std::sqrt(mean);
  const double entries = has_random_places(s) ? mean + spread : 1.1 * mean;
  return std::clamp(int(std::ceil(entries)), 1, 1 << 20);
}

DenseStart dense_start(const Scene& s, const Plan& plan) {
  DenseStart dense;
  for (const int m : plan.start.count) dense.neighbors += m / double(plan.start.count.size());
  dense.decides = start_entries(s, plan).mean > cpu_list_entries(s);
  return dense;
}

std::string memory_remedy(const Scene& s, const Plan& plan) {
  const DenseStart dense = dense_start(s, plan);
  if (!dense.decides) return "increase fluid.spacing";
  return fmt::format(
      "its particles start so close that each has about {:.0f} neighbors within h = {:g} m, where "
      "fluid at rest has {:.0f}, and each takes room in a list: spread the bodies (bodies[].min, "
      "max), give fewer particles (bodies[].count)",
      dense.neighbors, s.h(), rest_neighbors(s));
}

}  // namespace pbf::program_module
