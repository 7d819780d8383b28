// The formula behind the warning of too long a step, against pools that are simulated.
#include <cmath>

#include "lib/run/prestabilize.h"
#include "lib/run/warnings.h"
#include "tests/support/catch.h"
#include "tests/support/states.h"

using namespace oracle_test;

TEST_CASE("the compression of a pool at rest is foretold within a factor of two") {
  struct Pool {
    int layers, iterations, substeps;
    double step;  // sqrt(h/g)
    bool two_dimensional;
  };
  for (const Pool& pool :
       {Pool{6, 4, 1, 0.08, false}, Pool{12, 4, 1, 0.16, false}, Pool{24, 4, 1, 0.08, true},
        Pool{12, 8, 1, 0.16, true}, Pool{12, 2, 3, 0.3, true}}) {
    CAPTURE(pool.layers, pool.iterations, pool.substeps, pool.step);
    Case c = pool.two_dimensional ? flat_block(24, pool.layers, 0, 0)
                                  : jittered_block(8, 8, pool.layers, 0, 0);
    pbf::Scene& s = c.scene;
    for (int a = 0; a < 2; ++a)
      if (a == 0 || !pool.two_dimensional)
        s.domain.max[a] = s.domain.min[a] + 0.02 * (pool.two_dimensional ? 24 : 8);
    s.domain.max[2] = s.domain.min[2] + 0.04 * pool.layers;
    s.gravity = {0, 0, -9.81};
    s.precision = pbf::Precision::single;
    s.guard.reset();
    s.solver.iterations = pool.iterations;
    s.solver.substeps = pool.substeps;
    s.time.step = pool.step * std::sqrt(s.h() / 9.81);
    auto solver = make(c);
    solver->step(5 * pool.layers);
    double mean = 0;
    for (int k = 0; k < 10; ++k) {
      solver->step(2);
      mean += solver->diagnose().compression_mean / 10;
    }
    const double foretold = pbf::compression_at_rest(s, std::int64_t(solver->state().id.size()));
    CAPTURE(mean, foretold);
    CHECK(mean < 2 * foretold);
    CHECK(mean > 0.5 * foretold);
  }
}
