#include "tests/oracle/active_set.h"

#include <Eigen/SparseCholesky>

namespace pbf::test {

/// mu_ of the active rows alone, the others 0.
bool Multipliers::solve_active(const ConstraintSet& c, const Eigen::VectorXd& r) {
  std::vector<Eigen::Index> rows;
  for (std::size_t i = 0; i < active_.size(); ++i)
    if (active_[i]) rows.push_back(Eigen::Index(i));
  mu_.setZero();
  const auto n = Eigen::Index(rows.size());
  if (n == 0) return true;
  std::vector<Eigen::Triplet<double>> one;
  Eigen::VectorXd right(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Eigen::Index i = rows[std::size_t(k)];
    one.emplace_back(k, i, 1.0);
    right[k] = r[i];
  }
  Eigen::SparseMatrix<double, Eigen::RowMajor> select(n, r.size());
  select.setFromTriplets(one.begin(), one.end());
  const Eigen::SparseMatrix<double, Eigen::RowMajor> j = select * c.jacobian;
  Eigen::SparseMatrix<double> a = j * j.transpose();
  // Constraints may depend on each other (two particles in one place): a 1e-12 of the mean
  // diagonal keeps the factorisation going and moves C by 1e-12 mu.
  const double shift = 1e-12 * a.diagonal().mean();
  for (Eigen::Index k = 0; k < n; ++k) a.coeffRef(k, k) += shift;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(a);
  if (factor.info() != Eigen::Success) return false;
  const Eigen::VectorXd solution = factor.solve(right);
  for (Eigen::Index k = 0; k < n; ++k) mu_[rows[std::size_t(k)]] = solution[k];
  return solution.allFinite();
}

bool Multipliers::solve(const ConstraintSet& c, const Eigen::VectorXd& r) {
  const auto n = std::size_t(r.size()), fixed = std::size_t(c.equalities);
  if (active_.size() != n) active_.assign(n, 0);
  mu_.resize(r.size());
  for (std::size_t i = 0; i < fixed; ++i) active_[i] = 1;
  // Full exchanges while they help, at most `patience` that do not, then single ones.
  constexpr int kMost = 500;
  std::size_t fewest = n + 1;
  int patience = 10;
  for (int k = 0; k < kMost; ++k) {
    if (!solve_active(c, r)) return false;
    const Eigen::VectorXd left = r - c.jacobian * (c.jacobian.transpose() * mu_);
    const double tolerance = 1e-13 * (1 + r.lpNorm<Eigen::Infinity>());
    std::vector<std::size_t> wrong;
    for (std::size_t i = fixed; i < n; ++i) {
      const auto at = Eigen::Index(i);
      if (active_[i] ? mu_[at] < -tolerance : left[at] > tolerance) wrong.push_back(i);
    }
    if (wrong.empty()) return true;
    if (wrong.size() < fewest) {
      fewest = wrong.size();
      patience = 10;
    } else if (--patience < 0) {
      wrong = {wrong.back()};
    }
    for (const std::size_t i : wrong) active_[i] = !active_[i];
  }
  return false;
}

}  // namespace pbf::test
