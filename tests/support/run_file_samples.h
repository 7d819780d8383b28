// What the tests of the run file write: snapshots whose every number can be recomputed.
#pragma once

#include <string>

#include "lib/io/run_file.h"
#include "tests/support/folder.h"

namespace pbf::test {

inline double sample_value(std::int64_t frame, std::size_t row, int component, int field) {
  return static_cast<double>(frame) + 0.25 * static_cast<double>(row % 1024) + 1000.0 * component +
         8192.0 * field;  // exact in float
}

inline FieldArray sample_field(const std::string& name, const std::string& unit, ScalarType type,
                               int components, int field, std::int64_t frame, std::size_t count) {
  FieldArray f{name, unit, type, components, {}};
  const std::size_t values = count * static_cast<std::size_t>(components);
  f.bytes.resize(values * size_of(type));
  for (std::size_t i = 0; i < values; ++i) {
    const std::size_t row = i / static_cast<std::size_t>(components);
    const double v = sample_value(frame, row, static_cast<int>(i % components), field);
    if (type == ScalarType::f64) f.as<double>()[i] = v;
    if (type == ScalarType::f32) f.as<float>()[i] = static_cast<float>(v);
    if (type == ScalarType::i32) f.as<std::int32_t>()[i] = static_cast<std::int32_t>(row);
    if (type == ScalarType::i64) f.as<std::int64_t>()[i] = static_cast<std::int64_t>(row);
  }
  return f;
}

/// Position, velocity, density and id of frame `frame`.
inline Snapshot sample(std::int64_t frame, std::size_t count, ScalarType real = ScalarType::f32) {
  Snapshot s{10 * frame, 0.02 * static_cast<double>(frame), count, {}};
  s.fields.push_back(sample_field("position", "m", real, 3, 0, frame, count));
  s.fields.push_back(sample_field("velocity", "m/s", real, 3, 1, frame, count));
  s.fields.push_back(sample_field("density", "kg/m^3", real, 1, 2, frame, count));
  s.fields.push_back(sample_field("id", "1", ScalarType::i32, 1, 3, frame, count));
  return s;
}

/// The particles of a frame have these ids.
inline Snapshot with_ids(Snapshot s, const std::vector<std::int64_t>& ids,
                         ScalarType type = ScalarType::i32) {
  s.fields.back() = sample_field("id", "1", type, 1, 3, 0, ids.size());
  for (std::size_t k = 0; k < ids.size(); ++k)
    if (type == ScalarType::i64)
      s.fields.back().as<std::int64_t>()[k] = ids[k];
    else
      s.fields.back().as<std::int32_t>()[k] = static_cast<std::int32_t>(ids[k]);
  return s;
}

/// Where two free bodies are in frame k.
inline std::vector<BodyMotion> sample_bodies(std::int64_t k) {
  std::vector<BodyMotion> bodies(2);
  double number = 100.0 * static_cast<double>(k);
  for (BodyMotion& body : bodies) BodyMotion::each(body, [&](double& x) { x = number += 1; });
  return bodies;
}

/// The particles of frame k of a run in which they appear and disappear: as many as at the start,
/// fewer, none, and some whose ids have gaps.
inline Snapshot changing_particles(std::int64_t k) {
  if (k % 8 == 5) return sample(k, 0);
  if (k % 4 != 3) return sample(k, k % 3 == 2 ? 30 : 40);
  std::vector<std::int64_t> ids;
  for (std::int64_t i = 0; i < 35; ++i) ids.push_back(k + i + i / 3);
  return with_ids(sample(k, ids.size()), ids);
}
/// The same with free bodies.
inline Snapshot changing_sample(std::int64_t k) {
  Snapshot s = changing_particles(k);
  s.bodies = sample_bodies(k);
  return s;
}

inline bool same(const Snapshot& a, const Snapshot& b) {
  if (a.update != b.update || a.time != b.time || a.count != b.count) return false;
  if (a.bodies != b.bodies) return false;
  if (a.fields.size() != b.fields.size() || a.fields.at(0).name != "position") return false;
  for (const auto& f : a.fields) {
    const FieldArray* g = b.find(f.name);
    if (!g || g->unit != f.unit || g->type != f.type || g->components != f.components ||
        g->bytes != f.bytes)
      return false;
  }
  return true;
}

inline RunInfo sample_info(std::int64_t particles) {
  RunInfo info;
  info.scene_path = "scenes/drop \xC3\xA4.yaml";
  info.scene_text = "# a scene\n" + std::string(100000, 'x') + "\n";  // beyond 64 KB
  info.resolved_scene = "name: drop\n";
  info.overrides = {"time.step=0.001", "threads=2"};
  info.program_version = "0.1.0";
  info.commit = "0123abc";
  info.compiler = "g++ 12";
  info.build_flags = "-O3";
  info.host = "node1";
  info.started = "2026-01-02T03:04:05Z";
  info.scene_files = std::string(64, 'a') + "  drop.csv\n";
  info.scene_sha256 = std::string(64, 'b');
  info.plan = "predict grid neighbors";
  info.solver = {"cpu", "float", "a processor", "", 2, 0.125, 1.5, 123456};
  info.domain_min = {-1, 0, 0.5};
  info.domain_max = {1, 2, 3};
  info.spacing = 0.02;
  info.smoothing_length = 0.04;
  info.rest_density = 998;
  info.particles = particles;
  return info;
}

inline RunInfo changing_info() {
  RunInfo info = sample_info(40);
  info.capacity = 44;
  info.bodies = {"float", "raft"};
  return info;
}

inline LogRow sample_row(std::int64_t k) {
  LogRow row;
  row.measures.time = 0.01 * static_cast<double>(k);
  row.measures.update = 5 * k;
  row.measures.compression_mean = 1e-3 * static_cast<double>(k);
  row.measures.momentum[2] = -2.0 * static_cast<double>(k);
  row.measures.neighbors_max = 30 + k;
  row.iterations = 4;
  row.dt = 0.002;
  row.stages = {{"predict", 0.5 * static_cast<double>(k), 5}, {"lambda", 2, 20}};
  return row;
}

}  // namespace pbf::test
