// The constants of a scene, rounded as a solver of lower precision rounds them.
#include <algorithm>

#include "lib/scene/random.h"
#include "lib/verify/compare_parts.h"

namespace pbf::inline verify_module {
namespace {

struct Constant {
  const Draw* draw;
  double* value;
};

/// The real numbers of a field that are there.
struct Collect {
  const Draw& draw;
  std::vector<Constant>& out;
  void operator()(double* x) const {
    if (*x != draw.off) out.push_back({&draw, x});
  }
  template <std::size_t N>
  void operator()(std::array<double, N>* values) const {
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
  std::vector<Constant> constants;
  for (const Key& key : table.keys) {
    const Block& block = *key.block;
    if (key.effect != Effect::results || key.draw.exact || !block.is_present(object)) continue;
    for (std::size_t i = 0; i < block.size(object); ++i)
      if (const Object holder = block.entry(object, i); key.kinds & block.kind_of(holder))
        std::visit(Collect{key.draw, constants}, key.field(holder));
  }
  std::ranges::stable_sort(constants, {}, [](const Constant& c) { return c.draw->turn; });
  SplitMix64 random(seed);
  for (const Constant& c : constants) *c.value *= 1 + u * (2 * random.uniform() - 1);
}

}  // namespace pbf::inline verify_module
