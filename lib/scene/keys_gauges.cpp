// Keys of gauges, which record values at one place.
#include "lib/scene/key_rows.h"

namespace pbf::inline scene_module {

#define GAUGE(member) MEMBER_OF(gauges, Gauge, member)

KeyRows gauge_rows() {
  return {
      {list_block(MEMBER(Scene, gauges), "Gauges, read every output.gauges_every",
                  {.entry_name = "gauge",
                   .remark = "in /pbf/gauges of run.vtkhdf",
                   .example = "{name: H1, kind: level, at: [0.5, 0.5]}",
                   .further = "{name: H1, kind: level, at: [0.5, 0.2]}"},
                  exact("all solvers of a comparison have the same gauges"))},
      {key(GAUGE(name), plain, "Name, in the run file.", required),
       key(GAUGE(kind), one_of({kGaugeKinds.begin(), kGaugeKinds.end()}),
           "What is read; decides which keys it has. level: the wetted length of a line along "
           "gravity's axis (m). velocity: that of the fluid within h (m/s), nan where there is "
           "none. flow: mass through a rectangle per time (kg/s), and all of it (kg). pressure: "
           "the normal load on a disc of a surface over its area (Pa), mean and peak.",
           required, is_kind),
       key(GAUGE(at), numbers("m", kCoordinate, 3),
           "Of a level where the line is along the other axes, [x, y], in two dimensions [x]; else "
           "the place, [x, y, z].",
           required, of(GaugeKind::level, GaugeKind::velocity, GaugeKind::pressure),
           flat(FlatY::middle)),
       key(GAUGE(on), plain, "The obstacle, or the wall of the domain (x_min), that `at` lies on.",
           required, of(GaugeKind::pressure)),
       key(GAUGE(radius), number("m", kLength),
           "Of the disc, of which what lies on the surface counts; at least 2 fluid.spacing. In "
           "two dimensions half the length of a strip.",
           required, of(GaugeKind::pressure)),
       key(GAUGE(center), number("m", kCoordinate), "Middle of the rectangle.", required,
           of(GaugeKind::flow), flat(FlatY::middle)),
       key(GAUGE(normal), number("", {-1e6, 1e6}),
           "At right angles to the rectangle; flow this way counts as positive.", required,
           of(GaugeKind::flow), flat(FlatY::zero)),
       key(GAUGE(size), numbers("m", {1e-9, 1e12}, 2),
           "Its edges: the level one (along x where the normal is along z), then the other. In two "
           "dimensions the length of a line, [size].",
           required, of(GaugeKind::flow))}};
}

}  // namespace pbf::inline scene_module
