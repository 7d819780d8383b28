#include <fmt/core.h>
#include <algorithm>

#include "kernels/relative_motion.h"
#include "lib/program/motion.h"
#include "lib/run/run.h"

namespace pbf::run_module {
namespace {

/// Any lively flow has splashes of a few particles.
constexpr double kMuch = 1e-3;     // share of particles times steps
constexpr double kInSolid = 0.01;  // h, far beyond rounding

std::string passed_through_text(const Scene& s, const Diagnostics& m, double share) {
  // With time.adaptive the longest move may belong to a step much shorter than time.step.
  const std::string remedy = s.time.adaptive
                                 ? "lower time.adaptive.cfl"
                                 : fmt::format("time.step {:.2g} s resolves it",
                                               s.time.step * kResolvedWay / m.relative_way_max);
  return fmt::format(
      "fluid may have passed through fluid: {} times ({:.2g} % of particles times steps) a "
      "particle moved by more than {:g} h relative to a neighbor in a step, by up to {:.3g} h; {}",
      m.unresolved, 100 * share, kResolvedWay, m.relative_way_max, remedy);
}

/// The readings of the whole run beside measurements.
std::vector<StoredComparison> compared(RunParts& run) {
  if (run.start.comparisons.empty()) return {};
  run.writer->sync();
  const RunReader file(run.folder.file(kRunFile));
  return compare_all(run.start.comparisons,
                     [&](const Quantity& q) { return read_quantity(file, q); });
}

}  // namespace

Reporter::Reporter(RunParts& run, const Monitor& monitor)
    : run_(run), monitor_(monitor), progress_(run.control.log) {
  for (const Warning& w : run.start.warnings) told_.emplace(w.kind, w.text);
  if (run.from.saved) compressed_ = run.from.saved->compressed_updates;
  progress_.start_at(run.from.update());
}

Next Reporter::at(Session& session) {
  const std::int64_t u = session.update(), updates = run_.schedule.updates;
  if (u < updates)
    for (const Warning& w : found(false))
      if (told_.emplace(w.kind, w.text).second) run_.control.log.warning(w.text);
  const Diagnostics& m = monitor_.last();
  progress_.update({u, updates, run_.plan.particles, double(u) * run_.scene.time.step,
                    m.compression_mean, m.compression_max, run_.from.update()});
  return Next::go_on;
}

void Reporter::end(Session& session) {
  if (!run_.scene.domain.open.empty()) {
    const Double3 origin = run_.scene.origin();
    const double h = run_.scene.h();
    const auto count = [&](std::int64_t first, const SolverState& s) {
      const std::vector<double>& x = s.position;
      count_outside(first, x.size() / 3,
                    [&](std::size_t i, int a) { return origin[a] + h * x[3 * i + a]; });
    };
    constexpr std::int64_t kPiece = std::int64_t{1} << 20;
    if (SplitRows* split = run_.solver.split())
      split->state_in_pieces(StateOf::positions, kPiece, {[](SolverState&&) {}, count});
    else
      count(0, run_.solver.state(StateOf::positions));
  }
  all_ = run_.start.warnings;
  const bool finished = !monitor_.event() && session.update() == run_.schedule.updates;
  run_.compared = compared(run_);
  for (const Warning& w : found(finished)) all_.push_back(w);
}

std::vector<Warning> Reporter::untold() const {
  std::vector<Warning> out;
  for (const Warning& w : all_)
    if (const auto at = told_.find(w.kind); at == told_.end() || at->second != w.text)
      out.push_back(w);
  return out;
}

void Reporter::follow(const Diagnostics& m) {
  if (m.update == 0 || m.compression_mean <= kNoLiquid) return;
  const std::int64_t every = run_.scene.measure_every, rest = m.update % every;
  compressed_ += rest == 0 ? every : rest;
}

/// In pieces from row 0 on.
template <class Coordinate>
void Reporter::count_outside(std::int64_t first, std::size_t n, const Coordinate& coordinate) {
  const Domain& domain = run_.scene.domain;
  if (first == 0) left_ = seen_ = 0, farthest_ = 0, through_.assign(domain.open.size(), 0);
  seen_ += std::int64_t(n);
  for (std::size_t i = 0; i < n; ++i) {
    bool out = false;
    for (std::size_t f = 0; f < through_.size(); ++f) {
      const std::string& face = domain.open[f];
      const int a = face[0] - 'x';
      const double x = coordinate(i, a);
      const double beyond = face.ends_with("min") ? domain.min[a] - x : x - domain.max[a];
      // More than the rounding of a float in m.
      if (!(beyond > 1e-3 * run_.scene.fluid.spacing)) continue;
      out = true;
      ++through_[f];
      farthest_ = std::max(farthest_, beyond);
    }
    left_ += out;
  }
  faces_.clear();
  for (std::size_t f = 0; f < through_.size(); ++f)
    if (through_[f] > 0) faces_ += (faces_.empty() ? "" : ", ") + domain.open[f];
}

void Reporter::look_outside(std::int64_t first, const FieldArray& position) {
  if (run_.scene.domain.open.empty()) return;
  count_outside(first, position.bytes.size() / (3 * size_of(position.type)),
                [&](std::size_t i, int a) { return position.number(3 * i + std::size_t(a)); });
}

std::vector<Warning> Reporter::found(bool end) const {
  const Diagnostics& m = monitor_.last();
  std::vector<Warning> list;
  const bool long_time = 10 * compressed_ >= run_.schedule.updates;
  const bool at_end = end && m.compression_mean > kNoLiquid;
  if ((long_time && compressed_ > 0) || at_end)
    list.push_back(
        {"compressed",
         fmt::format("the fluid is compressed as no liquid is: mean compression above {:g} % "
                     "through {:.3g} % of the updates, {:.3g} % at {}; give a shorter time.step or "
                     "more solver.iterations",
                     100 * kNoLiquid, percent(double(compressed_), double(run_.schedule.updates)),
                     100 * m.compression_mean, end ? "the end" : "present")});
  if (m.energy_rise > kAddsEnergy)
    list.push_back(
        {"energy",
         fmt::format("the fluid has gained {:.3g} % of its energy at the start, more than "
                     "{:g} %: the method adds it; give a shorter time.step, more "
                     "solver.iterations or a smaller solver.sor (here {:.3g})",
                     100 * m.energy_rise, 100 * kAddsEnergy, run_.plan.sor)});
  else if (m.energy_drift > kStirred && has_levels(run_.scene) && !has_motion(run_.scene))
    list.push_back(
        {"stirred",
         fmt::format("solver.levels stir the fluid: its energy is {:.2g} % above that of the "
                     "start, more than {:g} %; give fewer substeps or iterations, a larger "
                     "solver.hyperviscosity, or solver.levels: off",
                     100 * m.energy_drift, 100 * kStirred)});
  const double share =
      double(m.unresolved) /
      (double(run_.plan.particles) * double(run_.schedule.updates) * run_.scene.solver.substeps);
  if (m.unresolved > 0 && (share >= kMuch || m.relative_way_max >= 1))
    list.push_back({"passed_through", passed_through_text(run_.scene, m, share)});
  if (m.penetration > kInSolid * run_.scene.h())
    list.push_back(
        {"closed_in",
         fmt::format("{} leaves fluid no way out: a particle is {:.2g} m behind its surface; move "
                     "it elsewhere or more slowly",
                     run_.scene.obstacles.empty() ? "a wall" : "an obstacle", m.penetration)});
  for (const StoredComparison& c : run_.compared)
    if (const std::string note = note_of(c); end && !note.empty())
      list.push_back({"compare " + c.name, "compare " + c.name + ": " + note});
  if (left_ > 0)
    list.push_back(
        {"left",
         fmt::format("{} of {} particles ({:.2g} %) have left the domain through an open face "
                     "({}), the farthest {:.3g} m beyond it; they are simulated on",
                     left_, seen_, percent(double(left_), double(seen_)), faces_, farthest_)});
  return list;
}

}  // namespace pbf::run_module
