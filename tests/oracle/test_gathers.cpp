// What a pass says it reads of its neighbours' rows is what it reads: with everything else of them
// spoilt its result is the same to the last bit, and with any field of it spoilt it is not.
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include "kernels/pass_delta.h"
#include "kernels/pass_lambda.h"
#include "kernels/pass_vorticity.h"
#include "kernels/pass_xsph.h"
#include "lib/exec/cpu/cpu_exec.h"
#include "tests/support/catch.h"

using namespace pbf;

namespace {

template <class Real>
struct Rows {
  std::vector<Vec4<Real>> position, velocity, curl;
  std::vector<Real> density;
  std::vector<int> id, bin;
};

template <class Real>
Params<Real> parameters() {
  Params<Real> p;
  p.boundary.extent = {Real(3), Real(3), Real(3)};
  p.cells_x = 8, p.cells_y = p.cells_z = p.layers = 4;
  p.dt = Real(0.01), p.inv_dt = Real(100);
  p.vol = Real(0.1);
  p.tensile_k = Real(0.01), p.tensile_scale = Real(2);
  p.xsph = Real(0.3), p.vorticity = Real(2);
  return p;
}

/// 400 particles in the order of bins, some of them in one place.
template <class Real, int D>
Rows<Real> random_rows(Params<Real>& p) {
  std::mt19937 gen(9);
  const auto r = [&] { return Real(double(gen()) / 4294967295.0); };
  Rows<Real> rows;
  std::vector<Vec4<Real>> x;
  const auto flat = [](Vec4<Real> v) {
    if (D == 2) v.y = 0;
    return v;
  };
  for (int i = 0; i < 400; ++i) {
    x.push_back(flat({3 * r(), 3 * r(), 3 * r(), Real(0.8) + r()}));
    if (i % 40 == 39) x[std::size_t(i)] = x[std::size_t(i) - 1];
  }
  p.dimensions = D;
  if (D == 2) p.cells_y = 1;
  std::vector<int> bin, id(x.size()), order(x.size()), start(std::size_t(bin_count(p)) + 1);
  for (const auto& at : x) bin.push_back(bin_of<D>(xyz(at), p));
  std::iota(id.begin(), id.end(), 0);
  CpuExec(1).sort(bin.data(), id.data(), int(x.size()), bin_count(p), order.data(), start.data());
  for (const int k : order) {
    rows.position.push_back(x[std::size_t(k)]);
    rows.velocity.push_back(flat({r(), r(), r(), 0}));
    rows.curl.push_back({r(), r(), r(), r()});
    rows.density.push_back(Real(0.7) + r());
    rows.id.push_back(k);
    rows.bin.push_back(0);
  }
  // The far particle that fills up lists.
  rows.position.push_back({Real(1e9), Real(1e9), Real(1e9), 1});
  rows.velocity.push_back({});
  rows.curl.push_back({});
  return rows;
}

/// Every row but `i`, those fields.
template <class Real>
void spoil(Rows<Real>& rows, int i, unsigned fields) {
  const Real nan = std::numeric_limits<Real>::quiet_NaN();
  for (int j = 0; j < int(rows.density.size()); ++j) {
    if (j == i) continue;
    const auto k = std::size_t(j);
    auto& x = rows.position[k];
    if (fields & kPlace) x.x = x.y = x.z = nan;
    if (fields & (kLambda | kInverseDensity)) x.w = nan;
    if (fields & kVelocity) rows.velocity[k] = {nan, nan, nan, nan};
    if (fields & kCurl) rows.curl[k] = {nan, nan, nan, nan};
    if (fields & kId) rows.id[k] += 100000;
    rows.density[k] = nan;  // of its own row alone, in every pass
  }
}

/// make(rows in, rows out) gives the pass, which writes into `out`.
template <class Real, int D, class Make>
void check(const Make& make) {
  Params<Real> p = parameters<Real>();
  const Rows<Real> rows = random_rows<Real, D>(p);
  const int n = int(rows.density.size());
  std::vector<int> start(std::size_t(bin_count(p)) + 1, 0);
  for (int i = 0; i < n; ++i)
    ++start[std::size_t(bin_of<D>(xyz(rows.position[std::size_t(i)]), p)) + 1];
  for (std::size_t b = 1; b < start.size(); ++b) start[b] += start[b - 1];
  CpuExec exec(1);
  const ChunkedLists lists = exec.build_lists(n, n, rows.position.data(), start.data(), p);

  const auto result = [&](Rows<Real> in, int i) {
    Rows<Real> out = in;
    sum_over_neighbors(make(p, lists, in, out), i);
    const auto k = std::size_t(i);
    std::vector<Real> all{out.density[k]};
    for (const auto* v : {&out.position[k], &out.velocity[k], &out.curl[k]})
      all.insert(all.end(), {v->x, v->y, v->z, v->w});
    return all;
  };
  const auto same = [](const std::vector<Real>& a, const std::vector<Real>& b) {
    return std::memcmp(a.data(), b.data(), a.size() * sizeof(Real)) == 0;
  };
  Rows<Real> any = rows;
  const unsigned gathers = decltype(make(p, lists, any, any))::gathers;
  REQUIRE((gathers & kPlace) != 0);
  unsigned seen = 0;
  for (int i = 0; i < n; ++i) {
    const std::vector<Real> expected = result(rows, i);
    Rows<Real> spoilt = rows;
    unsigned others = ~gathers;
    if (gathers & (kLambda | kInverseDensity)) others &= ~unsigned(kLambda | kInverseDensity);
    spoil(spoilt, i, others);
    REQUIRE(same(result(spoilt, i), expected));
    for (unsigned field = kPlace; field <= kId; field *= 2) {
      if (!(gathers & field) || (seen & field)) continue;
      spoilt = rows;
      spoil(spoilt, i, field);
      if (!same(result(spoilt, i), expected)) seen |= field;
    }
  }
  CHECK(seen == gathers);
}

template <class Real, Smoothing S>
void check_all() {
  constexpr int D = dimensions_of(S);
  using P = Params<Real>;
  using L = ChunkedLists;
  using R = Rows<Real>;
  static StepCounts counts;  // no row is marked: nothing is counted
  check<Real, D>([](const P& p, const L& lists, R& in, R& out) {
    return DensityPass<Real, L, S, Box<Real>>{p, p.boundary, lists, in.position.data(),
                                              out.density.data()};
  });
  check<Real, D>([](const P& p, const L& lists, R& in, R& out) {
    return LambdaPass<Real, L, S, true, Box<Real>>{p,
                                                   p.boundary,
                                                   lists,
                                                   in.position.data(),
                                                   out.position.data(),
                                                   out.density.data(),
                                                   in.velocity.data(),
                                                   &counts};
  });
  check<Real, D>([](const P& p, const L& lists, R& in, R& out) {
    return LambdaPass<Real, L, S, false, Box<Real>>{p,
                                                    p.boundary,
                                                    lists,
                                                    in.position.data(),
                                                    out.position.data(),
                                                    in.density.data(),
                                                    in.velocity.data(),
                                                    &counts};
  });
  const auto delta = [](auto tensile) {
    return [](const P& p, const L& lists, R& in, R& out) {
      return DeltaPass<Real, L, S, decltype(tensile)::value, NoLevelMove<Real>, Box<Real>>{
          p,
          p.boundary,
          lists,
          in.position.data(),
          in.density.data(),
          in.id.data(),
          out.position.data(),
          out.velocity.data(),
          nullptr};
    };
  };
  check<Real, D>(delta(std::false_type{}));
  check<Real, D>(delta(std::true_type{}));
  check<Real, D>([](const P& p, const L& lists, R& in, R& out) {
    return XsphPass<Real, L, S, Box<Real>>{p,
                                           p.boundary,
                                           lists,
                                           in.position.data(),
                                           in.velocity.data(),
                                           out.velocity.data(),
                                           out.bin.data()};
  });
  check<Real, D>([](const P& p, const L& lists, R& in, R& out) {
    return CurlPass<Real, L, D>{p, lists, in.position.data(), in.velocity.data(), out.curl.data()};
  });
  check<Real, D>([](const P& p, const L& lists, R& in, R& out) {
    return VorticityPass<Real, L, D>{p, lists, in.position.data(), in.curl.data(),
                                     out.velocity.data()};
  });
}

}  // namespace

TEMPLATE_TEST_CASE("a pass reads of its neighbours the fields that it names, and no others", "",
                   float, double) {
  check_all<TestType, Smoothing::consistent>();
  check_all<TestType, Smoothing::paper>();
  check_all<TestType, Smoothing::consistent_2d>();
  check_all<TestType, Smoothing::paper_2d>();
}
