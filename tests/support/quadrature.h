// Integrals for tests.
#pragma once

namespace oracle_test {

/// Midpoint rule.
template <class F>
double integrate(F f, double a, double b, int n) {
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += f(a + (i + 0.5) * (b - a) / n);
  return sum * (b - a) / n;
}

}  // namespace oracle_test
