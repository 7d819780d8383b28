// Values that look as if they were not in SI units.
#include "lib/run/warnings.h"

#include "lib/run/warnings.h"
#include "tests/support/catch.h"

using namespace pbf;

TEST_CASE("units: values that SI units would not give are named with those that they would") {
  const auto text = [](auto change) {
    Scene s;
    s.domain.max = {0.4, 0.4, 1.2};
    s.bodies.resize(1);
    s.time = {0.002, 1, {}};
    change(s);
    const std::string found = units_text(s);
    const std::vector<Warning> all = scene_warnings({s, "."}, 100);
    CHECK(found.empty() == (all.empty() || all[0].kind != "units"));
    return found;
  };
  CHECK(text([](Scene&) {}).empty());
  const std::string si = ": are the values in SI units (m, kg, s)?";
  CHECK(text([](Scene& s) {
          s.gravity = {0, 0, -9810};
        }) == "gravity is 9810 m/s^2, on Earth it is 9.81" + si);
  CHECK(text([](Scene& s) {
          s.gravity = {0, 0, -0.00981};
        }) == "gravity is 0.00981 m/s^2, on Earth it is 9.81" + si);
  CHECK(text([](Scene& s) { s.gravity = {0, 0, 0}; }).empty());
  CHECK(text([](Scene& s) { s.gravity = {0, 0, -1.62}; }).empty());
  CHECK(text([](Scene& s) { s.fluid.rest_density = 1; }) ==
        "fluid.rest_density is 1 kg/m^3, water has 1000 (1 g/cm^3 are 1000 kg/m^3)" + si);
  CHECK(text([](Scene& s) { s.fluid.rest_density = 1e6; }) ==
        "fluid.rest_density is 1e+06 kg/m^3, water has 1000" + si);
  CHECK(text([](Scene& s) { s.fluid.rest_density = 13600; }).empty());
  CHECK(text([](Scene& s) {
          s.bodies[0].velocity = {2000, 0, 0};
        }) == "bodies[0].velocity is 2000 m/s (2000 mm/s are 2 m/s)" + si);
  CHECK(
      text([](Scene& s) { s.viscosity = Viscosity{1.5}; }).starts_with("viscosity.xsph is 1.5, "));
  CHECK(text([](Scene& s) { s.viscosity = Viscosity{1}; }).empty());
  const auto in_mm = [](Scene& s) {
    s.domain.max = {400, 400, 1200};
    s.bodies[0].max = {400, 400, 600};
    s.fluid.spacing = 50;
  };
  CHECK(text(in_mm) ==
        "domain is 1200 m long, and until time.end (1 s) things fall by 4.91 m alone (1200 mm are "
        "1.2 m)" +
            si);
  CHECK(text([&](Scene& s) { in_mm(s), s.time.end = 10; }).empty());  // a large scene, run long
  CHECK(
      text([](Scene& s) {
        s.gravity = {0, 0, -9810}, s.fluid.rest_density = 1;
      }) ==
      "gravity is 9810 m/s^2, on Earth it is 9.81; fluid.rest_density is 1 kg/m^3, water has 1000 "
      "(1 g/cm^3 are 1000 kg/m^3)" +
          si);
}
