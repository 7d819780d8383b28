// Scenes with one feature or another, and the steps of a program as text and as a plain sequence of
// passes, by the passes' names.
#pragma once

#include <array>
#include <cctype>
#include <string>
#include <vector>

#include "lib/program/program.h"
#include "tests/support/scene_samples.h"

namespace pbf::test {

/// The fused passes: each does the work of the two behind it, in that order. Written by hand from
/// kernels/README.md and lib/program/features.
inline const std::vector<std::array<std::string, 3>> kFusedPasses = {
    {"predict+sort", "predict", "sort"},
    {"delta+predict", "delta", "predict"},
    {"xsph+predict+sort", "xsph", "predict+sort"},
    {"delta+pack motion", "delta", "pack motion"},
};

inline std::string pass_name(const ProgramStep& s) {
  return pass_texts()[std::size_t(s.index)].name;
}

/// "lists, 0-2(lambda, delta), until 4(0-2(lambda, delta))": passes, iterations, repetitions.
inline std::string text(const Steps& steps) {
  std::string out;
  for (const ProgramStep& s : steps) {
    if (!out.empty()) out += ", ";
    if (s.kind == ProgramStep::pass) out += pass_name(s);
    if (s.kind == ProgramStep::iterate)
      out += std::to_string(s.first) + "-" + std::to_string(s.first + s.times - 1);
    if (s.kind == ProgramStep::until) out += "until " + std::to_string(s.times);
    if (s.kind != ProgramStep::pass) out += "(" + text(s.body) + ")";
  }
  return out;
}

using Sequence = std::vector<std::string>;

/// One entry per launch: "delta 2" in iteration 2, "predict" outside them. A repetition is
/// "until 4" and its passes once, up to "done".
inline void append(Sequence& to, const Steps& steps, const std::string& iteration = {}) {
  for (const ProgramStep& s : steps) {
    if (s.kind == ProgramStep::pass) to.push_back(pass_name(s) + iteration);
    if (s.kind == ProgramStep::iterate)
      for (int k = s.first; k < s.first + s.times; ++k) append(to, s.body, " " + std::to_string(k));
    if (s.kind != ProgramStep::until) continue;
    to.push_back("until " + std::to_string(s.times));
    append(to, s.body);
    to.push_back("done");
  }
}

/// The same with the fused passes taken apart. An iteration counts for the first of the two alone:
/// the second begins what follows.
inline Sequence taken_apart(const Sequence& launches) {
  Sequence out;
  bool again = false;
  for (const std::string& launch : launches) {
    const std::size_t space = launch.rfind(' ');
    const bool numbered = space != std::string::npos && std::isdigit(launch.back());
    const std::string name = numbered ? launch.substr(0, space) : launch;
    const std::string iteration = numbered ? launch.substr(space) : "";
    bool fused = false;
    for (const auto& [both, first, second] : kFusedPasses)
      if (name == both) out.push_back(first + iteration), out.push_back(second), fused = true;
    if (!fused) out.push_back(launch);
    again = again || fused;
  }
  return again ? taken_apart(out) : out;
}

}  // namespace pbf::test

namespace pbf::scene_test {

inline const std::string kTank =
    "tank_motion: {kind: sine, direction: [1, 0, 0], amplitude: 0.1, period: 1}\n";
inline const std::string kWaveMaker =
    "obstacles: [{name: a, shape: box, min: [0.2, 0.2, 0.7], max: [0.4, 0.6, 0.9], motion: "
    "{kind: sine, direction: [1, 0, 0], amplitude: 0.1, period: 1}}]\n";
inline const std::string kStanding =
    "obstacles: [{name: a, shape: box, min: [0.2, 0.2, 0.7], max: [0.4, 0.6, 0.9]}]\n";
inline const std::string kFlow =
    "gauges: [{name: q, kind: flow, center: [0.5, 0.5, 0.5], normal: [1, 0, 0], size: [1, 1]}]\n";
inline const std::string kLevelGauge = "gauges: [{name: l, kind: level, at: [0.5, 0.5]}]\n";

/// Of kMinimal with three iterations and without levels, unless `set` says otherwise.
inline Program program_of(const std::string& more, std::vector<std::string> set = {},
                          const UpdateShape& shape = {}, bool without_time = false) {
  std::vector<std::string> all{"solver.iterations=3", "solver.levels=off", "time.order=1"};
  all.insert(all.end(), set.begin(), set.end());
  return make_program(parse(kMinimal + more, all), shape, without_time);
}

}  // namespace pbf::scene_test
