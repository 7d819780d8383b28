// Scenes and files for the tests of lib/scene.
#pragma once

#include <random>
#include <string>
#include <vector>

#include "lib/base/error.h"
#include "lib/scene/load.h"
#include "lib/scene/overrides.h"
#include "lib/scene/validate.h"
#include "tests/support/folder.h"

namespace pbf::scene_test {

/// The smallest scene: 10 x 10 x 5 particles. Five lines: what is appended starts at line 6.
inline const std::string kMinimal =
    "domain: {min: [0, 0, 0], max: [1, 1, 1]}\n"
    "fluid: {spacing: 0.1}\n"
    "bodies:\n"
    "  - {shape: block, min: [0, 0, 0], max: [1, 1, 0.5]}\n"
    "time: {step: 0.01, end: 1}\n";

/// kMinimal with other bodies.
inline std::string with_bodies(const std::string& bodies) {
  return "domain: {min: [0, 0, 0], max: [1, 1, 1]}\nfluid: {spacing: 0.1}\nbodies: " + bodies +
         "\ntime: {step: 0.01, end: 1}\n";
}

/// A particle file: a ball of the lattice, d = 0.05 m, radius 5 d, in the middle of a box of 1 m,
/// every coordinate off its place by up to `jitter` d.
inline std::string jittered_ball(double jitter, std::mt19937& gen) {
  const auto off = [&] { return jitter * (double(gen()) / 4294967295.0 * 2 - 1); };
  std::string rows = "x,y,z\n";
  for (int i = -5; i <= 5; ++i)
    for (int j = -5; j <= 5; ++j)
      for (int k = -5; k <= 5; ++k)
        if (i * i + j * j + k * k <= 25)
          rows += std::to_string(0.5 + 0.05 * (i + off())) + "," +
                  std::to_string(0.5 + 0.05 * (j + off())) + "," +
                  std::to_string(0.5 + 0.05 * (k + off())) + "\n";
  return rows;
}

inline Scene parse(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return parse_scene(text, "scene.yaml", overrides);
}

/// Any struct with a table of keys, read from YAML and settings ("key=value").
template <class Struct>
Struct read_struct(const KeyTable& table, const std::string& text, const std::string& file,
                   const std::vector<std::string>& settings) {
  Node root = parse_yaml(text, file, true);
  Problems problems;
  for (const std::string& setting : settings) apply_override(root, setting, problems);
  Struct out;
  read_tree(table, root, object(out), problems);
  problems.raise();
  return out;
}

/// The scene configs/NAME.yaml on one thread, without files of frames.
inline Scene shipped(const std::string& name, std::vector<std::string> overrides = {}) {
  overrides.push_back("threads=1");
  Scene s = load_scene(PBF_SOURCE_DIR "/configs/" + name + ".yaml", overrides).scene;
  s.output.reset();
  return s;
}

/// Runs `action`; the message of the Error it throws, with its exit code in front: "2 message".
/// "no error" when it throws none.
template <class Action>
std::string error_of(Action action) {
  try {
    action();
  } catch (const Error& e) {
    return std::to_string(static_cast<int>(e.code())) + " " + e.what();
  }
  return "no error";
}

inline std::string parse_error(const std::string& text,
                               const std::vector<std::string>& overrides = {}) {
  return error_of([&] { parse(text, overrides); });
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

using test::read_file;
using Folder = test::TemporaryFolder;

}  // namespace pbf::scene_test
