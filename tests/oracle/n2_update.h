// One update of Position Based Fluids by brute force: every pair, long double, SI units, formulas
// written from the papers. Shares no code with kernels/ or lib/.
#pragma once

#include "tests/oracle/n2_solids.h"

namespace oracle {

/// SI units throughout; `mass` is the weight that enters density sums, in kg, in two dimensions
/// (the x-z plane, no walls along y) in kg per metre of thickness.
struct Settings {
  int dimensions = 3;
  Real h = 0.04L, mass = 0, rest_density = 1000, dt = 0.002L, cfm = 0;  // eps^, 1
  Real sor = 1, damping = 1, wall_scale = 0, wall_range = 1, margin = 0;
  V gravity{0, 0, -9.81L}, low{0, 0, 0}, high{1, 1, 1};
  int iterations = 4;
  int substeps = 1;            // of dt together, on one list
  std::array<bool, 6> open{};  // x_min, x_max, y_min ...: no wall
  V period{};                  // of axes whose faces are joined: pairs are those of nearest images
  bool levels = false;
  Real spacing = 0;  // with levels
  bool paper = false, two_sided = false, wall_density = true, under_relax = false;
  Real tensile_k = 0, tensile_q = 0.3L;  // k in h^2
  int tensile_n = 4;
  Real xsph = 0, vorticity = 0;  // 1, 1/s
  int order = 1;                 // of the time steps
  std::vector<Solid> solids;
};

struct State {
  std::vector<V> x, v;
  std::vector<V> free;  ///< in second order: v without the push of the last step; empty: no step
  std::vector<Real> density;  ///< kg/m^3, of the last iteration
};

struct LevelNodes;
/// Advances by one update. nodes: of the levels in the last iteration.
void update(State& s, const Settings& c, LevelNodes* nodes = nullptr);

/// Density at the present positions, kg/m^3, walls included.
std::vector<Real> densities(const std::vector<V>& x, const Settings& c);

/// What all walls and solids add to the density at x, and its gradient (that of the Spiky kernel).
struct Wall {
  Real density = 0;  ///< fraction of rho0
  V gradient{};      ///< 1/m
};
Wall walls(const V& x, const Settings& c);

/// The share of the unit kernel beyond a line at distance q of its range, by the fit of
/// kernels/README.md (9).
Real half_plane_share(bool poly6, Real q);

/// Of the Spiky kernel, 1/m^4 (1/m^3 in two dimensions).
V spiky_gradient(const V& d, const Settings& c);

}  // namespace oracle
