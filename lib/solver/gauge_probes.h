// The gauges whose sums are made at a reading, by a pass over the particles.
#pragma once

#include <type_traits>
#include <vector>

#include "lib/program/gauges.h"

namespace pbf::inline PBF_VARIANT {

/// The arrays of a kind, in the memory of the particles.
template <class Exec, class Kind>
struct KindProbes {
  typename Exec::template Buffer<decltype(Kind::site)> site;
  typename Exec::template Buffer<typename Kind::Sums> sums;
};

template <class Exec, class Any = gauge_kinds::Any>
class GaugeProbes;

template <class Exec, class... Kind>
class GaugeProbes<Exec, std::variant<Kind...>> : KindProbes<Exec, Kind>... {
 public:
  void make(Exec& exec, const GaugePlan& plan) {
    for_each([&]<class K>(KindProbes<Exec, K>& k) {
      const auto sites = plan.sites<decltype(K::site)>();
      k.site.resize(sites.size());
      exec.to_device(sites.data(), sites.size(), k.site.data());
      k.sums.resize(std::size_t(plan.sums<typename K::Sums>()));
    });
  }
  /// Puts their numbers to their places among `readings`. update_dt: s
  template <class C>
  void read(C& c, const GaugePlan& plan, double update_dt, std::vector<double>& readings) {
    for_each([&]<class K>(KindProbes<Exec, K>& k) {
      std::vector<typename K::Sums> sums(k.sums.size());
      if (sums.empty()) return;
      c.exec.to_device(sums.data(), sums.size(), k.sums.data());
      c.items(gauge_pass(k.site.data(), int(k.site.size()), c.position(), c.velocity(), update_dt,
                         k.sums.data()));
      c.exec.to_host(k.sums.data(), sums.size(), sums.data());
      plan.finish(sums, readings);
    });
  }

 private:
  /// Calls f for the first kind with each type of sums: those of others with it are read with it.
  template <class F>
  void for_each(const F& f) {
    (one<Kind>(f), ...);
  }
  template <class K, class F>
  void one(const F& f) {
    using Sums = typename K::Sums;
    constexpr bool same[] = {std::is_same_v<typename Kind::Sums, Sums>...};
    constexpr bool self[] = {std::is_same_v<Kind, K>...};
    constexpr bool first = [&] {
      int k = 0;
      while (!same[k]) ++k;
      return self[k];
    }();
    if constexpr (is_probe<Sums> && first) f(static_cast<KindProbes<Exec, K>&>(*this));
  }
};

}  // namespace pbf::inline PBF_VARIANT
