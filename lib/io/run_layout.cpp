#include "lib/io/run_layout.h"

namespace pbf::io_module::run_layout {

const std::vector<LogColumn>& log_columns() {
  using Row = const LogRow&;
  static const std::vector<LogColumn> columns = [] {
    std::vector<LogColumn> all = {
        {"time", "s", true, [](Row r) { return r.measures.time; }},
        {"dt", "s", true, [](Row r) { return r.dt; }},
        {"update", "1", false, [](Row r) { return double(r.measures.update); }},
        {"iterations", "1", false, [](Row r) { return double(r.iterations); }}};
    for (const Diagnostic& d : diagnostics())
      all.push_back(
          {d.name, d.unit, d.number != nullptr, [&d](Row r) { return d.value(r.measures); }});
    return all;
  }();
  return columns;
}

std::string further_column(const ReadingColumn& c, int component) {
  return std::string(c.kind) + "/" + c.of + "/" + number_name(c, component);
}

std::vector<FurtherNumber> further_numbers(const LogRow& row,
                                           const std::vector<ReadingColumn>& columns) {
  std::vector<FurtherNumber> all;
  for (const StageTime& s : row.stages) all.push_back({"stage/" + s.name, "s", s.seconds});
  const auto add = [&](Series series, const std::vector<double>& numbers) {
    for_each_number(columns, series, [&](const ReadingColumn& c, int component, std::size_t k) {
      all.push_back({further_column(c, component), c.unit, numbers.at(k)});
    });
  };
  add(Series::poses, row.poses);
  if (row.measures.moved) all.push_back({"work", "J", row.measures.work});
  add(Series::measures, row.measures.readings);
  return all;
}

}  // namespace pbf::io_module::run_layout
