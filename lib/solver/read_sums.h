// Reads what passes have summed for loads and gauges (with Interval::ends, means begin again), and
// the histogram of compression.
#pragma once

#include <algorithm>
#include <vector>

#include "kernels/compression_bins.h"
#include "lib/solver/launch.h"
#include "lib/solver/solver.h"

namespace pbf::PBF_VARIANT {

/// Rows first ... first + count - 1 of field::loads.
template <class C>
std::vector<Load> read_loads(C& c, std::int64_t first, std::int64_t count, Interval interval) {
  if (count <= 0) return {};
  std::vector<Load> now(std::size_t(count), Load{});
  Load* from = c.data(field::loads) + first;
  c.exec.to_host(from, now.size(), now.data());
  if (interval != Interval::ends) return now;
  std::vector<Load> next;
  for (const Load& load : now) next.push_back(load.begun_again());
  c.exec.to_device(next.data(), next.size(), from);
  return now;
}
/// The loads of walls and obstacles, whose rows are the first.
template <class C>
std::vector<Load> read_loads(C& c, Interval interval) {
  return read_loads(c, 0, load_walls(c.scene) - gauges_of<PatchTally>(c.scene), interval);
}

/// What took energy from the motion, since the start.
template <class C>
std::vector<DissipationSum> read_dissipation(C& c) {
  std::vector<DissipationSum> sums(c.kept_rows(field::dissipation));
  if (!sums.empty()) c.sums_to_host(c.data(field::dissipation), sums);
  return sums;
}

/// What emitters have brought and sinks taken, since the start.
template <class C>
std::vector<EmissionSum> read_emission(C& c) {
  std::vector<EmissionSum> sums(comes_and_goes(c.scene) ? c.kept_rows(field::emission_sums) : 0);
  if (!sums.empty()) c.exec.to_host(c.data(field::emission_sums), sums.size(), sums.data());
  return sums;
}

/// The sums of the gauges of a tally.
template <class C, class Tally>
void read_sums(C& c, std::vector<typename Tally::Sums>& rows, Interval interval) {
  rows.resize(std::size_t(c.plan.gauges.template of<Tally>().sums));
  if (rows.empty()) return;
  if constexpr (std::is_same_v<Tally, PatchTally>) {
    rows = read_loads(c, load_row_of_patch(c.scene, 0), std::int64_t(rows.size()), interval);
  } else if constexpr (std::is_same_v<Tally, FlowTally>) {
    c.exec.to_host(c.data(field::flows), rows.size(), rows.data());
    std::vector<FlowCount> next = rows;
    for (FlowCount& f : next) f.since = 0, f.time = 0;
    if (interval == Interval::ends) c.put(field::flows, next);
  } else {
    c.put(field::gauge_sums<Tally>, rows);
    launch_one<ReadGauges<Tally>>(c);
    c.sums_to_host(c.data(field::gauge_sums<Tally>), rows);
  }
}

/// The numbers of the columns of Series::gauges (lib/program/column.h).
template <class C>
std::vector<double> read_gauges(C& c, Interval interval) {
  c.exec.begin();
  GaugeSums sums;
  std::apply([&]<class... Tally>(
                 TallySums<Tally>&... of) { (read_sums<C, Tally>(c, of.rows, interval), ...); },
             sums);
  c.exec.mark("measure");
  return c.plan.gauges.finish(sums);
}

/// A compression that at least `count` of n particles do not exceed: the upper end of a bin of the
/// histogram, thus at most 1/32 too large, and at most the maximum.
inline double compression_percentile(const std::vector<std::int64_t>& in_bin, std::int64_t count,
                                     std::int64_t n, double max) {
  std::int64_t above = 0;
  for (int b = kCompressionBins - 1; b >= 0; --b) {
    above += in_bin[std::size_t(b)];
    if (n - above < count) return std::min(compression_bin_end(b), max);
  }
  return 0;
}

}  // namespace pbf::PBF_VARIANT
