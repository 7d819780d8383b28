// JUnit XML: the shape, and names and messages that would break it. Python's parser reads what the
// program writes: tests/python/test_junit.py.
#include "lib/io/junit.h"

#include "tests/support/catch.h"

namespace pbf::io_test {
namespace {

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("junit: a suite counts its cases, failures and those that were skipped") {
  const std::string xml = junit_xml({"s",
                                     {{"backend", "cpu"}},
                                     {{"g", "good", 0.25},
                                      {"g", "bad", 1.5, "differs", "by 3"},
                                      {"h", "unknown", -1, "", "", true}},
                                     2});
  CHECK(holds(xml, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"));
  CHECK(holds(xml,
              "<testsuite name=\"s\" tests=\"3\" failures=\"1\" errors=\"0\" skipped=\"1\" "
              "time=\"2.000\">"));
  CHECK(holds(xml, "<testcase classname=\"g\" name=\"good\" time=\"0.250\"/>"));
  CHECK(holds(xml, "<failure message=\"differs\" type=\"failure\">by 3</failure>"));
  CHECK(holds(xml, "<testcase classname=\"h\" name=\"unknown\">\n      <skipped/>"));
  CHECK(holds(xml, "<property name=\"backend\" value=\"cpu\"/>"));
}

TEST_CASE("junit: what would end an attribute or is no character of XML is written out") {
  const std::string bad = "a\"b'<c>&d\n\te\x1b]]>\x9b\xEF\xBF\xBF\x01";
  const std::string xml = junit_xml({"s", {}, {{bad, bad, 0, bad, bad}}, 0});
  CHECK(holds(xml, "name=\"a&quot;b'&lt;c&gt;&amp;d&#10;&#9;e\\u001b]]&gt;\\x9b\\uffff\\u0001\""));
  CHECK(holds(xml, ">a&quot;b'&lt;c&gt;&amp;d\n\te\\u001b]]&gt;"));
  for (const char c : std::string("\x1b\x9b\x01")) CHECK(xml.find(c) == std::string::npos);
  CHECK(holds(junit_xml({"", {}, {}, -3}), "tests=\"0\" failures=\"0\" errors=\"0\""));
}

}  // namespace pbf::io_test
