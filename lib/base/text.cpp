#include "lib/base/text.h"

#include <fmt/core.h>
#include <cmath>
#include <ctime>

#include "lib/base/plain_text.h"

namespace pbf::base_module {

std::string joined(const std::vector<std::string>& parts, const std::string& separator) {
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i) text += (i > 0 ? separator : "") + parts[i];
  return text;
}

std::string si_number(double value) {
  const char* prefix[] = {"", " k", " M", " G", " T"};
  int i = 0;
  while (std::abs(value) >= 999.5 && i < 4) value /= 1000, ++i;
  return fmt::format("{:.3g}{}", value, prefix[i]);
}

std::string bytes_text(double bytes) {
  const char* unit[] = {"B", "KiB", "MiB", "GiB", "TiB"};
  int i = 0;
  while (bytes >= 1023.5 && i < 4) bytes /= 1024, ++i;
  return fmt::format("{:.{}f} {}", bytes, i == 0 || bytes >= 99.95 ? 0 : 1, unit[i]);
}

std::string duration_text(double s) {
  if (!std::isfinite(s)) return "unknown";
  if (s < 9.95) return fmt::format("{:.1f} s", s);
  const long long whole = std::llround(s);
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

bool is_file_name(std::string_view text) {
  if (text.empty() || text == "." || text == ".." || text.size() > 200) return false;
  return text.find_first_of("/\t\n\r") == text.npos && !find_bad_text(text);
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

std::optional<double> utc_seconds(const std::string& text) {
  std::tm parts{};
  const char* end = ::strptime(text.c_str(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  if (end == nullptr || *end != '\0') return {};
  return static_cast<double>(::timegm(&parts));
}

}  // namespace pbf::base_module
