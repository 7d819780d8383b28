#include "lib/run/schedule.h"

#include <algorithm>
#include <cmath>

namespace pbf::inline run_module {
namespace {

std::int64_t whole(double ratio) {
  return std::max<std::int64_t>(1, std::llround(std::min(ratio, 9e18)));
}

}  // namespace

Schedule make_schedule(const Scene& s) {
  Schedule out;
  out.updates = whole(s.time.end / s.time.step);
  out.measure_every = s.measure_every;
  if (s.output) out.frame_every = whole(s.output->every / s.time.step);
  if (s.output && !s.gauges.empty())
    out.gauge_every =
        s.output->gauges_every ? whole(*s.output->gauges_every / s.time.step) : out.measure_every;
  if (s.render) {
    out.picture_every = s.output ? out.frame_every * whole(s.render->every / s.output->every)
                                 : whole(s.render->every / s.time.step);
  }
  return out;
}

}  // namespace pbf::inline run_module
