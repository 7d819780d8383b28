// Neighbor lists of the CPU executor against all pairs.
#include <algorithm>
#include <numeric>
#include <random>
#include <set>
#include <utility>

#include "lib/exec/cpu/cpu_exec.h"
#include "tests/support/catch.h"

using namespace pbf;

namespace {

/// Positions in units of h; checks every list against brute force, in the same precision. D:
/// dimensions.
template <int D, class Real>
void check_lists(Simd simd, const std::vector<Vec4<Real>>& x, Vec3<Real> box, int nx, int ny,
                 int nz, int threads) {
  Params<Real> p;
  const int n = int(x.size());
  p.boundary.extent = box;
  p.dimensions = D;
  p.cells_x = 2 * nx;
  p.cells_y = ny;
  p.cells_z = nz;
  CpuExec exec(threads, 37, simd);
  std::vector<int> cell(x.size()), id(x.size()), order(x.size()),
      start(std::size_t(bin_count(p)) + 1);
  for (int i = 0; i < n; ++i) cell[std::size_t(i)] = bin_of<D>(xyz(x[std::size_t(i)]), p);
  std::iota(id.begin(), id.end(), 0);
  std::shuffle(id.begin(), id.end(), std::mt19937(5));
  exec.sort(cell.data(), id.data(), n, {0, bin_count(p)}, order.data(), start.data());

  std::vector<Vec4<Real>> sorted(x.size());
  for (std::size_t k = 0; k < x.size(); ++k) {
    sorted[k] = x[std::size_t(order[k])];
    if (k > 0) {
      const auto key = [&](std::size_t at) {
        const auto row = std::size_t(order[at]);
        return std::make_pair(cell[row], id[row]);
      };
      REQUIRE(key(k - 1) < key(k));
    }
  }
  const auto lists = exec.build_lists(n, n, sorted.data(), start.data(), p);
  for (int i = 0; i < n; ++i) {
    std::vector<int> found, expected;
    lists.for_each(i, [&](Neighbor j) { found.push_back(j.row); });
    for (int j = 0; j < n; ++j) {
      const auto &a = sorted[std::size_t(i)], &b = sorted[std::size_t(j)];
      const Real dx = a.x - b.x, dy = a.y - b.y, dz = a.z - b.z;
      if (i != j && (D == 2 ? dx * dx + dz * dz : dx * dx + dy * dy + dz * dz) < Real(1))
        expected.push_back(j);
    }
    REQUIRE(lists.size(i) == int(found.size()));
    REQUIRE(found == expected);  // the order too: ascending
  }
}

/// With all vector instructions that there are.
template <class Real, int D = 3>
void check_lists(const std::vector<Vec4<Real>>& x, Vec3<Real> box, int nx, int ny, int nz,
                 int threads = 2) {
  for (const Simd simd : usable_simd()) {
    CAPTURE(simd_name(simd));
    check_lists<D>(simd, x, box, nx, ny, nz, threads);
  }
}

template <class Real>
std::vector<Vec4<Real>> random_points(int n, double lo, double hi) {
  std::mt19937 gen(7);
  std::vector<Vec4<Real>> x;
  auto r = [&] { return Real(lo + (hi - lo) * double(gen()) / 4294967295.0); };
  for (int i = 0; i < n; ++i) {
    const Real a = r(), b = r(), c = r();
    x.push_back({a, b, c, 0});
  }
  return x;
}

}  // namespace

TEMPLATE_TEST_CASE("neighbor lists hold exactly the pairs closer than h", "[slow]", float, double) {
  using R = TestType;
  SECTION("random points") { check_lists<R>(random_points<R>(3000, 0, 5), {5, 5, 5}, 6, 6, 6); }
  SECTION("random points, many more than one chunk and one cell") {
    check_lists<R>(random_points<R>(4000, 0, 1.5), {2, 2, 2}, 3, 3, 3);
  }
  SECTION("negative coordinates and points far outside the grid") {
    check_lists<R>(random_points<R>(1500, -4, 7), {3, 3, 3}, 3, 3, 3);
  }
  SECTION("points many grids away, on both sides of a place where the grid is mirrored") {
    check_lists<R>(random_points<R>(1500, 27, 33), {3, 3, 3}, 6, 3, 3);
    check_lists<R>(random_points<R>(1500, -33, -27), {3, 3, 3}, 6, 3, 3);
    check_lists<R>(random_points<R>(1500, 1e5 - 3, 1e5 + 3), {3, 3, 3}, 7, 3, 4);
  }
  SECTION("a lattice on the faces and corners of the cells, pairs exactly at distance h") {
    std::vector<Vec4<R>> x;
    for (int k = 0; k < 1000; ++k)
      x.push_back({R(k % 10) / 2, R(k / 10 % 10) / 2, R(k / 100) / 2, 0});
    check_lists<R>(x, {5, 5, 5}, 6, 6, 6);
  }
  SECTION("coincident points: pairs, and 200 in one place") {
    auto x = random_points<R>(300, 0, 3);
    for (int i = 0; i < 300; ++i) x.push_back(x[std::size_t(i)]);
    for (int i = 0; i < 200; ++i) x.push_back({1, 1, 1, 0});
    check_lists<R>(x, {3, 3, 3}, 4, 4, 4);
  }
  SECTION("all in one cell, and a grid of one cell") {
    check_lists<R>(random_points<R>(500, 0.1, 0.9), {1, 1, 1}, 1, 1, 1);
    check_lists<R>(random_points<R>(500, 0, 2), {2, 2, 2}, 1, 1, 1);
  }
  SECTION("collinear and coplanar points") {
    auto x = random_points<R>(400, 0, 6);
    for (auto& p : x) p.y = p.z = 0;
    check_lists<R>(x, {6, 1, 1}, 7, 2, 2);
    x = random_points<R>(900, 0, 6);
    for (auto& p : x) p.z = R(0.25);
    check_lists<R>(x, {6, 6, 1}, 7, 7, 2);
  }
  SECTION("no particle and one particle") {
    check_lists<R>({}, {1, 1, 1}, 2, 2, 2);
    check_lists<R>({{R(0.5), R(0.5), R(0.5), 0}}, {1, 1, 1}, 2, 2, 2);
  }
}

TEST_CASE("particles that have left the grid are spread over it, not piled up at its rim") {
  Params<double> p;
  p.cells_x = 8, p.cells_y = p.cells_z = 4;
  std::vector<int> count(std::size_t(bin_count(p)));
  const int n = 100000;
  for (const auto& x : random_points<double>(n, -1000, 1000))
    ++count[std::size_t(bin_of<3>(xyz(x), p))];
  const double mean = double(n) / double(count.size());
  CHECK(*std::min_element(count.begin(), count.end()) > mean / 2);
  CHECK(*std::max_element(count.begin(), count.end()) < mean * 2);
}

TEST_CASE("any number of threads sorts by bin and id, and leaves out rows without a bin") {
  std::mt19937 gen(3);
  const int n = GENERATE(0, 1, 3, 9000, 40000), cells = 500;
  const bool sorted_before = GENERATE(false, true), all_leave = GENERATE(false, true);
  const BinRange range = GENERATE(BinRange{0, cells}, BinRange{100, 350}, BinRange{7, 8});
  std::vector<int> cell(std::size_t(n), 0);
  for (int& c : cell) c = all_leave ? -1 : int(gen() % cells);
  if (sorted_before) std::sort(cell.begin(), cell.end());
  for (int k = 0; k < n / 10; ++k) {  // strays, and rows that leave
    if (!all_leave) cell[gen() % std::size_t(n)] = int(gen() % cells);
    cell[gen() % std::size_t(n)] = -1;
  }
  std::vector<int> id(std::size_t(n), 0), expected, start(cells + 1, -5);
  std::iota(id.begin(), id.end(), 0);
  std::shuffle(id.begin(), id.end(), gen);
  for (int i = 0; i < n; ++i)
    if (range.has(cell[std::size_t(i)])) expected.push_back(i);
  std::sort(expected.begin(), expected.end(), [&](int a, int b) {
    const auto row = [&](int i) {
      return std::make_pair(cell[std::size_t(i)], id[std::size_t(i)]);
    };
    return row(a) < row(b);
  });
  for (int threads : {1, 2, 5, 16}) {
    CAPTURE(n, sorted_before, all_leave, range.begin, range.end, threads);
    CpuExec exec(threads);
    std::vector<int> order(std::size_t(n), 0);
    exec.sort(cell.data(), id.data(), n, range, order.data(), start.data());
    order.resize(expected.size());
    CHECK(order == expected);
    std::size_t before = 0;  // in the bins below
    for (int b = range.begin; b <= range.end; ++b) {
      while (before < expected.size() && cell[std::size_t(expected[before])] < b) ++before;
      REQUIRE(start[std::size_t(b)] == int(before));
    }
  }
}

TEMPLATE_TEST_CASE("in two dimensions too, from 9 cells", "", float, double) {
  using R = TestType;
  const auto flat = [](std::vector<Vec4<R>> x) {
    for (auto& p : x) p.y = 0;
    return x;
  };
  SECTION("random points") {
    check_lists<R, 2>(flat(random_points<R>(2000, 0, 14)), {14, 1, 14}, 15, 1, 15);
  }
  SECTION("outside the grid, and many in a cell") {
    check_lists<R, 2>(flat(random_points<R>(1500, -4, 7)), {3, 1, 3}, 3, 1, 3);
  }
  SECTION("a lattice on the faces of the cells, pairs exactly at distance h") {
    std::vector<Vec4<R>> x;
    for (int k = 0; k < 900; ++k) x.push_back({R(k % 30) / 2, 0, R(k / 30) / 2, 0});
    check_lists<R, 2>(x, {15, 1, 15}, 16, 1, 16);
  }
  SECTION("bins: halves of a cell along z, none along y") {
    Params<R> p;
    p.dimensions = 2;
    p.cells_x = 6;
    p.cells_z = 2;
    CHECK(bin_count(p) == 6 * 2 * 2);
    CHECK(bin_of<2>(Vec3<R>{R(0.1), 0, R(0.1)}, p) == 0);
    CHECK(bin_of<2>(Vec3<R>{R(0.1), 0, R(0.6)}, p) == 1);
    CHECK(bin_of<2>(Vec3<R>{R(0.6), 0, R(0.1)}, p) == 2);
    CHECK(bin_of<2>(Vec3<R>{R(2.9), 0, R(1.9)}, p) == bin_count(p) - 1);
  }
}

namespace {

/// Particles in the order of bins, with their lists.
template <int D, class Real>
struct Sorted {
  std::vector<int> id, start;
  std::vector<Vec4<Real>> x;
  std::vector<std::vector<int>> lists;  ///< ids

  /// Those with bins in `range`; lists are for those with bins in `listed`.
  Sorted(const Params<Real>& p, const std::vector<Vec4<Real>>& all, const BinRange& range,
         const BinRange& listed)
      : start(std::size_t(bin_count(p)) + 1) {
    std::vector<int> bin, order(all.size()), ids(all.size());
    std::iota(ids.begin(), ids.end(), 0);
    for (const auto& at : all) bin.push_back(bin_of<D>(xyz(at), p));
    for (const int b : bin) REQUIRE((b >= 0 && b < bin_count(p)));
    CpuExec exec(2);
    exec.sort(bin.data(), ids.data(), int(ids.size()), range, order.data(), start.data());
    const int n = start[std::size_t(range.end)];
    order.resize(std::size_t(n));
    for (const int k : order) {
      id.push_back(k);
      x.push_back(all[std::size_t(id.back())]);
    }
    const RowRange rows{start[std::size_t(listed.begin)], start[std::size_t(listed.end)]};
    const auto made = exec.build_lists(rows, n, x.data(), start.data(), p);
    lists.resize(id.size());
    for (int i = rows.first; i < rows.last; ++i)
      made.for_each(i,
                    [&](Neighbor j) { lists[std::size_t(i)].push_back(id[std::size_t(j.row)]); });
  }
};

/// The bins of the layers first..last-1 with one more on either side, against the whole grid: the
/// same particles in the same order, and the same lists of those between.
template <int D, class Real>
void check_slab(const std::vector<Vec4<Real>>& x, const Params<Real>& p, int first, int last) {
  const auto layer = [&](const Vec4<Real>& at) { return cell_of<D>(xyz(at), p).z; };
  const int low = std::max(first - 1, 0), high = std::min(last + 1, p.cells_z);
  const auto here = std::ranges::count_if(
      x, [&](const auto& at) { return layer(at) >= low && layer(at) < high; });
  const int of_layer = p.cells_x * p.cells_y * bins_per_cell(D);
  const BinRange between{first * of_layer, last * of_layer};
  const Sorted<D, Real> whole(p, x, {0, bin_count(p)}, between),
      slab(p, x, {low * of_layer, high * of_layer}, between);
  REQUIRE(slab.id.size() == std::size_t(here));
  const auto begin = std::size_t(whole.start[std::size_t(low * of_layer)]);
  std::size_t compared = 0;
  for (std::size_t k = 0; k < slab.id.size(); ++k) {
    REQUIRE(slab.id[k] == whole.id[begin + k]);
    const int z = layer(slab.x[k]);
    if (z < first || z >= last) continue;
    REQUIRE(slab.lists[k] == whole.lists[begin + k]);
    ++compared;
  }
  REQUIRE(compared > 0);
}

}  // namespace

TEMPLATE_TEST_CASE("a slab of the grid has the rows and the lists of the whole", "", float,
                   double) {
  using R = TestType;
  Params<R> p;
  p.cells_x = 10;
  p.cells_y = 4;
  p.cells_z = 9;
  // Some have left the grid through each face, many times its size away.
  std::vector<Vec4<R>> x = random_points<R>(3000, -1, 10);
  for (auto far : random_points<R>(500, -60, 60)) x.push_back(far);
  for (int i = 0; i < 40; ++i) x.push_back({R(1), R(2), R(3 + i % 2), 0});  // on a cut
  const std::vector<std::pair<int, int>> slabs{{0, 9}, {0, 3}, {3, 4}, {2, 7}, {8, 9}, {6, 9}};
  for (const auto& s : slabs) {
    CAPTURE(s.first, s.second);
    check_slab<3>(x, p, s.first, s.second);
  }
  p.dimensions = 2;
  p.cells_y = 1;
  for (auto& at : x) at.y = 0;
  for (const auto& s : slabs) {
    CAPTURE(s.first, s.second);
    check_slab<2>(x, p, s.first, s.second);
  }
}
