#include "lib/io/run_layout.h"

namespace pbf::inline io_module::run_layout {

double LogColumn::value(const LogRow& r) const {
  if (diagnostic) return diagnostic->value(r.measures);
  return number ? number(r) : double(integer(r));
}

std::int64_t LogColumn::whole(const LogRow& r) const {
  return diagnostic ? diagnostic->integer(r.measures) : integer(r);
}

const std::vector<LogColumn>& log_columns() {
  using Row = const LogRow&;
  static const std::vector<LogColumn> columns = [] {
    std::vector<LogColumn> all = {
        {"time", "s", true, [](Row r) { return r.measures.time; }},
        {"dt", "s", true, [](Row r) { return r.dt; }},
        {"update", "1", false, nullptr, [](Row r) { return r.measures.update; }},
        {"iterations", "1", false, nullptr, [](Row r) { return std::int64_t{r.iterations}; }}};
    for (const Diagnostic& d : diagnostics())
      all.push_back({d.name, d.unit, d.number != nullptr, nullptr, nullptr, &d});
    return all;
  }();
  return columns;
}

std::vector<FurtherNumber> further_numbers(const LogRow& row) {
  std::vector<FurtherNumber> all;
  for (const StageTime& s : row.stages) all.push_back({"stage/" + s.name, "s", s.seconds});
  for (const ObstaclePose& p : row.poses) {
    const std::string name = "pose/" + p.name + "/";
    for (std::size_t k = 0; k < 3; ++k)
      all.push_back({name + std::string(1, "xyz"[k]), "m", p.middle[k]});
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t l = 0; l < 3; ++l)
        all.push_back({name + "turn_" + "xyz"[k] + "xyz"[l], "1", p.turn[k][l]});
  }
  if (row.measures.moved) all.push_back({"work", "J", row.measures.work});
  for (const WallLoad& l : row.measures.loads)
    for (const LoadNumber& n : load_numbers())
      all.push_back({"load/" + l.wall + "/" + n.name, n.unit, n.value(l)});
  return all;
}

}  // namespace pbf::inline io_module::run_layout
