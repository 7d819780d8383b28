// What a table of measurements must say before it is compared, and how its units are read.
#include <cmath>

#include "lib/base/error.h"
#include "lib/data/comparison.h"
#include "lib/data/units.h"
#include "tests/support/catch.h"
#include "tests/support/folder.h"

using namespace pbf;

namespace {

/// A level in m and a force in N.
Readings level_and_force() {
  std::vector<ReadingColumn> columns{{"level", "H2", "", "m"}, {"velocity", "U", "", "m/s"}};
  columns[1].components = 3;
  columns.push_back({"load", "post", "force", "N", "", Join::mean, 3, Series::measures});
  return readings_of(columns, false);
}

Measured read(const std::string& table, Comparison c = {}) {
  const test::TemporaryFolder folder;
  folder.write("data.csv", table);
  if (c.gauge.empty() && c.load.empty() && c.log.empty()) c.gauge = "H2";
  c.data = "data.csv";
  const Quantity q = quantity_of(c, level_and_force(), "compare[0]");
  return read_measured(c, q, folder.path.string(), "compare[0].data");
}

std::string refused(const std::string& table, Comparison c = {}) {
  try {
    read(table, std::move(c));
  } catch (const Error& e) {
    CHECK(e.code() == ExitCode::bad_input);
    return e.what();
  }
  return "accepted";
}

bool has(const std::string& text, const std::string& part) {
  CAPTURE(text, part);
  return text.find(part) != std::string::npos;
}

Comparison with(auto&& set) {
  Comparison c;
  set(c);
  return c;
}

}  // namespace

TEST_CASE("units at the ends of names convert times and values") {
  const Measured a = read("t_ms,H2_mm\n0,100\n500,250\n");
  CHECK(a.time[1] == Approx(0.5));
  CHECK(a.value[1] == Approx(0.25));
  CHECK(a.column == "H2_mm");
  const Measured b =
      read("# unit: m\ntime,x_cm\n1,10\n2,\n3,nan\n",
           with([](Comparison& c) { c.column = "x_cm", c.scale = 0.02, c.offset = 0.5; }));
  CHECK(b.value[0] == Approx(0.7));
  CHECK(std::isnan(b.value[1]));
  CHECK(std::isnan(b.value[2]));
  const Measured c = read("t_over_T,F_kN\n0,1\n2,3\n", with([](Comparison& f) {
                            f.load = "post", f.component = "x", f.column = "F_kN";
                            f.time_scale = 1.5;
                          }));
  CHECK(c.time[1] == Approx(3));
  CHECK(c.value[1] == Approx(3000));
  CHECK(named_unit("U_x_m_s").unit->ending == std::string("_m_s"));
  CHECK(named_unit("U_x_m_s").name == "U_x");
  CHECK_FALSE(named_unit("t_over_T").unit);
  CHECK(unit_ending("kg m/s") == "_kg_m_s");
}

TEST_CASE("every unit of a reading has an ending that is read back as that unit") {
  for (const char* unit :
       {"m", "s", "m/s", "Pa", "N", "N m", "N s", "kg", "kg/s", "kg m/s", "J", "kg/m^3", "rad/s"}) {
    const NamedUnit named = named_unit("a" + unit_ending(unit));
    CAPTURE(unit);
    REQUIRE(named.unit);
    CHECK(named.unit->unit == std::string(unit));
    CHECK(named.unit->factor == 1);
    CHECK(named.name == "a");
  }
}

TEST_CASE("a column is found by the name of its reading, with a unit and without") {
  CHECK(read("t,H1_m,H2_m\n0,1,2\n1,3,4\n").value[0] == 2);
  const auto load = [](Comparison& c) { c.load = "post", c.component = "x"; };
  for (const char* name : {"load_post_x_N", "post_x_N", "load_post_force_x_N", "post_force_x_N"})
    CHECK(read(std::string("t,") + name + "\n0,1\n1,3\n", with(load)).value[1] == 3);
  CHECK(read("t,U_x_m_s\n0,1\n1,3\n", with([](Comparison& c) { c.gauge = "U", c.component = "x"; }))
            .value[1] == 3);
}

TEST_CASE("each mistake in a table is one sentence with file, column and remedy") {
  CHECK(has(refused("t_over_T,H2_m\n0,1\n1,2\n"),
            "data.csv:1: column t_over_T has no unit of time; give time_scale"));
  CHECK(has(refused("t,H2\n0,1\n1,2\n"), "column H2 has no unit; end its name in one (H2_m)"));
  CHECK(has(refused("t,H2_Pa\n0,1\n1,2\n"), "column H2_Pa is in Pa, and H2 is in m"));
  CHECK(has(refused("t,H3_m\n0,1\n1,2\n"), "no column is named as the reading, H2; give column"));
  CHECK(has(refused("t,H2_m,H2_mm\n0,1,2\n1,2,3\n"), "H2_m and H2_mm are both named"));
  CHECK(has(refused("t,H2_m\n", {}), "holds no rows of numbers"));
  CHECK(has(refused("t,H2_m\n1,1\n0,2\n"),
            "data.csv:3: time 0 does not follow 1; times must not decrease"));
  CHECK(has(refused("t,H2_m\n0,1\n1,two\n"), "data.csv:3: H2_m: \"two\" is not a number"));
  CHECK(has(refused("t,H2_m\n0,\n1,nan\n"), "column H2_m holds no number"));
  CHECK(has(refused("t;H2_m\n0;1\n1;2\n"), "commas part the columns"));
  CHECK(has(refused("t,H2_m\n,1\n1,2\n"), "has no time in column t"));
  CHECK(has(refused("t,height_m\n0,1\n1,2\n", with([](Comparison& c) { c.column = "heigth_m"; })),
            "no column heigth_m; did you mean height_m?"));
  CHECK(has(refused("t,H2_m\n0,1\n1,2\n", with([](Comparison& c) { c.time_column = "seconds"; })),
            "no column of times seconds"));
}

TEST_CASE("a reading that is not there is named with the nearest one") {
  const auto of = [](auto&& set) {
    try {
      quantity_of(with(set), level_and_force(), "compare[3]");
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  CHECK(has(of([](Comparison& c) { c.gauge = "H3"; }), "compare[3]: no gauge is named H3; "));
  CHECK(has(of([](Comparison& c) { c.log = "front_y_"; }), "the log has no column front_y_"));
  CHECK(has(of([](Comparison& c) { c.gauge = "U"; }), "reads a vector; give component"));
  CHECK(of([](Comparison& c) { c.log = "load/post/torque_y"; }) != "accepted");
  CHECK(of([](Comparison& c) { c.log = "load/post/force_y"; }) == "accepted");
  CHECK(has(of([](Comparison& c) { c.gauge = "H2", c.component = "x"; }), "reads one number"));
  CHECK(has(of([](Comparison& c) { c.log = "work"; }), "the log has no column work"));
}
