// Runs the tests on one backend and precision, `--on cuda:float`. Exit code 77 (ctest: skipped)
// when that is a GPU and there is none.
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "tests/support/backend.h"
#include "tests/support/catch.h"
#ifdef PBF_HAS_CUDA
#include "lib/exec/cuda/cuda_solver.h"
#endif

int main(int argc, char** argv) {
  std::vector<char*> rest;
  for (int k = 0; k < argc; ++k) {
    if (std::strcmp(argv[k], "--on") == 0 && k + 1 < argc) {
      const std::string on = argv[++k];
      const auto colon = on.find(':');
      const auto backend = pbf::named<pbf::Backend>(on.substr(0, colon));
      const auto precision = pbf::named<pbf::Precision>(on.substr(colon + 1));
      if (!backend || !precision) {
        std::printf("--on %s: give BACKEND:PRECISION, e.g. cpu:float\n", on.c_str());
        return 2;
      }
      backend_test::backend() = *backend;
      backend_test::precision() = *precision;
    } else {
      rest.push_back(argv[k]);
    }
  }
  if (backend_test::backend() == pbf::Backend::cuda) {
    std::string why = "this build has no CUDA backend";
#ifdef PBF_HAS_CUDA
    if (pbf::cuda_available(&why)) return run_catch(int(rest.size()), rest.data());
#endif
    std::printf("skipped: %s\n", why.c_str());
    return 77;
  }
  return run_catch(int(rest.size()), rest.data());
}
