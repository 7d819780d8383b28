// Backends and precisions. These tables are the only lists of them: keys, options, messages, the
// plan and comparisons read them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pbf::scene_module {

enum class Precision { single, dbl };
enum class Backend { cpu, cuda };

struct PrecisionInfo {
  const char* word;  ///< in scenes, tables and messages
  int bytes;         ///< of a number
  double roundoff;   ///< largest relative error of one operation
};
struct BackendInfo {
  const char* word;
  bool on_device;  ///< arrays are in device memory; otherwise on the host, with `threads`
  bool exact;      ///< always has the bits that every backend has with solver.reproducible
  int padding;     ///< rows after the last particle: one that pads lists, and what is read at once
  bool order_in_place;  ///< a sort stores its order where its gather then writes the ids
};
/// In the order of the enums.
inline constexpr PrecisionInfo kPrecisions[] = {{"float", 4, 0x1p-24}, {"double", 8, 0x1p-53}};
inline constexpr BackendInfo kBackends[] = {{"cpu", false, true, 16, true},
                                            {"cuda", true, false, 4, false}};

constexpr const PrecisionInfo& about(Precision p) { return kPrecisions[static_cast<int>(p)]; }
constexpr const BackendInfo& about(Backend b) { return kBackends[static_cast<int>(b)]; }
/// The precision of a C++ type.
template <class Real>
constexpr Precision precision_of = sizeof(Real) == 8 ? Precision::dbl : Precision::single;
constexpr const auto& table_of(Precision) { return kPrecisions; }
constexpr const auto& table_of(Backend) { return kBackends; }

/// The word of a Precision or a Backend.
template <class E>
constexpr const char* word(E e) {
  return about(e).word;
}
/// {"cpu", "cuda"}
template <class E>
std::vector<std::string> words_of() {
  std::vector<std::string> out;
  for (const auto& row : table_of(E{})) out.push_back(row.word);
  return out;
}
/// All values of the enum.
template <class E>
std::vector<E> all_of() {
  std::vector<E> out;
  for (std::size_t k = 0; k < std::size(table_of(E{})); ++k) out.push_back(static_cast<E>(k));
  return out;
}
/// The value with this word.
template <class E>
std::optional<E> named(const std::string& text) {
  for (const E e : all_of<E>())
    if (text == word(e)) return e;
  return std::nullopt;
}

}  // namespace pbf::scene_module
