// A state that can be passed from one solver to another, and to a checkpoint.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "lib/scene/backend.h"

namespace pbf::solver_module {

/// A field of a state besides position, velocity and id.
struct StoredField {
  std::string name;  ///< FieldInfo::name
  bool real;         ///< numbers of the solver's precision
  int numbers = 1;   ///< of a row; vectors are along the scene's axes
  /// In the order of rows; those of particles are in the order of SolverState::id.
  std::vector<double> values{};
  bool operator==(const StoredField&) const = default;
};

/// A state: positions in h from Scene::origin(), velocities in h/s, along the scene's axes. A
/// solver returns it in the order of ids and accepts any order.
struct SolverState {
  Precision precision = Precision::dbl;  ///< of the solver that returned it
  std::int64_t updates = 0;              ///< done so far
  std::int64_t steps = 0;                ///< done so far: above level 0 more than updates
  std::vector<double> position;          ///< 3n, h
  std::vector<double> velocity;          ///< 3n, h/s
  std::vector<std::int64_t> id;          ///< n; unique, not negative
  std::vector<StoredField> fields{};     ///< of features, and the counts

  const StoredField* find(const std::string& name) const {
    const auto at = std::find_if(fields.begin(), fields.end(),
                                 [&](const StoredField& f) { return f.name == name; });
    return at == fields.end() ? nullptr : &*at;
  }
};

/// Whether places, velocities and ids of a state are those of n particles with the ids 0..n-1, in
/// any order; with `changes` of at most n, whose ids are unique and not negative.
bool fits(const SolverState& state, std::int64_t n, bool changes);

}  // namespace pbf::solver_module
