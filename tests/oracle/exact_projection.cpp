#include "tests/oracle/exact_projection.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "kernels/boundary/box.h"
#include "kernels/pass_predict.h"
#include "lib/exec/cpu/cpu_exec.h"
#include "lib/solver/params.h"
#include "tests/oracle/active_set.h"

namespace pbf::test {
namespace {

using Vector = Eigen::VectorXd;
using V3 = Vec3<double>;
using V4 = Vec4<double>;

/// All coordinates in the internal frame, `low` at 0.
Vector to_frame(const Scene& s, const Plan& plan, const std::vector<double>& si,
                const Double3& low) {
  Vector out(Eigen::Index(si.size()));
  for (std::size_t i = 0; i < si.size(); ++i) {
    const auto k = std::size_t(plan.axes.of[i % 3]);
    out[Eigen::Index(i)] = (si[i - i % 3 + k] - low[k]) / s.h();
  }
  return out;
}

std::vector<double> to_si(const Scene& s, const Plan& plan, const Vector& x) {
  std::vector<double> out(std::size_t(x.size()));
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto k = std::size_t(plan.axes.of[i % 3]);
    out[i - i % 3 + k] = s.origin()[k] + s.h() * x[Eigen::Index(i)];
  }
  return out;
}

V3 point(const Vector& x, Eigen::Index i) { return {x[3 * i], x[3 * i + 1], x[3 * i + 2]}; }

/// The constraints in the internal frame (kernels/README.md, 4 to 6, 9), over all 3n coordinates.
/// The density is the kernels' own; in `paper` the gradient here is that of its Poly6, for only
/// the true gradient gives the nearest point.
template <Smoothing S>
class Constraints {
 public:
  Constraints(const Params<double>& p, const Vector& start)
      : p_(p), n_(int(start.size() / 3)), exec_(1), start_(start), lists_(make_lists()) {}

  /// Values and Jacobian at x: n densities, then the walls near which a particle is.
  void linearise(const Vector& x, ConstraintSet& out) const {
    std::vector<Eigen::Triplet<double>> entries;
    std::vector<double> value;
    for (int i = 0; i < n_; ++i) density_row(i, x, value, entries);
    for (int i = 0; i < n_; ++i) wall_rows(i, x, value, entries);
    out.value = Eigen::Map<const Vector>(value.data(), Eigen::Index(value.size()));
    out.jacobian.resize(out.value.size(), 3 * n_);
    out.jacobian.setFromTriplets(entries.begin(), entries.end());
    out.equalities = p_.two_sided ? n_ : 0;
  }

 private:
  static double density_shape_at(double q2) {
    return density_shape<double, S>(q2, Spiky<double>::t(root_of(q2).q));
  }
  /// dW/dq / q: times the distance vector it is the gradient; 0 for a coincident pair.
  static double slope(double q2) {
    if (q2 <= coincident_q_squared<double>() || q2 >= 1) return 0;
    if (is_paper(S)) return -6 * density_norm<double, S>() * (1 - q2) * (1 - q2);
    const Root<double> root = root_of(q2);
    const double t = Spiky<double>::t(root.q);
    return Spiky<double, dimensions_of(S)>::gradient_norm * t * t * root.inverse;
  }
  V3 wall_gradient(const V3& x) const {
    if (!is_paper(S)) return p_.boundary.template term<S>(x).gradient;
    const double e = 1e-5;  // central differences: error about 1e-10
    const auto along = [&](V3 d) {
      return (p_.boundary.template term<S>(x + d).density -
              p_.boundary.template term<S>(x - d).density) /
             (2 * e);
    };
    return {along({e, 0, 0}), along({0, e, 0}), along({0, 0, e})};  // y: 0 in two dimensions
  }

  void density_row(int i, const Vector& x, std::vector<double>& value,
                   std::vector<Eigen::Triplet<double>>& entries) const {
    const V3 xi = point(x, i);
    double sum = 1;
    V3 own = wall_gradient(xi);
    const auto put = [&](int j, const V3& g) {
      entries.emplace_back(i, 3 * j, g.x);
      entries.emplace_back(i, 3 * j + 1, g.y);
      entries.emplace_back(i, 3 * j + 2, g.z);
    };
    lists_.for_each(i, [&](Neighbor neighbor) {
      const int j = neighbor.row;
      const V3 d = xi - point(x, j);
      const double q2 = dot(d, d);
      sum += density_shape_at(q2);
      const V3 g = (p_.vol * slope(q2)) * d;
      own = own + g;
      put(j, -1.0 * g);
    });
    put(i, own);
    value.push_back(p_.vol * density_norm<double, S>() * sum +
                    p_.boundary.template term<S>(xi).density - 1);
  }

  /// Walls at which a particle within h of them (at the start) would be clamped.
  void wall_rows(int i, const Vector& x, std::vector<double>& value,
                 std::vector<Eigen::Triplet<double>>& entries) const {
    const double box[3] = {p_.boundary.extent.x, p_.boundary.extent.y, p_.boundary.extent.z};
    for (int k = 0; k < 3; ++k)
      for (const int side : {0, 1}) {
        const double limit = side ? box[k] - p_.boundary.margin : p_.boundary.margin,
                     sign = side ? 1 : -1;
        if (!(p_.boundary.walls & (1u << (2 * k + side))) ||
            sign * (start_[3 * i + k] - limit) < -1)
          continue;
        entries.emplace_back(int(value.size()), 3 * i + k, sign);
        value.push_back(sign * (x[3 * i + k] - limit));
      }
  }

  /// Sorts `start_` by bin; order()[k] is then the index that particle k had.
  ChunkedLists make_lists() {
    const auto n = std::size_t(n_);
    std::vector<V4> from(n), sorted(n);
    for (int i = 0; i < n_; ++i) from[std::size_t(i)] = with_w(point(start_, i), 0.0);
    std::vector<int> bin(n), row(n), bin_order(n);
    std::iota(row.begin(), row.end(), 0);
    bin_start_.resize(std::size_t(bin_count(p_)) + 1);
    order_.resize(n);
    const auto gather = [&](int old, int now) {
      sorted[std::size_t(now)] = from[std::size_t(old)];
      order_[std::size_t(now)] = old;
    };
    const OwnRows<const V4> rows(from.data());
    exec_.template sort_by_bin<false>(
        "grid", BinPass<double, dimensions_of(S)>{p_, rows, bin.data()}, NothingListed{}, n_,
        bin_count(p_), row.data(), bin_order.data(), bin_start_.data(), gather);
    const Vector before = start_;
    for (Eigen::Index k = 0; k < n_; ++k)
      start_.segment<3>(3 * k) = before.segment<3>(3 * order_[std::size_t(k)]);
    return exec_.build_lists(n_, n_, sorted.data(), bin_start_.data(), p_);
  }

  Params<double> p_;
  int n_;
  CpuExec exec_;
  Vector start_;
  std::vector<int> order_, bin_start_;
  ChunkedLists lists_;

 public:
  const std::vector<int>& order() const { return order_; }
  const Vector& start() const { return start_; }
};

/// Anderson's method on the fixed point x = x + step(x): the curvature of the constraints, which a
/// linearisation leaves out, makes the plain iteration swing about the solution for long.
class Acceleration {
 public:
  Vector next(const Vector& x, const Vector& step) {
    const double size = step.norm();
    if (size > 3 * last_size_) steps_ = {};  // led astray: forget
    last_size_ = size;
    if (steps_.size() == kDepth + 1) steps_.erase(steps_.begin()), points_.erase(points_.begin());
    if (steps_.empty()) points_.clear();
    steps_.push_back(step);
    points_.push_back(x);
    const auto m = Eigen::Index(steps_.size()) - 1;
    if (m == 0) return x + step;
    Eigen::MatrixXd df(x.size(), m), dx(x.size(), m);
    for (Eigen::Index k = 0; k < m; ++k) {
      df.col(k) = steps_[std::size_t(k) + 1] - steps_[std::size_t(k)];
      dx.col(k) = points_[std::size_t(k) + 1] - points_[std::size_t(k)];
    }
    const Vector weight = df.colPivHouseholderQr().solve(step);
    return x + step - (dx + df) * weight;
  }

 private:
  static constexpr std::size_t kDepth = 8;
  std::vector<Vector> points_, steps_;
  double last_size_ = std::numeric_limits<double>::infinity();
};

/// Largest |C| of the equalities and C of the inequalities.
double violation(const ConstraintSet& c) {
  double worst = 0;
  for (Eigen::Index i = 0; i < c.value.size(); ++i)
    worst = std::max(worst, i < c.equalities ? std::fabs(c.value[i]) : c.value[i]);
  return worst;
}

template <Smoothing S>
Projection project(const Scene& scene, const Plan& plan, const Vector& start) {
  const Params<double> p = make_params<double>(scene, plan);
  const Constraints<S> constraints(p, start);
  const Vector& target = constraints.start();
  Vector x = target;
  ConstraintSet set;
  Multipliers multipliers;
  Projection out;
  constexpr int kMost = 200;
  constexpr double kSmallest = 1e-11;  // h; rounding of the coordinates is 1e-16 of their size
  Acceleration accelerate;
  for (; out.iterations < kMost; ++out.iterations) {
    constraints.linearise(x, set);
    if (!multipliers.solve(set, set.value + set.jacobian * (target - x))) break;
    const Vector step = target - set.jacobian.transpose() * multipliers.value() - x;
    const double size = step.lpNorm<Eigen::Infinity>();
    if (!std::isfinite(size)) break;
    if (size < kSmallest * (1 + x.lpNorm<Eigen::Infinity>())) {
      x += step;
      out.converged = true;
      break;
    }
    x = accelerate.next(x, step);
  }
  constraints.linearise(x, set);
  const Vector& mu = multipliers.value();
  out.violation = violation(set);
  if (mu.size() == set.value.size()) {
    const Vector residual = x - target + set.jacobian.transpose() * mu;
    out.stationarity = residual.lpNorm<Eigen::Infinity>() * scene.fluid.smoothing_ratio;
    out.complementarity = mu.cwiseProduct(set.value).lpNorm<Eigen::Infinity>();
  }
  Vector moved(x.size());
  for (Eigen::Index k = 0; 3 * k < x.size(); ++k)
    moved.segment<3>(3 * constraints.order()[std::size_t(k)]) = x.segment<3>(3 * k);
  out.position = to_si(scene, plan, moved);
  return out;
}

std::vector<double> positions(const FieldArray& f) {
  const auto v = f.as<double>();
  return {v.begin(), v.end()};
}

}  // namespace

std::vector<double> predicted_positions(const Scene& scene, const Plan& plan,
                                        const std::vector<double>& position,
                                        const std::vector<double>& velocity) {
  const Params<double> p = make_params<double>(scene, plan);
  Vector x = to_frame(scene, plan, position, scene.origin());
  const Vector v = to_frame(scene, plan, velocity, {});
  for (Eigen::Index i = 0; 3 * i < x.size(); ++i) {
    const V3 to = predict(point(x, i), point(v, i), V3{}, p, p.boundary).x;
    x.segment<3>(3 * i) << to.x, to.y, to.z;
  }
  return to_si(scene, plan, x);
}

Projection project_exactly(const Scene& scene, const Plan& plan, const std::vector<double>& start) {
  const Vector x = to_frame(scene, plan, start, scene.origin());
  const bool paper = scene.solver.kernels == KernelMode::paper;
  if (scene.dimensions == 2)
    return paper ? project<Smoothing::paper_2d>(scene, plan, x)
                 : project<Smoothing::consistent_2d>(scene, plan, x);
  return paper ? project<Smoothing::paper>(scene, plan, x)
               : project<Smoothing::consistent>(scene, plan, x);
}

std::vector<double> projection_start(Solver& solver, const Scene& scene, const Plan& plan) {
  const Snapshot before = solver.download({"velocity"}, ScalarType::f64).get();
  return predicted_positions(scene, plan, positions(before.fields[0]),
                             positions(*before.find("velocity")));
}

ProjectionError projection_error(Solver& solver, const Scene& scene, const Plan& plan,
                                 const std::vector<double>& start) {
  const auto after = positions(solver.download({}, ScalarType::f64).get().fields[0]);
  ProjectionError e;
  e.exact = project_exactly(scene, plan, start);
  e.converged = e.exact.converged;
  double squares = 0;
  for (std::size_t i = 0; i < after.size(); i += 3) {
    const auto& x = e.exact.position;
    const double r = std::hypot(after[i] - x[i], after[i + 1] - x[i + 1], after[i + 2] - x[i + 2]) /
                     scene.fluid.spacing;
    e.mean += r;
    squares += r * r;
    e.max = std::max(e.max, r);
  }
  const double n = double(after.size() / 3);
  e.mean /= n;
  e.rms = std::sqrt(squares / n);
  return e;
}

}  // namespace pbf::test
