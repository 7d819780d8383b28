#include "lib/solver/step_solver.h"

#include <algorithm>

#include "lib/base/error.h"

namespace pbf::solver_module {

bool fits(const SolverState& s, std::int64_t n, bool changes) {
  const std::size_t most = std::size_t(n), count = s.id.size();
  if (changes ? count > most : count != most) return false;
  if (s.position.size() != 3 * count || s.velocity.size() != 3 * count) return false;
  std::vector<std::int64_t> sorted;  // a copy only where it is needed: solvers return them in order
  if (!std::is_sorted(s.id.begin(), s.id.end())) {
    sorted = s.id;
    std::sort(sorted.begin(), sorted.end());
  }
  const std::vector<std::int64_t>& id = sorted.empty() ? s.id : sorted;
  if (id.empty()) return true;
  return id.front() >= 0 && std::adjacent_find(id.begin(), id.end()) == id.end() &&
         (changes || id.back() == n - 1);
}

void check_state(const SolverState& s, std::int64_t n, bool changes) {
  if (!fits(s, n, changes))
    throw Error(ExitCode::internal, "a state of " + std::to_string(s.id.size()) +
                                        " particles does not fit a solver of " + std::to_string(n) +
                                        (changes ? ", or its ids are negative or not unique"
                                                 : ", or its ids are not 0..n-1"));
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

}  // namespace pbf::solver_module
