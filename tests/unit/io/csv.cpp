// CSV files as a whole: what lib/io/csv.h takes and refuses.
#include "lib/io/csv.h"

#include "lib/base/error.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

using namespace pbf;

namespace {

std::string error_of(const std::string& text) {
  const scene_test::Folder folder;
  try {
    read_csv(folder.write("t.csv", text), "; remove it");
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("a small CSV table is read with its places, without comments, blanks and line ends") {
  const scene_test::Folder folder;
  const auto rows =
      read_csv(folder.write("t.csv", "# from a book\r\n\r\nT, Z \r\n 1 ,2\n\n# more\n3,\n4,5"));
  REQUIRE(rows.size() == 4);
  CHECK(rows[0].cells == std::vector<std::string>{"T", "Z"});
  CHECK(rows[1].cells == std::vector<std::string>{"1", "2"});
  CHECK(rows[2].cells == std::vector<std::string>{"3", ""});
  CHECK(rows[3].cells == std::vector<std::string>{"4", "5"});
  CHECK(holds(rows[3].where, "t.csv:8"));
  CHECK(read_csv(folder.write("empty.csv", "")).empty());
  CHECK(rows[3].line == 8);
  // The byte order mark of a spreadsheet is no part of the header.
  CHECK(read_csv(folder.write("m.csv", "\xEF\xBB\xBFT,Z\n1,2\n"))[0].cells ==
        std::vector<std::string>{"T", "Z"});
}

TEST_CASE("the pass that reads a CSV table gives the SHA-256 of all its bytes") {
  const scene_test::Folder folder;
  // Comments, blank lines and line ends are no rows, but bytes. Digests of sha256sum.
  std::string digest = "old";
  CHECK(read_csv(folder.write("t.csv", "# from a book\r\n\r\nT, Z \r\n 1 ,2\n"), "", &digest)
            .size() == 2);
  CHECK(digest == "29e0ed7f7026bb98927a1d4f3a3cf280ed537f0a56ca3ca5a8adb24a85d78eec");
  CHECK(read_csv(folder.write("empty.csv", ""), "", &digest).empty());
  CHECK(digest == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  // More than one block of the reader.
  std::string rows = "a,b\n";
  for (int i = 0; i < 30000; ++i) rows += "1,2\n";
  CHECK(read_csv(folder.write("long.csv", rows), "", &digest).size() == 30001);
  CHECK(digest == "768c0e0e3002723f70a928d74f06bff27f0947aa5a60c7442ffcc75f292f9f7f");
}

TEST_CASE("what is no CSV table is refused with its line and the remedy") {
  CHECK(holds(error_of("a,b\n1,2\n1\n"), "t.csv:3: has 1 values, the header names 2; remove it"));
  CHECK(holds(error_of("a,b\n1,2,3\n"), "t.csv:2: has 3 values, the header names 2; remove it"));
  CHECK(holds(error_of("a,\x01\n"), "t.csv:1: "));
  CHECK(holds(error_of("a,\xff\n"), "t.csv:1: "));
  CHECK(holds(error_of("a\n" + std::string(100000, '1')), "t.csv:2: the line is longer than"));
  CHECK(error_of("a,b\n1,2\n").empty());
  const scene_test::Folder folder;
  CHECK_THROWS_AS(read_csv(folder.path.string()), Error);  // a folder
  CHECK_THROWS_AS(read_csv((folder.path / "no.csv").string()), Error);
}
