// Vorticity confinement, after the last substep of an update: one pass computes the curl in its own
// array, another applies the confinement.
#pragma once

#include "kernels/pass_vorticity.h"
#include "lib/program/as_types.h"
#include "lib/program/pass.h"

namespace pbf::inline program_module::field {
/// 1/s, curl times its gain; w = its magnitude without it.
inline constexpr FieldInfo curl{"curl", Type::real, 4, Rows::padded};
}  // namespace pbf::inline program_module::field

namespace pbf::inline PBF_VARIANT {

inline constexpr const char* kLessConfinement = "lower vorticity.epsilon";

struct Curl {
  static PassInfo info() {
    Written curl = vector({&field::curl}, "curl times its gain", "1/s");
    curl.sum = curl.axial = true;
    return {"curl",
            "vorticity",
            {{&field::position}, {&field::velocity}, {&field::lists}},
            {curl},
            CurlPass<float, ChunkedLists, 3>::gathers,
            -1,
            kLessConfinement};
  }
  template <class C>
  static void launch(C& c) {
    with_dimensions(c.p.dimensions, [&](auto d) {
      c.pairs(CurlPass<typename C::Real, typename C::Lists, decltype(d)::value>{
          c.p, c.lists, c.position(), c.velocity(), c.vectors(field::curl)});
    });
  }
};

struct Confine {
  static PassInfo info() {
    return {"confinement",
            "vorticity",
            {{&field::position}, {&field::curl}, {&field::lists}, {&field::velocity}},
            {vector({&field::velocity}, "velocity", "h/s")},
            VorticityPass<float, ChunkedLists, 3>::gathers,
            -1,
            kLessConfinement};
  }
  template <class C>
  static void launch(C& c) {
    with_dimensions(c.p.dimensions, [&](auto d) {
      c.pairs(VorticityPass<typename C::Real, typename C::Lists, decltype(d)::value>{
          c.p, c.lists, c.position(), c.vectors(field::curl), c.velocity()});
    });
  }
};

struct VorticityConfinement {
  using Passes = PassList<Curl, Confine>;
  template <class B>
  static void add(const Scene& s, B& b) {
    if (!s.vorticity || s.vorticity->epsilon == 0)
      return b.left_out("curl and confinement passes, curl array", "no key vorticity");
    b.template after<Curl>();
    b.template after<Confine>();
  }
};

}  // namespace pbf::inline PBF_VARIANT
