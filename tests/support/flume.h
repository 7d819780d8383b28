// A flume with a wave maker, in two dimensions: 8 m long, 0.3 m deep, waves along x.
#pragma once

#include <string>
#include <vector>

#include "lib/run/linked_files.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {

inline const std::string kRegular =
    "kind: regular_waves, direction: [1, 0, 0], height: 0.06, period: 2";

inline std::string flume_text(const std::string& motion) {
  return "dimensions: 2\n"
         "domain: {min: [0, 0, 0], max: [8, 0.01, 0.6]}\n"
         "fluid: {spacing: 0.01}\n"
         "bodies: [{shape: block, min: [0.2, 0, 0], max: [8, 0.01, 0.3]}]\n"
         "obstacles:\n"
         "  - {name: paddle, shape: box, min: [-0.3, 0, 0], max: [0.2, 0.01, 0.6],\n"
         "     motion: {" +
         motion +
         "}}\n"
         "gauges: [{name: G, kind: level, at: [3]}]\n"
         "solver: {iterations: 1, substeps: 7, levels: on}\n"
         "time: {step: 0.004, end: 8}\n"
         "output: {every: 0.1, gauges_every: 0.02}\n";
}

/// With its table.
inline Scene flume(const std::string& motion, const std::vector<std::string>& set = {}) {
  Scene s = parse(flume_text(motion), set);
  read_linked_files(s, ".");
  return s;
}

/// What is wrong, behind the place in the file.
inline std::string flume_error(const std::string& motion,
                               const std::vector<std::string>& set = {}) {
  return error_of([&] { flume(motion, set); });
}

}  // namespace pbf::scene_test
