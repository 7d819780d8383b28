// Gauges as plain data. A kind of gauges is a struct with its keys as members and
//   Tally         how the sums behind a reading are made (kernels/gauge_probe.h)
//   word, about   its name in scenes; what it reads, with units, for the help
//   columns       the data of a reading; the first one has the gauge's own name
//   keys()        its rows in the table of keys
// Rules: check_gauges.cpp. Readings: lib/program/gauges.cpp.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "kernels/boundary/loads.h"
#include "kernels/gauge_probe.h"
#include "kernels/pass_flow.h"
#include "lib/scene/kinds.h"
#include "lib/scene/vector3.h"

namespace pbf::scene_module {

/// What a number of a reading is: the value at its update, the mean or the largest value of the
/// updates since the last reading, or the sum since the start.
enum class Join { now, mean, peak, total };

/// Data of a reading: one number, or the components of a vector.
struct GaugeColumn {
  const char* name;  ///< "total"; empty for the first one
  const char* unit;
  Join join;
  int components = 1;
};

namespace gauge_keys {

inline constexpr const char* kAtHelp =
    "Of a level where the line is along the other axes, [x, y], in two dimensions [x]; else the "
    "place, [x, y, z].";

inline constexpr const char* kConnectedHelp =
    "Counts only up to the first dry stretch longer than fluid.spacing, which leaves out drops and "
    "jets. A level is read from the end that gravity points to.";

struct Level {
  using Tally = ProbeTally;
  static constexpr const char* word = "level";
  static constexpr const char* about = "the wetted length of a line along gravity's axis (m)";
  static constexpr std::array columns{GaugeColumn{"", "m", Join::now}};
  std::vector<double> at{};  ///< m, coordinates across the line
  bool connected = false;
  bool operator==(const Level&) const = default;

  static auto keys() {
    return std::tuple{
        KindKey{&Level::at, "at", "m", kCoordinate, kAtHelp, true, FlatY::none, false, 3},
        KindKey{&Level::connected, "connected", "", Range{}, kConnectedHelp, false}};
  }
};

struct Line {
  using Tally = ProbeTally;
  static constexpr const char* word = "line";
  static constexpr const char* about =
      "the wetted length of any line (m), a run-up where it lies along a slope";
  static constexpr std::array columns{GaugeColumn{"", "m", Join::now}};
  Double3 from{}, to{};  ///< m
  bool connected = false;
  bool operator==(const Line&) const = default;

  static auto keys() {
    return std::tuple{
        KindKey{&Line::from, "from", "m", kCoordinate,
                "Where the line begins. Above a slope leave fluid.spacing or more between them.",
                true, FlatY::middle},
        KindKey{&Line::to, "to", "m", kCoordinate, "Where it ends.", true, FlatY::middle},
        KindKey{&Line::connected, "connected", "", Range{}, kConnectedHelp, false}};
  }
};

struct Velocity {
  using Tally = ProbeTally;
  static constexpr const char* word = "velocity";
  static constexpr const char* about =
      "that of the fluid around a place (m/s), nan where there is none";
  static constexpr std::array columns{GaugeColumn{"", "m/s", Join::now, 3}};
  std::vector<double> at{};        ///< m
  std::optional<double> within{};  ///< m; absent: h
  bool operator==(const Velocity&) const = default;

  static auto keys() {
    return std::tuple{
        KindKey{&Velocity::at, "at", "m", kCoordinate, kAtHelp, true, FlatY::middle, false, 3},
        KindKey{&Velocity::within, "within", "m", kLength,
                "Fluid within this distance counts, with weights that fall to 0 there; at least "
                "fluid.spacing.",
                false, FlatY::none, false, 0, false, "the smoothing length h"}};
  }
};

struct Flow {
  using Tally = FlowTally;
  static constexpr const char* word = "flow";
  static constexpr const char* about =
      "mass through a rectangle per time (kg/s), and all of it (kg)";
  static constexpr std::array columns{GaugeColumn{"", "kg/s", Join::mean},
                                      GaugeColumn{"total", "kg", Join::total}};
  Double3 center{};            ///< m, middle of the rectangle
  Double3 normal{1, 0, 0};     ///< the positive direction
  std::vector<double> size{};  ///< m, the level edge and the other; in two dimensions one length
  bool operator==(const Flow&) const = default;

  static auto keys() {
    return std::tuple{
        KindKey{&Flow::center, "center", "m", kCoordinate, "Middle of the rectangle.", true,
                FlatY::middle},
        KindKey{&Flow::normal, "normal", "", Range{-1e6, 1e6},
                "At right angles to the rectangle; flow this way counts as positive.", true,
                FlatY::zero},
        KindKey{&Flow::size, "size", "m", Range{1e-9, 1e12},
                "Its edges: the level one (along x where the normal is along z), then the other. "
                "In two dimensions the length of a line, [size].",
                true, FlatY::none, false, 2}};
  }
};

struct Pressure {
  using Tally = PatchTally;
  static constexpr const char* word = "pressure";
  static constexpr const char* about =
      "the normal load on a disc of a surface over its area (Pa), mean and peak";
  static constexpr std::array columns{GaugeColumn{"", "Pa", Join::mean},
                                      GaugeColumn{"peak", "Pa", Join::peak}};
  std::vector<double> at{};  ///< m
  std::string on{};          ///< an obstacle, or a wall of the domain
  double radius = 0;         ///< m, of the disc
  bool operator==(const Pressure&) const = default;

  static auto keys() {
    return std::tuple{
        KindKey{&Pressure::at, "at", "m", kCoordinate, kAtHelp, true, FlatY::middle, false, 3},
        KindKey{&Pressure::on, "on", "", Range{},
                "The obstacle, or the wall of the domain (x_min), that `at` lies on."},
        KindKey{&Pressure::radius, "radius", "m", kLength,
                "Of the disc, of which what lies on the surface counts; at least 2 fluid.spacing. "
                "In two dimensions half the length of a strip."}};
  }
};

/// The kinds in the order of their words on pages, and their tallies.
using Any = std::variant<Level, Line, Velocity, Flow, Pressure>;
template <template <class> class Of>
using EachTally = std::tuple<Of<ProbeTally>, Of<FlowTally>, Of<PatchTally>>;

}  // namespace gauge_keys

struct Gauge {
  std::string name;
  gauge_keys::Any kind{};
  bool operator==(const Gauge&) const = default;
};

}  // namespace pbf::scene_module
