// Rounds the constants of a scene at random, as a solver of lower precision would round them.
#include "lib/scene/random.h"
#include "lib/verify/compare_parts.h"

namespace pbf::verify_module {
namespace {

/// Every key has its own random numbers, so that a new key does not change those of others.
SplitMix64 random_of(const Key& key, std::uint64_t seed) {
  for (const char c : key.path) seed = SplitMix64(seed + static_cast<unsigned char>(c)).next();
  return SplitMix64(seed);
}

/// Rounds the real numbers of a field, if present.
struct Round {
  double off;
  double u;
  SplitMix64& random;
  void operator()(double* x) const {
    if (*x != off) *x *= 1 + u * (2 * random.uniform() - 1);
  }
  template <std::size_t N>
  void operator()(std::array<double, N>* values) const {
    for (double& x : *values) (*this)(&x);
  }
  void operator()(std::vector<double>* values) const {
    for (double& x : *values) (*this)(&x);
  }
  template <class T>
  void operator()(std::optional<T>* value) const {
    if (*value) (*this)(&**value);
  }
  void operator()(const auto&) const {}
};

}  // namespace

void round_at_random(const KeyTable& table, const Object& object, double u, std::uint64_t seed) {
  for (const Key& key : table.keys) {
    const Block& block = *key.block;
    if (key.effect != Effect::results || key.exact || !block.is_present(object)) continue;
    SplitMix64 random = random_of(key, seed);
    for (std::size_t i = 0; i < block.size(object); ++i)
      if (const Object holder = block.entry(object, i); key.kinds & block.kind_of(holder))
        std::visit(Round{key.off, u, random}, key.field(holder));
  }
}

}  // namespace pbf::verify_module
