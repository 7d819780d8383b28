// The nearest point of linearised constraints: a sparse active-set solver.
#pragma once

#include <Eigen/SparseCore>
#include <vector>

namespace pbf::test {

/// Linearised at some x: C(x + s) = value + jacobian s. The first `equalities` rows must become 0,
/// the others at most 0.
struct ConstraintSet {
  Eigen::VectorXd value;
  Eigen::SparseMatrix<double, Eigen::RowMajor> jacobian;
  int equalities = 0;
};

/// Multipliers mu of min |s|^2/2 with r + J s = 0 or <= 0, s = -J^T mu: mu >= 0 (inequalities),
/// r - J J^T mu <= 0, mu (r - J J^T mu) = 0. Block principal pivoting (Judice & Pires 1994,
/// "A block principal pivoting algorithm for large-scale strictly monotone linear complementarity
/// problems", with Murty's single pivots as its safeguard), each step one sparse Cholesky
/// factorisation over the active rows.
class Multipliers {
 public:
  /// False when it did not end or a factorisation failed. The next call starts from the active set
  /// of this one if the rows are as many.
  bool solve(const ConstraintSet& c, const Eigen::VectorXd& r);
  const Eigen::VectorXd& value() const { return mu_; }

 private:
  bool solve_active(const ConstraintSet& c, const Eigen::VectorXd& r);
  Eigen::VectorXd mu_;
  std::vector<char> active_;
};

}  // namespace pbf::test
