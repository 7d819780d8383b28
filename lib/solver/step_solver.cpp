#include "lib/solver/step_solver.h"

#include <algorithm>

#include "lib/base/error.h"

namespace pbf::inline solver_module {

void check_state(const SolverState& s, std::int64_t n, bool changes) {
  const std::size_t most = std::size_t(n), count = s.id.size();
  bool good = (changes ? count <= most : count == most) && s.position.size() == 3 * count &&
              s.velocity.size() == 3 * count;
  std::vector<bool> seen(good ? count : 0, false);
  for (std::size_t k = 0; good && !changes && k < count; ++k) {
    const auto id = std::size_t(s.id[k]);
    good = s.id[k] >= 0 && id < count && !seen[id];
    if (good) seen[id] = true;
  }
  if (changes) {
    std::vector<std::int32_t> id = s.id;
    std::sort(id.begin(), id.end());
    good =
        good && (id.empty() || id[0] >= 0) && std::adjacent_find(id.begin(), id.end()) == id.end();
  }
  if (!good)
    throw Error(ExitCode::internal,
                "a state of " + std::to_string(s.id.size()) +
                    " particles does not fit a solver of " + std::to_string(n) +
                    (changes ? ", or its ids are not unique" : ", or its ids are not 0..n-1"));
}

Snapshot empty_snapshot(const std::vector<std::string>& fields, ScalarType type, std::size_t n,
                        std::int64_t update, double time) {
  bool velocity = false, density = false;
  for (const std::string& f : fields) {
    if (f == "velocity")
      velocity = true;
    else if (f == "density")
      density = true;
    else if (f != "position" && f != "id")
      throw Error(ExitCode::bad_input, "no field \"" + f + "\"; there are velocity and density");
  }
  Snapshot s;
  s.update = update;
  s.time = time;
  s.count = n;
  auto add = [&](const char* name, const char* unit, ScalarType t, int components) {
    s.fields.push_back({name, unit, t, components, {}});
    s.fields.back().bytes.resize(n * std::size_t(components) * size_of(t));
  };
  add("position", "m", type, 3);
  if (velocity) add("velocity", "m/s", type, 3);
  if (density) add("density", "kg/m^3", type, 1);
  add("id", "1", ScalarType::i32, 1);
  auto id = s.fields.back().as<std::int32_t>();
  for (std::size_t i = 0; i < n; ++i) id[i] = std::int32_t(i);
  return s;
}

}  // namespace pbf::inline solver_module
