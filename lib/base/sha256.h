// SHA-256 (FIPS 180-4), what sha256sum prints.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace pbf::base_module {

class Sha256 {
 public:
  void add(std::string_view bytes);
  /// The hash of all bytes added so far, as 64 hexadecimal digits.
  std::string text() const;

 private:
  void block(const unsigned char* bytes);
  std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                      0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<unsigned char, 64> rest_{};  ///< the first `size_ % 64` begin the next block
  std::uint64_t size_ = 0;                ///< bytes
};

/// The hash of one text.
std::string sha256(std::string_view bytes);

}  // namespace pbf::base_module
