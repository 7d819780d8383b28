// The table of diagnostics is that of the page, of the log and of every line of JSON.
#include "lib/solver/diagnostics.h"

#include <fstream>
#include <limits>
#include <regex>
#include <set>

#include "lib/io/run_layout.h"
#include "lib/run/run.h"
#include "tests/support/catch.h"

using namespace pbf;

namespace {

/// `height_kept`, `front_x,y,z`, ... of the first column of the page's tables of names.
std::set<std::string> on_the_page() {
  std::ifstream in(std::string(PBF_SOURCE_DIR) + "/lib/solver/DIAGNOSTICS.md");
  REQUIRE(in);
  std::set<std::string> names;
  const std::regex code("`([a-z_0-9]+(?:,[yz])*)`");
  bool table = false;
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("## Of a study", 0) == 0) break;
    table = line.rfind("| name |", 0) == 0 || (table && line[0] == '|');
    if (!table || line.rfind("| `", 0) != 0) continue;
    const std::string cell = line.substr(0, line.find('|', 1));
    for (std::sregex_iterator m(cell.begin(), cell.end(), code), end; m != end; ++m) {
      const std::string name = (*m)[1];
      const std::size_t comma = name.find(',');
      names.insert(name.substr(0, comma));
      if (comma == std::string::npos) continue;
      for (const char* axis : {"y", "z"}) names.insert(name.substr(0, comma - 1) + axis);
    }
  }
  return names;
}

}  // namespace

TEST_CASE("the page of diagnostics has every row of the table, and no other") {
  std::set<std::string> table;
  for (const Diagnostic& d : diagnostics()) CHECK(table.insert(d.name).second);
  CHECK(on_the_page() == table);
}

TEST_CASE("numbers of a line of JSON have nine digits, whatever came out of sums") {
  Diagnostics m;
  m.time = 0.1 + 0.2;
  m.kinetic_energy = 1.0 / 3;
  m.speed_max = std::numeric_limits<double>::quiet_NaN();
  const std::string json = measure_json(m, 2.0 / 3e5, 2, {{"lambda", 0.1 * 3, 1}}, {}, {});
  for (const char* part :
       {"\"time\":0.3,", "\"kinetic_energy\":0.333333333,", "\"speed_max\":null,",
        "\"wall\":6.66666667e-06,", "\"stages\":{\"lambda\":0.3}"}) {
    CAPTURE(part, json);
    CHECK(json.find(part) != std::string::npos);
  }
}

TEST_CASE("a line of JSON has readings and poses by name and number") {
  Diagnostics m;
  m.readings = {1, 2, 3, 0.5};
  std::vector<ReadingColumn> columns(4);
  columns[0] = {"load", "z_min", "force", "N", "", Join::mean, 3, Series::measures};
  columns[1] = {"level", "H", "", "m"};  // of another series
  columns[2] = {"load", "z_min", "force_peak", "N", "", Join::peak, 1, Series::measures};
  columns[3] = {"pose", "gate", "", "m", "", Join::now, 3, Series::poses};
  const std::string json = measure_json(m, 1, 2, {}, columns, {0.25, 7, 8});
  for (const char* part : {"\"loads\":{\"z_min\":{", "\"force_x\":1.0", "\"force_z\":3.0",
                           "\"force_peak\":0.5", "\"poses\":{\"gate\":{\"x\":0.25,"})
    CHECK(json.find(part) != std::string::npos);
  CHECK(json.find("\"H\"") == std::string::npos);
}

TEST_CASE("every diagnostic is a column of the log and a member of each line of JSON") {
  Diagnostics m;
  m.front[1] = 7;
  m.unresolved = 9;
  const std::string json = measure_json(m, 1, 2, {}, {}, {});
  CHECK(json.find("\"front\":[0.0,7.0,0.0]") != std::string::npos);
  CHECK(json.find("\"unresolved\":9,") != std::string::npos);
  std::size_t k = 4;  // behind time, dt, update, iterations
  const auto& columns = run_layout::log_columns();
  REQUIRE(columns.size() == k + diagnostics().size());
  for (const Diagnostic& d : diagnostics()) {
    CAPTURE(d.name);
    CHECK(std::string(columns[k].name) == d.name);
    CHECK(columns[k].real == (d.number != nullptr));
    CHECK((d.number != nullptr) != (d.integer != nullptr));
    const std::string name = d.name;
    const bool part = name.ends_with("_x") || name.ends_with("_y") || name.ends_with("_z");
    CHECK(json.find("\"" + (part ? name.substr(0, name.size() - 2) : name) + "\":") !=
          std::string::npos);
    ++k;
  }
  LogRow row;
  row.measures = m;
  for (const auto& c : columns)
    if (std::string(c.name) == "unresolved") CHECK(c.value(row) == 9);
}
