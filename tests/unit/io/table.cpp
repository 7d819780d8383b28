#include "lib/io/table.h"

#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "lib/base/error.h"
#include "tests/support/catch.h"
#include "tests/support/folder.h"

using namespace pbf;

TEST_CASE("a CSV table quotes what needs it and leaves missing values empty", "[table]") {
  Table table({"name", "a,b", "n", "x", "ok"});
  table.add({std::string("say \"hi\""), std::string("one\ntwo"), std::int64_t{-7}, 0.1, true});
  table.add({std::string("plain"), {}, {}, std::nan(""), false});
  CHECK(table.csv() ==
        "name,\"a,b\",n,x,ok\n"
        "\"say \"\"hi\"\"\",\"one\ntwo\",-7,0.1,true\n"
        "plain,,,nan,false\n");
  CHECK(table.rows() == 2);
}

TEST_CASE("numbers of a table read back as the same bits, from CSV and from JSON", "[table]") {
  for (const double v : {0.1, 1.0 / 3, 1e-300, -1.7976931348623157e308, 5e-324, 123456789.125}) {
    Table table({"v"});
    table.add({v});
    CHECK(std::strtod(table.csv().c_str() + 2, nullptr) == v);
    const std::string json = json_text(table.json());
    REQUIRE(json.rfind("[{\"v\":", 0) == 0);
    CHECK(std::strtod(json.c_str() + 6, nullptr) == v);
  }
  Table table({"v"});
  table.add({std::numeric_limits<std::int64_t>::min()});
  CHECK(json_text(table.json()) == "[{\"v\":-9223372036854775808}]");
}

TEST_CASE("a table as JSON is one object per row, with null for what is missing", "[table]") {
  Table table({"n", "s", "a"});
  table.add({std::int64_t{1}, std::string("x"), true});
  table.add({std::int64_t{2}, {}, std::nan("")});
  CHECK(json_text(table.json()) ==
        "[{\"n\":1,\"s\":\"x\",\"a\":true},{\"n\":2,\"s\":null,\"a\":null}]");
  CHECK(json_text(Table({"n"}).json()) == "[]");
}

TEST_CASE("a table for people is aligned, also where a word is wider than its column", "[table]") {
  struct Row {
    std::string name;
    double share;
  };
  const TableOf<Row> table({{"name", [](const Row& r) { return r.name; }, -6},
                            {"share", [](const Row& r) { return known(r.share); }, 8, "{:.2f}"},
                            {"", [](const Row& r) { return r.share > 1 ? "much" : ""; }, -1}},
                           {{"a", 0.5}, {"longer name", 2}, {"b", std::nan("")}});
  CHECK(table.text(" ") ==
        " name           share\n"
        " a               0.50\n"
        " longer name     2.00 much\n"
        " b                  -\n");
  CHECK(table.csv() == "name,share,\na,0.5,\nlonger name,2,much\nb,,\n");
}

TEST_CASE("a row of the wrong length is a defect", "[table]") {
  Table table({"a", "b"});
  CHECK_THROWS_AS(table.add({std::int64_t{1}}), Error);
}

TEST_CASE("a text file appears whole or not at all", "[table]") {
  const test::TemporaryFolder folder;
  const std::string path = folder / "table.csv";
  write_text_file(path, "old\n");
  write_text_file(path, "new\n");
  CHECK(test::read_file(path) == "new\n");
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path), {}) == 1);
  try {
    write_text_file(folder / "missing/table.csv", "x");
    FAIL("no error");
  } catch (const Error& e) {
    CHECK(e.code() == ExitCode::io);
    CHECK(std::string(e.what()).find("missing/table.csv") != std::string::npos);
    CHECK(std::string(e.what()).find("No such file") != std::string::npos);
  }
  std::filesystem::create_directory(folder / "taken");
  CHECK_THROWS_AS(write_text_file(folder / "taken", "x"), Error);
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path), {}) == 2);
}
