#include "lib/io/report.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "lib/base/error.h"
#include "tests/catch.h"
#include "tests/unit/run_file_samples.h"

using namespace pbf;

namespace {

std::string read(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

}  // namespace

TEST_CASE("a CSV table quotes what needs it and leaves missing values empty", "[report]") {
  CsvTable table({"name", "a,b", "n", "x", "ok"});
  table.add({std::string("say \"hi\""), std::string("one\ntwo"), std::int64_t{-7}, 0.1, true});
  table.add({std::string("plain"), {}, {}, std::nan(""), false});
  CHECK(table.text() ==
        "name,\"a,b\",n,x,ok\n"
        "\"say \"\"hi\"\"\",\"one\ntwo\",-7,0.1,true\n"
        "plain,,,nan,false\n");
  CHECK(table.rows() == 2);
}

TEST_CASE("numbers read back as the same bits", "[report]") {
  for (const double v : {0.1, 1.0 / 3, 1e-300, -1.7976931348623157e308, 5e-324, 123456789.125}) {
    CHECK(std::strtod(json(Cell(v)).c_str(), nullptr) == v);
    CsvTable table({"v"});
    table.add({v});
    CHECK(std::strtod(table.text().c_str() + 2, nullptr) == v);
  }
  CHECK(json(Cell(std::numeric_limits<std::int64_t>::min())) == "-9223372036854775808");
}

TEST_CASE("JSON keeps the order, escapes text and has null for what it lacks", "[report]") {
  JsonObject o;
  o.add("z", 1.5).add("a", std::string("q\"\\\n\t\x01")).add("none", {});
  o.add("inf", std::numeric_limits<double>::infinity());
  o.add_json("list", json_array({json(Cell(true)), json(Cell(std::int64_t{3}))}));
  CHECK(o.text() ==
        "{\"z\": 1.5, \"a\": \"q\\\"\\\\\\n\\t\\u0001\", \"none\": null, \"inf\": null, "
        "\"list\": [true,\n 3]}");
}

TEST_CASE("a table as JSON is one object per row", "[report]") {
  CsvTable table({"n", "s"});
  table.add({std::int64_t{1}, std::string("x")});
  table.add({std::int64_t{2}, {}});
  CHECK(table.json() == "[{\"n\": 1, \"s\": \"x\"},\n {\"n\": 2, \"s\": null}]");
  CHECK(CsvTable({"n"}).json() == "[]");
}

TEST_CASE("a row of the wrong length is a defect", "[report]") {
  CsvTable table({"a", "b"});
  CHECK_THROWS_AS(table.add({std::int64_t{1}}), Error);
}

TEST_CASE("a text file appears whole or not at all", "[report]") {
  const test::TemporaryFolder folder;
  const std::string path = folder / "table.csv";
  write_text_file(path, "old\n");
  write_text_file(path, "new\n");
  CHECK(read(path) == "new\n");
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
