#include "app/shell_quote.h"

#include <fmt/core.h>
#include <algorithm>

namespace pbf::app_module {

std::string shell_quoted(const std::string& text) {
  const std::string safe =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._=/,+:@%-";
  if (!text.empty() && text.find_first_not_of(safe) == std::string::npos) return text;
  const auto control = [](char c) { return static_cast<unsigned char>(c) < 32 || c == 127; };
  const bool escaped = std::any_of(text.begin(), text.end(), control);
  std::string out = escaped ? "$'" : "'";
  for (const char c : text) {
    if (control(c))
      out += fmt::format("\\{:03o}", static_cast<unsigned>(static_cast<unsigned char>(c)));
    else if (escaped && (c == '\'' || c == '\\'))
      out += std::string("\\") + c;
    else if (c == '\'')
      out += "'\\''";
    else
      out += c;
  }
  return out + "'";
}

}  // namespace pbf::app_module
