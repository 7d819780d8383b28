// A flow gauge: the particles that change sides of a rectangle.
#pragma once

#include "kernels/pass_flow.h"
#include "lib/program/gauge_frame.h"
#include "lib/scene/vector3.h"

namespace pbf::inline program_module::gauge_kinds {

struct Flow {
  using Keys = gauge_keys::Flow;
  using Sums = FlowCount;

  FlowGate site;
  double mass;  ///< kg
  Grain grains[2];

  Flow(const Keys& g, const GaugeFrame& frame)
      : mass(frame.mass), grains{{0, frame.mass}, {frame.mass, 0}} {
    const Scene& s = frame.scene;
    const Double3 n = unit(g.normal);
    // The first edge is horizontal (perpendicular to z); for a normal along z it is along x.
    const double level = std::hypot(n[0], n[1]);
    const Double3 first = s.dimensions == 2 ? Double3{-n[2], 0, n[0]}
                          : level > 1e-9    ? unit({-n[1], n[0], 0})
                                            : Double3{1, 0, 0};
    frame.direction(n, site.normal);
    frame.direction(first, site.edge[0]);
    frame.direction(cross(n, first), site.edge[1]);
    double center[3];
    frame.place(g.center, center);
    const auto along = [&](const double(&v)[3]) {
      return v[0] * center[0] + v[1] * center[1] + v[2] * center[2];
    };
    site.middle[0] = along(site.normal);
    site.middle[1] = along(site.edge[0]), site.middle[2] = along(site.edge[1]);
    for (std::size_t e = 0; e < 2; ++e) {
      const double edge = e < g.size.size() ? g.size[e] / s.h() : 1e9;
      site.half[e] = edge / 2 + 1e-5 * (1 + edge);  // particles on a wall, rounded
    }
  }
  static std::string place(const Keys& g, const Scene&) {
    std::string size;
    for (const double e : g.size) size += format("%s%.6g", size.empty() ? "" : " x ", e);
    return place_text(g.center) + " m, normal " + place_text(g.normal) + ", " + size + " m";
  }
  int sums() const { return 1; }
  void finish(const FlowCount* c, double* out) const {
    out[0] = c->time > 0 ? mass * double(c->since) / c->time : 0;
    out[1] = mass * double(c->total);
  }
};

}  // namespace pbf::inline program_module::gauge_kinds
