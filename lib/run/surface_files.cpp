#include "lib/run/surface_files.h"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "lib/base/error.h"
#include "lib/io/mesh_file.h"
#include "lib/io/particle_file.h"
#include "lib/scene/number.h"

namespace pbf::run_module {
namespace {

constexpr double kBeyond = 3;  // h, of a bed beyond the domain: more than the range of its share

/// Calls f(); errors begin with the key.
template <class F>
auto with_key(const std::string& key, F&& f) {
  try {
    return f();
  } catch (const Error& e) {
    throw Error(e.code(), key + ": " + e.what());
  }
}

/// Heights on a grid: z of (x[i], y[j]) at j * x.size() + i.
struct Grid {
  std::vector<double> x, y, z;

  double at(std::size_t i, std::size_t j) const { return z[j * x.size() + i]; }
  /// Adds a line of points with the heights of the outermost ones.
  void extend_x(bool high, double to) {
    Grid out{x, y, {}};
    high ? out.x.push_back(to) : void(out.x.insert(out.x.begin(), to));
    for (std::size_t j = 0; j < y.size(); ++j)
      for (std::size_t i = 0; i < out.x.size(); ++i)
        out.z.push_back(at(high ? std::min(i, x.size() - 1) : i - std::min(i, std::size_t(1)), j));
    *this = std::move(out);
  }
  Grid turned() const {
    Grid out{y, x, {}};
    for (std::size_t i = 0; i < x.size(); ++i)
      for (std::size_t j = 0; j < y.size(); ++j) out.z.push_back(at(i, j));
    return out;
  }
};

std::vector<double> values_of(const std::vector<Double3>& points, std::size_t axis) {
  std::vector<double> all;
  for (const Double3& p : points) all.push_back(p[axis]);
  std::ranges::sort(all);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

Grid grid_of(const std::vector<Double3>& points, const std::string& file) {
  Grid g{values_of(points, 0), values_of(points, 1), {}};
  if (g.x.size() < 2 || g.y.size() < 2)
    bad_input(file, fmt::format("has {} values of x and {} of y; a grid of heights has two of each "
                                "at least",
                                g.x.size(), g.y.size()));
  const double all = double(g.x.size()) * double(g.y.size());
  const std::string grid = fmt::format("{} values of x and {} of y", g.x.size(), g.y.size());
  if (all > 1.01 * double(points.size()) + 1000)
    bad_input(file, fmt::format("has {} points, {}: they are no grid along x and y", points.size(),
                                grid));
  std::vector<bool> known(std::size_t(all), false);
  g.z.resize(known.size());
  const auto place = [](const std::vector<double>& of, double v) {
    return std::size_t(std::ranges::lower_bound(of, v) - of.begin());
  };
  for (const Double3& p : points) {
    const std::size_t k = place(g.y, p[1]) * g.x.size() + place(g.x, p[0]);
    if (known[k])
      bad_input(file, fmt::format("gives two heights at x = {}, y = {}; remove one", to_text(p[0]),
                                  to_text(p[1])));
    known[k] = true;
    g.z[k] = p[2];
  }
  const auto gap = std::ranges::find(known, false);
  if (gap != known.end()) {
    const auto k = std::size_t(gap - known.begin());
    bad_input(file, fmt::format("has {}, and no height at x = {}, y = {}; add it", grid,
                                to_text(g.x[k % g.x.size()]), to_text(g.y[k / g.x.size()])));
  }
  return g;
}

/// Lets the grid reach a few h beyond the domain along x.
void cover_x(Grid& g, const Scene& s, std::size_t axis, const std::string& file) {
  const double low = s.domain.min[axis], high = s.domain.max[axis];
  const double slack = 1e-9 * (high - low), beyond = kBeyond * s.h();
  if (g.x.front() > low + slack || g.x.back() < high - slack)
    bad_input(file, fmt::format("has {0} from {1} to {2} m, and the domain goes from {3} to {4}; "
                                "give heights for all of it",
                                axis == 0 ? "x" : "y", to_text(g.x.front()), to_text(g.x.back()),
                                to_text(low), to_text(high)));
  if (g.x.front() > low - beyond) g.extend_x(false, low - beyond);
  if (g.x.back() < high + beyond) g.extend_x(true, high + beyond);
}

/// The surface, sides down to `bottom`, and a bottom.
TriangleMesh solid_below(const Grid& g, double bottom) {
  TriangleMesh m;
  const std::size_t nx = g.x.size(), ny = g.y.size();
  const auto at = [&](std::size_t i, std::size_t j) { return std::int32_t(j * nx + i); };
  for (std::size_t j = 0; j < ny; ++j)
    for (std::size_t i = 0; i < nx; ++i) m.vertex.push_back({g.x[i], g.y[j], g.at(i, j)});
  for (std::size_t j = 0; j + 1 < ny; ++j)
    for (std::size_t i = 0; i + 1 < nx; ++i) {
      const std::int32_t a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
      // Along the diagonal that is steeper least: a ridge or a ditch along it stays whole.
      if (std::fabs(g.at(i, j) - g.at(i + 1, j + 1)) <= std::fabs(g.at(i + 1, j) - g.at(i, j + 1)))
        m.triangle.insert(m.triangle.end(), {{a, b, c}, {a, c, d}});
      else
        m.triangle.insert(m.triangle.end(), {{a, b, d}, {b, c, d}});
    }
  std::vector<std::int32_t> ring;  // counterclockwise seen from above
  for (std::size_t i = 0; i + 1 < nx; ++i) ring.push_back(at(i, 0));
  for (std::size_t j = 0; j + 1 < ny; ++j) ring.push_back(at(nx - 1, j));
  for (std::size_t i = nx - 1; i > 0; --i) ring.push_back(at(i, ny - 1));
  for (std::size_t j = ny - 1; j > 0; --j) ring.push_back(at(0, j));
  const auto first = std::int32_t(m.vertex.size());
  for (const std::int32_t v : ring) {
    const Double3 top = m.vertex[std::size_t(v)];
    m.vertex.push_back({top[0], top[1], bottom});
  }
  const auto middle = std::int32_t(m.vertex.size()), n = std::int32_t(ring.size());
  m.vertex.push_back({0.5 * (g.x.front() + g.x.back()), 0.5 * (g.y.front() + g.y.back()), bottom});
  for (std::int32_t k = 0; k < n; ++k) {
    const std::int32_t next = (k + 1) % n;
    const std::int32_t top = ring[std::size_t(k)], top_next = ring[std::size_t(next)];
    m.triangle.push_back({top, first + k, first + next});
    m.triangle.push_back({top, first + next, top_next});
    m.triangle.push_back({middle, first + next, first + k});
  }
  return m;
}

}  // namespace

std::shared_ptr<const SolidMesh> read_surface(const std::string& key, const std::string& file) {
  return with_key(key, [&] {
    std::string sha256;
    TriangleMesh mesh = read_mesh_file(file, &sha256);
    require_closed(mesh, file);
    return std::make_shared<const SolidMesh>(std::filesystem::absolute(file).string(), sha256,
                                             std::move(mesh));
  });
}

std::shared_ptr<const SolidMesh> read_heights(const Scene& scene, const Double3& translate,
                                              const std::string& key, const std::string& file) {
  return with_key(key, [&] {
    std::string sha256;
    Particles points = read_particle_file(file, &sha256);
    for (Double3& p : points.position)
      for (std::size_t a = 0; a < 3; ++a) p[a] += translate[a];
    Grid g = grid_of(points.position, file);
    cover_x(g, scene, 0, file);
    g = g.turned();
    cover_x(g, scene, 1, file);
    g = g.turned();
    const double lowest = std::min(*std::ranges::min_element(g.z), scene.domain.min[2]);
    TriangleMesh mesh = solid_below(g, lowest - kBeyond * scene.h());
    for (Double3& x : mesh.vertex)
      for (std::size_t a = 0; a < 3; ++a) x[a] -= translate[a];
    return std::make_shared<const SolidMesh>(std::filesystem::absolute(file).string(), sha256,
                                             std::move(mesh));
  });
}

}  // namespace pbf::run_module
