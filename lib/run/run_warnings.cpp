// Warnings about what a run does.
#include <algorithm>
#include <cmath>

#include "kernels/relative_motion.h"
#include "lib/base/text.h"
#include "lib/run/warnings.h"

namespace pbf::inline run_module {
namespace {

double percent(double part, double whole) { return whole > 0 ? 100 * part / whole : 0; }

/// Splashes of a few particles are in any lively flow.
constexpr double kMuch = 1e-3;  // of particles times steps

std::string passed_through_text(const Scene& s, const Measures& m, double share) {
  // With time.adaptive the longest way may be that of a step much shorter than time.step.
  const std::string remedy =
      s.time.adaptive
          ? std::string("lower time.adaptive.cfl")
          : format("time.step %.2g s resolves it", s.time.step * kResolvedWay / m.relative_way_max);
  return format(
             "fluid may have passed through fluid: %lld times (%.2g %% of particles times steps) a "
             "particle moved by more than %g h relative to a neighbour in a step, by up to %.3g "
             "h; ",
             static_cast<long long>(m.unresolved), 100 * share, kResolvedWay, m.relative_way_max) +
         remedy;
}

}  // namespace

void RunWarnings::follow(const Measures& m) {
  if (m.update == 0 || m.compression_mean <= kNoLiquid) return;
  const std::int64_t every = scene_->measure_every, rest = m.update % every;
  compressed_ += rest == 0 ? every : rest;
}

template <class Coordinate>
void RunWarnings::count_outside(std::size_t n, const Coordinate& coordinate) {
  left_ = 0;
  farthest_ = 0;
  std::vector<std::int64_t> through(scene_->domain.open.size());
  for (std::size_t i = 0; i < n; ++i) {
    bool out = false;
    for (std::size_t f = 0; f < through.size(); ++f) {
      const std::string& face = scene_->domain.open[f];
      const int a = face[0] - 'x';
      const double x = coordinate(i, a);
      const double beyond =
          face.ends_with("min") ? scene_->domain.min[a] - x : x - scene_->domain.max[a];
      // By more than what a float in m may be off.
      if (!(beyond > 1e-3 * scene_->fluid.spacing)) continue;
      out = true;
      ++through[f];
      farthest_ = std::max(farthest_, beyond);
    }
    left_ += out;
  }
  faces_.clear();
  for (std::size_t f = 0; f < through.size(); ++f)
    if (through[f] > 0) faces_ += (faces_.empty() ? "" : ", ") + scene_->domain.open[f];
}

void RunWarnings::look_outside(const Snapshot& s) {
  if (scene_->domain.open.empty()) return;
  const FieldArray* x = s.find("position");
  if (!x) return;
  if (x->type == ScalarType::f64)
    count_outside(s.count, [v = x->as<double>()](std::size_t i, int a) { return v[3 * i + a]; });
  else
    count_outside(s.count,
                  [v = x->as<float>()](std::size_t i, int a) { return double(v[3 * i + a]); });
}

void RunWarnings::look_outside(const std::vector<double>& x) {
  if (scene_->domain.open.empty()) return;
  const Double3 origin = scene_->origin();
  const double h = scene_->h();
  count_outside(x.size() / 3, [&](std::size_t i, int a) { return origin[a] + h * x[3 * i + a]; });
}

std::vector<Warning> RunWarnings::at(const Measures& m, bool end) const {
  std::vector<Warning> list;
  const bool long_time = 10 * compressed_ >= updates_;
  const bool at_end = end && m.compression_mean > kNoLiquid;
  if ((long_time && compressed_ > 0) || at_end)
    list.push_back(
        {"compressed",
         format("the fluid is no liquid: mean compression above %g %% through %.3g %% of the "
                "updates, %.3g %% at %s; give a shorter time.step or more solver.iterations",
                100 * kNoLiquid, percent(double(compressed_), double(updates_)),
                100 * m.compression_mean, end ? "the end" : "present")});
  const double share =
      double(m.unresolved) / (double(particles_) * double(updates_) * scene_->solver.substeps);
  if (m.unresolved > 0 && (share >= kMuch || m.relative_way_max >= 1))
    list.push_back({"passed_through", passed_through_text(*scene_, m, share)});
  if (left_ > 0)
    list.push_back(
        {"left", format("%lld of %lld particles (%.2g %%) have left the domain through "
                        "an open face (%s), the farthest %.3g m beyond it; they are "
                        "simulated on",
                        static_cast<long long>(left_), static_cast<long long>(particles_),
                        percent(double(left_), double(particles_)), faces_.c_str(), farthest_)});
  return list;
}

}  // namespace pbf::inline run_module
