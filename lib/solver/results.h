// A measurement of the state, and its copy in the form of snapshots.
#pragma once

#include "kernels/measure.h"
#include "kernels/pass_export.h"
#include "kernels/pass_power.h"
#include "lib/solver/read_sums.h"

namespace pbf::PBF_VARIANT {

/// What a measurement of the state touches.
struct Measure {
  static constexpr PassText text{"measure", "measure"};
  using Needs = pbf::Needs<Reads<field::position>, Reads<field::velocity>, Reads<field::density>,
                           Reads<field::counts>, SolidNeeds, UsesLists>;
};

/// Sums over the particles. n: of all ranks. The density is current.
template <class Context>
MeasureSums measure_state(Context& context, int n, const MeasureConstants& given) {
  using Real = typename Context::Real;
  MeasureSums sums;
  context.template as_pass<Measure>([&](const auto& c) {
    with_boundary(c, [&](const auto& boundary) {
      sums = c.reduce(MeasurePass<Real, typename Context::Lists, std::decay_t<decltype(boundary)>>{
          c.p, boundary, c.lists(), c[field::position].rows(), c[field::velocity].rows(),
          c[field::density].rows(), c[field::counts].rows(), given});
    });
  });
  sums.compression_p99 = compression_percentile(
      context.exec.count_in_bins(n, kCompressionBins, CompressionBinPass<Real>{context.density()}),
      n - n / 100, n, sums.compression_max);
  context.exec.mark("measure");
  return sums;
}

/// See Stepper::power().
template <class Context>
double motion_power(Context& c, int n, const FrameStep<double>& frame, double lag, double dt) {
  const auto& g = c.p.gravity;
  const Vec3<double> gravity{double(g.x), double(g.y), double(g.z)};
  return c.exec
      .reduce(n, PowerPass<typename Context::Real>{frame, 1 / dt, gravity, lag, c.position(),
                                                   c.velocity()})
      .x[0];
}

/// Writes fields of the particles in SI units, along the scene's axes and in the order of ids to
/// memory of the executor; null: not wanted.
template <class Context, class Out>
void export_state(Context& c, Out* position, Out* velocity, Out* density) {
  const Double3 origin = c.scene.origin();
  const Axes& axes = c.plan.axes;
  const auto from = [&](int k) { return origin[std::size_t(axes.of[k])]; };
  const int n = c.host_rows();
  const ExportPass<typename Context::Real, Out> pass{c.scene.h(),
                                                     c.scene.fluid.rest_density,
                                                     {from(0), from(1), from(2)},
                                                     axes,
                                                     c.position(),
                                                     c.velocity(),
                                                     c.density(),
                                                     c.order_of_ids(c.ids(), n),
                                                     position,
                                                     velocity,
                                                     density};
  if (c.images())
    c.exec.items(c.rows(), pass);
  else
    c.exec.items(n, pass);
  c.exec.mark("download");
}

}  // namespace pbf::PBF_VARIANT
