// Results of checks as JUnit XML, which CI systems read.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace pbf::io_module {

struct JunitCase {
  std::string group, name;
  double seconds = -1;    ///< below 0: nobody took the time
  std::string failure{};  ///< in a sentence; empty: it passed
  std::string details{};  ///< what else is to be known of it
  bool skipped = false;   ///< nothing was judged
};

struct JunitSuite {
  std::string name;
  std::vector<std::pair<std::string, std::string>> properties{};
  std::vector<JunitCase> cases{};
  double seconds = 0;
};

/// One testsuite; XML 1.0 in UTF-8. What XML cannot hold (control characters, bytes that are not
/// UTF-8) is written out, \u001b. Pure.
std::string junit_xml(const JunitSuite& suite);

}  // namespace pbf::io_module
