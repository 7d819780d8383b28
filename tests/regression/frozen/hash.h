// A short name for contents: FNV-1a, 64 bits (Fowler, Noll, Vo; RFC draft eastlake-fnv). Not
// against an adversary.
#pragma once

#include <fmt/core.h>
#include <cstdint>
#include <string>
#include <string_view>

namespace pbf::test {

class Hash {
 public:
  /// Adds a text and its end, so that "ab", "c" and "a", "bc" differ.
  void add(std::string_view text) {
    bytes(text);
    value_ = (value_ ^ 256u) * kPrime;
  }
  /// 16 hexadecimal digits.
  std::string text() const { return fmt::format("{:016x}", value_); }

 private:
  static constexpr std::uint64_t kPrime = 1099511628211u;
  void bytes(std::string_view text) {
    for (const char c : text) value_ = (value_ ^ static_cast<unsigned char>(c)) * kPrime;
  }
  std::uint64_t value_ = 14695981039346656037u;
};

}  // namespace pbf::test
