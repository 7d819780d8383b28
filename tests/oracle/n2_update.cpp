#include "tests/oracle/n2_levels.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace oracle {
namespace {

const Real pi = 3.141592653589793238462643383279502884L;

Real length(const V& a) { return sqrtl(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]); }
V sub(const V& a, const V& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
/// a - b for the images of both that are nearest to each other.
V apart(const V& a, const V& b, const Settings& c) {
  V d = sub(a, b);
  for (int k = 0; k < 3; ++k)
    if (c.period[k] > 0) d[k] -= c.period[k] * roundl(d[k] / c.period[k]);
  return d;
}
void axpy(V& y, Real a, const V& x) {
  for (int k = 0; k < 3; ++k) y[k] += a * x[k];
}
V cross(const V& a, const V& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

bool flat(const Settings& c) { return c.dimensions == 2; }

Real poly6(Real r, const Settings& c) {
  const Real h = c.h, norm = flat(c) ? 4 / (pi * powl(h, 8)) : 315 / (64 * pi * powl(h, 9));
  return r >= h ? 0 : norm * powl(h * h - r * r, 3);
}
Real spiky_norm(const Settings& c) {
  return flat(c) ? 10 / (pi * powl(c.h, 5)) : 15 / (pi * powl(c.h, 6));
}
Real spiky(Real r, const Settings& c) { return r >= c.h ? 0 : spiky_norm(c) * powl(c.h - r, 3); }

/// The polynomials of kernels/README.md (9) for half planes, and their derivative in q.
struct HalfPlane {
  Real density, slope;
};
HalfPlane half_plane(bool poly6, Real q) {
  if (q >= 1) return {0, 0};
  q = std::max<Real>(q, 0);
  const Real spiky_c[5] = {0.5L, 0.90627L, -0.19345L, 1.18431L, 0};
  const Real poly6_c[5] = {0.5L, 0.83646L, 0.31849L, -0.09827L, -0.75489L};
  const Real m = poly6 ? 4 : 5;
  HalfPlane out{0, 0};
  for (int k = 0; k < 5; ++k) {
    const Real c = (poly6 ? poly6_c : spiky_c)[k];
    out.density += c * powl(q, k) * powl(1 - q, m);
    out.slope -= c * m * powl(q, k) * powl(1 - q, m - 1);
    if (k > 0) out.slope += c * k * powl(q, k - 1) * powl(1 - q, m);
  }
  return out;
}

/// Mass fraction of the kernel behind a plane at distance a: the integral over spherical caps,
/// int_a^h W(r) 2 pi r (r - a) dr, by Gauss-Legendre (5 points, 64 panels): not a closed form.
Real half_space(const std::function<Real(Real)>& w, Real a, Real h) {
  a = std::max<Real>(a, 0);
  if (a >= h) return 0;
  static const Real node[3] = {0, 0.538469310105683091036314420700208805L,
                               0.906179845938663992797626878299392965L};
  static const Real weight[3] = {0.568888888888888888888888888888888889L,
                                 0.478628670499366468041291514835638193L,
                                 0.236926885056189087514264040719917363L};
  const int panels = 64;
  const Real half = (h - a) / panels / 2;
  Real sum = 0;
  for (int i = 0; i < panels; ++i)
    for (int k = -2; k <= 2; ++k) {
      const Real r = a + (2 * i + 1) * half + (k < 0 ? -1 : 1) * node[std::abs(k)] * half;
      sum += weight[std::abs(k)] * half * w(r) * 2 * pi * r * (r - a);
    }
  return sum;
}

/// Derivative of the above with respect to a: -int_a^h W(r) 2 pi r dr.
Real half_space_slope(Real a, Real h) {
  a = std::max<Real>(a, 0);
  if (a >= h) return 0;
  // For Spiky: -30/h^6 int_a^h (h-r)^3 r dr = -30/h^6 [h s^4/4 - s^5/5], s = h - a.
  const Real s = h - a;
  return -30 / powl(h, 6) * (h * powl(s, 4) / 4 - powl(s, 5) / 5);
}

void hold(const V& from, V& x, const Settings& c) {
  for (int k = 0; k < 3; ++k) {
    const std::size_t face = 2 * std::size_t(k);
    if (!c.open[face]) x[k] = std::max(x[k], c.low[k] + c.margin);
    if (!c.open[face + 1]) x[k] = std::min(x[k], c.high[k] - c.margin);
  }
  x = path_end(from, x, c);
}

}  // namespace

V spiky_gradient(const V& d, const Settings& c) {
  const Real r = length(d);
  if (r >= c.h || r == 0) return {0, 0, 0};
  V g{};
  axpy(g, -3 * spiky_norm(c) * (c.h - r) * (c.h - r) / r, d);
  return g;
}

Wall walls(const V& x, const Settings& c) {
  Wall out;
  if (!c.wall_density) return out;
  auto kernel = [&](Real r) { return c.paper ? poly6(r, c) : spiky(r, c); };
  auto gradient_kernel = [&](Real r) { return spiky(r, c); };
  Real keep = 1, factor[6], slope[6];
  for (int f = 0; f < 6; ++f) {
    const int axis = f / 2;
    factor[f] = 1;
    slope[f] = 0;
    if ((flat(c) && axis == 1) || c.open[std::size_t(f)]) continue;
    const Real a = f % 2 ? c.high[axis] - x[axis] : x[axis] - c.low[axis];
    if (flat(c)) {
      const Real q = a / c.wall_range / c.h;
      keep *= 1 - c.wall_scale * half_plane(c.paper, q).density;
      const HalfPlane g = half_plane(false, q);
      factor[f] = 1 - c.wall_scale * g.density;
      slope[f] = c.wall_scale / c.wall_range / c.h * g.slope * (f % 2 ? -1 : 1);
      continue;
    }
    keep *= 1 - c.wall_scale * half_space(kernel, a / c.wall_range, c.h);
    factor[f] = 1 - c.wall_scale * half_space(gradient_kernel, a / c.wall_range, c.h);
    slope[f] =
        c.wall_scale / c.wall_range * half_space_slope(a / c.wall_range, c.h) * (f % 2 ? -1 : 1);
  }
  out.density = 1 - keep;
  for (int f = 0; f < 6; ++f) {
    Real others = 1;
    for (int g = 0; g < 6; ++g)
      if (g != f) others *= factor[g];
    out.gradient[f / 2] += slope[f] * others;
  }
  if (c.solids.empty()) return out;
  // They share the space with the walls by inclusion and exclusion.
  const Real solid = share(x, c.paper, c), left = c.wall_scale - out.density;
  const V slopes = solid < 1 ? share_gradient(x, false, c) : V{};
  for (int k = 0; k < 3; ++k)
    out.gradient[k] = std::max<Real>(1 - solid, 0) * out.gradient[k] + left * slopes[k];
  out.density = c.wall_scale - left * std::max<Real>(1 - solid, 0);
  return out;
}

Real half_plane_share(bool poly6, Real q) { return half_plane(poly6, q).density; }

std::vector<Real> densities(const std::vector<V>& x, const Settings& c) {
  std::vector<Real> out;
  for (std::size_t i = 0; i < x.size(); ++i) {
    Real sum = 0;
    for (std::size_t j = 0; j < x.size(); ++j) {
      const Real r = length(apart(x[i], x[j], c));
      sum += c.mass * (c.paper ? poly6(r, c) : spiky(r, c));
    }
    out.push_back(sum + c.rest_density * walls(x[i], c).density);
  }
  return out;
}

void update(State& s, const Settings& c, LevelNodes* nodes) {
  const std::size_t n = s.x.size();
  const Real dt = c.dt / c.substeps, damping = powl(c.damping, 1 / Real(c.substeps));
  std::vector<V> old;
  if (c.order == 2 && s.free.empty()) {
    for (V& v : s.v) axpy(v, -dt / 2, c.gravity);
    s.free = s.v;
  }
  const auto predict = [&] {
    old = s.x;
    for (std::size_t i = 0; i < n; ++i) {
      const V before = s.v[i];
      for (int k = 0; k < 3; ++k) s.v[i][k] = damping * s.v[i][k] + dt * c.gravity[k];
      V carried{};
      if (c.order == 2) {
        axpy(carried, 2 / Real(5), sub(before, s.free[i]));
        axpy(s.v[i], 1, carried);
      }
      axpy(s.x[i], dt, s.v[i]);
      hold(old[i], s.x[i], c);
      if (c.order == 2)  // what a wall stops here is no push
        for (int k = 0; k < 3; ++k) s.free[i][k] = (s.x[i][k] - old[i][k]) / dt - carried[k];
    }
  };
  const auto end_substep = [&] {
    for (std::size_t i = 0; i < n; ++i)
      for (int k = 0; k < 3; ++k) s.v[i][k] = (s.x[i][k] - old[i][k]) / dt;
  };
  predict();
  // The pairs of an update are those closer than h here, the cells of the levels hold who is here.
  const std::vector<V> listed = s.x;
  std::vector<std::vector<std::size_t>> pairs(n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      if (i != j && length(apart(s.x[i], s.x[j], c)) < c.h) pairs[i].push_back(j);

  const Real m = c.mass / c.rest_density;  // volume, m^3
  s.density.assign(n, c.rest_density);
  auto kernel = [&](Real r) { return c.paper ? poly6(r, c) : spiky(r, c); };
  for (int k = 0; k < c.substeps * c.iterations; ++k) {
    if (k > 0 && k % c.iterations == 0) {
      end_substep();
      predict();
    }
    std::vector<Real> lambda(n), ratios(n);
    std::vector<Wall> wall(n);
    for (std::size_t i = 0; i < n; ++i) {
      wall[i] = walls(s.x[i], c);
      Real ratio = m * kernel(0) + wall[i].density, squares = 0;
      V own = wall[i].gradient;
      for (std::size_t j : pairs[i]) {
        const V d = apart(s.x[i], s.x[j], c);
        ratio += m * kernel(length(d));
        V g = spiky_gradient(d, c);
        axpy(own, m, g);
        squares += m * m * (g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
      }
      s.density[i] = c.rest_density * ratio;
      ratios[i] = ratio;
      const Real constraint = c.two_sided ? ratio - 1 : std::max<Real>(ratio - 1, 0);
      squares += own[0] * own[0] + own[1] * own[1] + own[2] * own[2];
      lambda[i] = -constraint / (squares + c.cfm / (c.h * c.h));
      if (c.under_relax && ratio > 1) lambda[i] /= std::min<Real>(1 + 3 * (ratio - 1), 2);
    }
    std::vector<V> next = s.x, coarse(n);
    LevelNodes unseen;
    if (c.levels) coarse = level_moves(listed, ratios, c, nodes ? *nodes : unseen);
    for (std::size_t i = 0; i < n; ++i) {
      V delta{};
      for (std::size_t j : pairs[i]) {
        V d = apart(s.x[i], s.x[j], c);
        if (c.order == 2) {  // a third of the way back to the start of the step
          for (Real& a : d) a *= 2;
          axpy(d, 1, apart(old[i], old[j], c));
          for (Real& a : d) a /= 3;
        }
        Real w = lambda[i] + lambda[j];
        if (c.tensile_k != 0)
          w -= c.tensile_k * c.h * c.h *
               powl(kernel(length(d)) / kernel(c.tensile_q * c.h), c.tensile_n);
        axpy(delta, m * w, spiky_gradient(d, c));
      }
      V push = wall[i].gradient;
      if (c.order == 2) {  // from there too, or nearer to now if the particle has come far
        V way = sub(s.x[i], old[i]);
        for (Real& a : way) a /= 3;
        const Real far = length(way) / (0.4L * c.h);
        V place = s.x[i];
        axpy(place, -std::max<Real>(0, 1 - far * far), way);
        push = walls(place, c).gradient;
      }
      axpy(delta, lambda[i], push);
      axpy(next[i], c.sor, delta);
      axpy(next[i], 1, coarse[i]);
      hold(s.x[i], next[i], c);
    }
    s.x = next;
  }
  end_substep();

  // The next steps take over 2/5 of what follows, 4/25 and so on: in all it is whole.
  const Real now = c.order == 2 ? 3 / Real(5) : 1;
  if (c.xsph != 0) {
    const std::vector<V> v = s.v;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j : pairs[i])
        axpy(s.v[i],
             now * c.xsph * (c.mass / s.density[i] + c.mass / s.density[j]) / 2 *
                 kernel(length(apart(s.x[i], s.x[j], c))),
             sub(v[j], v[i]));
  }
  if (c.vorticity != 0) {
    std::vector<V> curl(n);
    std::vector<Real> approach(n);  // rms rate at which neighbors come nearer, 1/s
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j : pairs[i]) {
        const V d = apart(s.x[j], s.x[i], c), dv = sub(s.v[j], s.v[i]);
        axpy(curl[i], c.mass / s.density[j],
             cross(spiky_gradient(apart(s.x[i], s.x[j], c), c), dv));
        const Real along = d[0] * dv[0] + d[1] * dv[1] + d[2] * dv[2], r = length(d);
        if (along < 0)
          approach[i] += c.mass / s.density[j] * spiky(r, c) * powl(along / (r * r), 2);
      }
      approach[i] = sqrtl(approach[i]);
    }
    for (std::size_t i = 0; i < n; ++i) {
      if (s.density[i] < c.rest_density) continue;
      V eta{};
      for (std::size_t j : pairs[i])
        axpy(eta, c.mass / s.density[j] * (length(curl[j]) - length(curl[i])),
             spiky_gradient(apart(s.x[i], s.x[j], c), c));
      const Real size = length(eta) + 0.1L * length(curl[i]) / c.h;
      if (size == 0) continue;
      const Real gain = c.dt * std::min(c.vorticity, 2 * approach[i]);
      axpy(s.v[i], now * std::min(gain, 0.05L) * c.h / size, cross(eta, curl[i]));
    }
  }
}

}  // namespace oracle
