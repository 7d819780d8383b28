// The density constraint: density and lambda of one iteration.
#pragma once

#include "kernels/pass_lambda.h"
#include "kernels/pass_residual.h"
#include "lib/program/features/motion.h"

namespace pbf::inline PBF_VARIANT {

struct Density {
  static PassInfo info() {
    return {"density",
            "density",
            {{&field::position}, {&field::lists}},
            {{{&field::density}, Written::scalar, "density", "rho0", true}},
            DensityPass<float, ChunkedLists, Smoothing::consistent, Box<float>>::gathers,
            0};
  }
  template <class C>
  static void launch(C& c) {
    c.with_smoothing([&](auto s) {
      each_then_near<false>(c, [&](const auto& boundary) {
        return DensityPass<typename C::Real, typename C::Lists, decltype(s)::value,
                           std::decay_t<decltype(boundary)>>{c.p, boundary, c.lists, c.position(),
                                                             c.density()};
      });
    });
  }
};

/// What a pass gathers is the same in every form of it.
constexpr unsigned kLambdaGathers =
    LambdaPass<float, ChunkedLists, Smoothing::consistent, true, Box<float>>::gathers;

template <bool with_density, class C>
void launch_lambda(C& c) {
  c.with_smoothing([&](auto s) {
    each_then_near<false>(c, [&](const auto& boundary) {
      return LambdaPass<typename C::Real, typename C::Lists, decltype(s)::value, with_density,
                        std::decay_t<decltype(boundary)>>{
          c.p,         boundary,     c.lists,   c.position(), c.other(field::position),
          c.density(), c.velocity(), c.counts()};
    });
  });
}
inline Written written_lambda() {
  return {other(field::position), Written::fourth, "lambda", "h^2", true};
}

struct Lambda {
  static PassInfo info() {
    return {"lambda",
            "lambda",
            {{&field::position}, {&field::lists}, {&field::density}},
            {written_lambda()},
            kLambdaGathers,
            0};
  }
  template <class C>
  static void launch(C& c) {
    launch_lambda<false>(c);
  }
};

struct DensityLambda {
  static PassInfo info() {
    return {"density+lambda",
            "lambda",
            {{&field::position}, {&field::lists}},
            {{{&field::density}, Written::scalar, "density", "rho0", true, false, false, "density"},
             written_lambda()},
            kLambdaGathers,
            1};
  }
  template <class C>
  static void launch(C& c) {
    launch_lambda<true>(c);
  }
};

struct Constraint {
  using Passes = PassList<Density, Lambda, DensityLambda>;
  template <class B>
  static void add(const Scene& s, B& b) {
    if (s.solver.iterations == 0)
      return b.left_out("lambda and delta passes", "solver.iterations is 0");
    if (s.solver.fused) {
      b.template iteration<DensityLambda>();
      b.left_out("density pass of its own", "solver.fused is true");
    } else {
      b.template iteration<Density>();
      b.template iteration<Lambda>();
    }
  }
};

}  // namespace pbf::inline PBF_VARIANT
