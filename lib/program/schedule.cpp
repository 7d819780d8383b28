#include "lib/program/schedule.h"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>

namespace pbf::program_module {
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

std::vector<std::string> rounded_times(const Scene& s) {
  std::vector<std::string> notes;
  const Schedule used = make_schedule(s);
  const auto compare = [&](const char* key, double given, std::int64_t updates) {
    const double got = double(updates) * s.time.step;
    if (std::fabs(got - given) > 1e-6 * given)
      notes.push_back(fmt::format("{}: {:.6g} s becomes {:.6g} s, {} update{} of {:.6g} s", key,
                                  given, got, updates, updates == 1 ? "" : "s", s.time.step));
  };
  compare("time.end", s.time.end, used.updates);
  if (s.output) compare("output.every", s.output->every, used.frame_every);
  if (used.gauge_every > 0 && s.output->gauges_every)
    compare("output.gauges_every", *s.output->gauges_every, used.gauge_every);
  if (s.render) compare("render.every", s.render->every, used.picture_every);
  return notes;
}

}  // namespace pbf::program_module
