// Emitters and sinks as plain data. lib/scene/nozzle.h has the geometry of an emitter, and
// lib/program/emission.h what it emits when.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lib/scene/motion.h"

namespace pbf::scene_module {

enum class NozzleShape { disc, rectangle };

/// A nozzle from which layers of particles come. `shape` decides which members are used.
struct Emitter {
  std::string name;
  NozzleShape shape = NozzleShape::disc;
  Double3 center{};             ///< m, middle of the opening
  Double3 normal{1, 0, 0};      ///< the direction in which the particles leave
  double radius = 0;            ///< m, disc
  std::vector<double> size{};   ///< m, rectangle: the level edge and the other; one length in 2-D
  std::optional<double> speed;  ///< m/s; absent: that of the file
  std::string path;             ///< CSV t,V; empty: none
  Place place{};                ///< of the path
  double start = 0;             ///< s
  std::optional<double> end;    ///< s; absent: time.end
  MotionTable table{};          ///< of the file; not a key
  bool operator==(const Emitter&) const = default;
};

/// A box in which particles are removed.
struct Sink {
  std::string name;
  Double3 min{}, max{};  ///< m
  bool operator==(const Sink&) const = default;
};

}  // namespace pbf::scene_module
