#include "lib/io/junit.h"

#include <fmt/core.h>
#include <algorithm>
#include <map>

#include "lib/base/plain_text.h"

namespace pbf::io_module {
namespace {

/// For attributes and text. Line breaks in an attribute are spaces to a parser unless they are
/// written out.
std::string xml_text(const std::string& text, bool attribute) {
  static const std::map<char, const char*> kNamed{
      {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}};
  const std::string plain = escaped(text);
  std::string out;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    const char c = plain[i];
    // U+FFFE and U+FFFF are no characters of XML.
    if (plain.compare(i, 2, "\xEF\xBF") == 0 && i + 2 < plain.size() &&
        (plain[i + 2] == '\xBE' || plain[i + 2] == '\xBF')) {
      out += plain[i + 2] == '\xBE' ? "\\ufffe" : "\\uffff";
      i += 2;
    } else if (const auto named = kNamed.find(c); named != kNamed.end()) {
      out += named->second;
    } else if (c == '\r' || (attribute && (c == '\n' || c == '\t'))) {
      out += fmt::format("&#{};", int(c));
    } else {
      out += c;
    }
  }
  return out;
}

std::string attribute_text(const char* name, const std::string& value) {
  return fmt::format(" {}=\"{}\"", name, xml_text(value, true));
}

std::string seconds_text(double seconds) { return fmt::format("{:.3f}", std::max(0.0, seconds)); }

std::string xml_of(const JunitCase& c) {
  std::string out = "    <testcase" + attribute_text("classname", c.group) +
                    attribute_text("name", c.name) +
                    (c.seconds < 0 ? "" : attribute_text("time", seconds_text(c.seconds)));
  std::string inside;
  if (c.skipped) inside += "      <skipped/>\n";
  if (!c.failure.empty())
    inside += "      <failure" + attribute_text("message", c.failure) +
              attribute_text("type", "failure") + ">" + xml_text(c.details, false) + "</failure>\n";
  else if (!c.details.empty())
    inside += "      <system-out>" + xml_text(c.details, false) + "</system-out>\n";
  return out + (inside.empty() ? "/>\n" : ">\n" + inside + "    </testcase>\n");
}

}  // namespace

std::string junit_xml(const JunitSuite& s) {
  const auto failures =
      std::ranges::count_if(s.cases, [](const JunitCase& c) { return !c.failure.empty(); });
  std::string out = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<testsuites{0} tests=\"{1}\" failures=\"{2}\" errors=\"0\"{4}>\n"
      "  <testsuite{0} tests=\"{1}\" failures=\"{2}\" errors=\"0\" skipped=\"{3}\"{4}>\n",
      attribute_text("name", s.name), s.cases.size(), failures,
      std::ranges::count(s.cases, true, &JunitCase::skipped),
      attribute_text("time", seconds_text(s.seconds)));
  if (!s.properties.empty()) {
    out += "    <properties>\n";
    for (const auto& [name, value] : s.properties)
      out += "      <property" + attribute_text("name", name) + attribute_text("value", value) +
             "/>\n";
    out += "    </properties>\n";
  }
  for (const JunitCase& c : s.cases) out += xml_of(c);
  return out + "  </testsuite>\n</testsuites>\n";
}

}  // namespace pbf::io_module
