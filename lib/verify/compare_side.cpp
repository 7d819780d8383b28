#include <algorithm>

#include "lib/base/error.h"
#include "lib/scene/number.h"
#include "lib/verify/compare.h"

namespace pbf::verify_module {

std::string CompareSide::name() const {
  std::string s = std::string(word(backend)) + (variant ? "+defect:" : ":") + word(precision);
  return threads > 0 ? s + "@" + std::to_string(threads) : s;
}

CompareSide parse_side(const std::string& text) {
  const auto fail = [&](const std::string& what) {
    throw Error(ExitCode::bad_input, "--between: \"" + text + "\": " + what +
                                         "; a side is BACKEND:PRECISION or "
                                         "BACKEND:PRECISION@THREADS, e.g. cpu:double, cuda:float, "
                                         "cpu:float@2");
  };
  CompareSide side;
  const auto colon = text.find(':'), at = text.find('@');
  if (colon == std::string::npos || (at != std::string::npos && at < colon)) fail("no precision");
  std::string backend = text.substr(0, colon);
  if (backend == "cpu+defect") {
    side.variant = true;
#ifndef PBF_HAS_DEFECT
    fail("this build has no second CPU solver (configure with -DPBF_DEFECT=NAME)");
#endif
    backend = "cpu";
  }
  const std::optional<Backend> found = named<Backend>(backend);
  if (!found) fail("no backend \"" + backend + "\"");
  side.backend = *found;
  const std::string precision =
      text.substr(colon + 1, at == std::string::npos ? at : at - colon - 1);
  const std::optional<Precision> numbers = named<Precision>(precision);
  if (!numbers) fail("no precision \"" + precision + "\"");
  side.precision = *numbers;
  if (at != std::string::npos) {
    std::int64_t n = 0;
    if (read_number(text.substr(at + 1), n) != NumberError::none || n < 1 || n > 4096)
      fail("the number of threads is not a whole number from 1 to 4096");
    if (about(side.backend).on_device) fail("threads are the CPU's alone");
    side.threads = int(n);
  }
  return side;
}

const char* verdict_name(Verdict v) {
  return v == Verdict::same ? "same" : v == Verdict::differs ? "DIFFERS" : "not judged";
}

bool CompareResult::same() const {
  return std::none_of(parts.begin(), parts.end(),
                      [](const ComparePart& p) { return p.verdict == Verdict::differs; });
}

}  // namespace pbf::verify_module
