// Ranks as threads of one process, which share the device: several of them make the bits of one.
#include "tests/support/backend.h"
#include "tests/support/rank_runs.h"

namespace backend_test {
using namespace pbf;
using namespace pbf::test;

namespace {

RankScene scene_here(const std::string& name, std::vector<std::string> set) {
  set.push_back(std::string("backend=") + word(backend()));
  set.push_back(std::string("precision=") + word(precision()));
  return RankScene(name, set);
}

}  // namespace

TEST_CASE("ranks that share a device give the bits of one") {
  struct Case {
    const char* scene;
    std::vector<std::string> set;
    int updates;
  };
  for (const Case& of : std::vector<Case>{
           {"configs/minimal", {"fluid.spacing=0.04"}, 150},
           {"configs/minimal",
            {"fluid.spacing=0.04", "viscosity.xsph=0.1", "vorticity.epsilon=1", "tensile={}"},
            40},
           {"configs/minimal", {"fluid.spacing=0.04", "solver.substeps=3", "time.order=1"}, 40},
           {"configs/minimal", {"fluid.spacing=0.04", "solver.kernels=paper"}, 40},
           {"configs/minimal", {"fluid.spacing=0.04", "solver.tolerance=1e-3"}, 40},
           {"configs/minimal", {"fluid.spacing=0.02"}, 20},
           {"configs/minimal", {"fluid.spacing=0.02", "solver.levels=on"}, 10},
           {"configs/dam_break_2d", {"fluid.spacing=0.016"}, 40},
           {"tests/regression/frozen/obstacles", {}, 60},
           {"tests/regression/frozen/meshes", {}, 60},
           {"tests/regression/frozen/motions", {"viscosity.xsph=0.1", "gauges=[]"}, 60},
       })
    for (const char* reproducible : {"false", "true"}) {
      if (backend() == Backend::cpu && reproducible == std::string("true")) continue;
      std::vector<std::string> set = of.set;
      set.push_back(std::string("solver.reproducible=") + reproducible);
      const RankScene m = scene_here(of.scene, set);
      const std::vector<Seen> one = on_one(m, of.updates);
      for (const int ranks : {2, 3}) {
        if (ranks > 2 && has_levels(m.scene)) continue;  // slabs are whole bricks
        CAPTURE(of.scene, set, ranks);
        const std::vector<Seen> all = on_ranks(m, ranks, of.updates);
        for (std::size_t k = 0; k < one.size(); ++k) {
          CAPTURE(k);
          check_same(one[k], all[k], m.scene);
        }
      }
    }
}

}  // namespace backend_test
