// Copies to the host what the passes of one update leave behind; rounds it at random or replaces it
// where asked to.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "kernels/axes.h"
#include "kernels/neighbors.h"
#include "kernels/vec3.h"
#include "lib/scene/random.h"
#include "lib/solver/step_trace.h"

namespace pbf::inline PBF_VARIANT {

/// Number of neighbours of each particle.
template <class Lists>
struct ListSizePass {
  Lists lists;
  int* size;  ///< out
  PBF_HD void operator()(int i) const { size[i] = lists.size(i); }
};

/// The lists one behind the other, without what pads them.
template <class Lists>
struct FlatListPass {
  Lists lists;
  int n;
  const int* begin;
  int* out;
  PBF_HD void operator()(int i) const {
    int* to = out + begin[i];
    lists.for_each(i, [&](int j) {
      if (j < n) *to++ = j;
    });
  }
};

/// The arrays of the step, in device-visible memory; row k belongs to particle id[k].
template <class Real>
struct TracedArrays {
  Vec4<Real>*position, *other_position, *velocity, *curl;
  Real* density;
  int *bin, *id, *other_id;  ///< of what lies in the order before the sort: other_id
  bool fused;                ///< the lambda pass has summed the density
};

template <class Real, class Exec>
class Tracer {
 public:
  Tracer(Exec& exec, int n, const Axes& axes, const TraceOptions& options)
      : exec_(exec), n_(std::size_t(n)), axes_(axes), options_(options), random_(options.seed) {}

  /// Records what a stage has left behind.
  template <class Lists>
  void record(const std::string& stage, int sweep, const TracedArrays<Real>& a,
              const Lists& neighbors) {
    this->stage(stage, sweep, most_terms_);
    if (stage == "predict") {
      vectors("position", "h", a.position, a.id);
      vectors("velocity", "h/s", a.velocity, a.id);
    } else if (stage == "grid") {
      scalars("bin", "1", a.bin, a.other_id);
      vectors("position", "h", a.position, a.id);
      vectors("velocity", "h/s", a.velocity, a.id);
    } else if (stage == "neighbors") {
      lists(neighbors, a.id);
    } else if (stage == "density") {
      scalars("density", "rho0", a.density, a.id);
    } else if (stage == "lambda") {
      if (a.fused) {
        this->stage("density", sweep, most_terms_);
        scalars("density", "rho0", a.density, a.id);
        this->stage("lambda", sweep, most_terms_);
      }
      fourth("lambda", "h^2", a.other_position, a.id);
    } else if (stage == "delta") {
      this->stage("delta", sweep);
      vectors("position", "h", a.position, a.id);
      fourth("1/density", "1/rho0", a.position, a.id);
      vectors("velocity", "h/s", a.velocity, a.id);
    } else if (stage == "curl") {
      this->stage("vorticity", 0, most_terms_);
      vectors("curl times its gain", "1/s", a.curl, a.id, axes_.handedness());
    } else {
      this->stage(stage, 0);
      vectors("velocity", "h/s", a.velocity, a.id);
    }
  }

  StepTrace result() { return std::move(trace_); }

 private:
  /// Names the stage of what follows. `terms`: those of the sums that it stores, 0: none.
  void stage(const std::string& name, int sweep, double terms = 0) {
    stage_ = name;
    sweep_ = sweep;
    amplitude_ = options_.unit_roundoff * (terms > 0 ? 4 + std::sqrt(terms) : 1);
  }
  /// Row k belongs to id[k], both in device-visible memory. sign: of the scene's vector, -1 for a
  /// cross product in axes of the other hand.
  void vectors(const char* quantity, const char* unit, Vec4<Real>* from, const int* id,
               int sign = 1) {
    array(
        quantity, unit, 3, from, id, [](Vec4<Real>& x, int c) -> Real& { return (&x.x)[c]; }, sign);
  }
  /// The fourth component.
  void fourth(const char* quantity, const char* unit, Vec4<Real>* from, const int* id) {
    array(quantity, unit, 1, from, id, [](Vec4<Real>& x, int) -> Real& { return x.w; });
  }
  template <class T>
  void scalars(const char* quantity, const char* unit, T* from, const int* id) {
    array(quantity, unit, 1, from, id, [](T& x, int) -> T& { return x; });
  }

  template <class Lists>
  void lists(const Lists& lists, const int* id) {
    typename Exec::template Buffer<int> size, begin, flat;
    size.resize(n_);
    exec_.for_each(int(n_), ListSizePass<Lists>{lists, size.data()});
    std::vector<int> sizes = host(size.data()), starts(n_);
    int sum = 0;
    for (std::size_t k = 0; k < n_; ++k) starts[k] = sum, sum += sizes[k];
    if (n_ > 0) most_terms_ = 1 + *std::max_element(sizes.begin(), sizes.end());
    begin.resize(n_);
    exec_.to_device(starts.data(), n_, begin.data());
    flat.resize(std::size_t(sum) + 1);
    exec_.for_each(int(n_), FlatListPass<Lists>{lists, int(n_), begin.data(), flat.data()});
    std::vector<int> all(std::size_t(sum), 0);
    exec_.to_host(flat.data(), all.size(), all.data());
    id_ = host(id);
    by_id(sizes, starts, all);
  }

  template <class T>
  std::vector<T> host(const T* from) {
    std::vector<T> v(n_);
    exec_.to_host(from, n_, v.data());
    return v;
  }
  /// Records n rows of `components` scalars, component(row, c) of what lies at `from`; rounds them
  /// and puts the values to follow in their place, where asked to.
  template <class T, class Component>
  void array(const char* quantity, const char* unit, int components, T* from, const int* id,
             const Component& component, int sign = 1) {
    std::vector<T> v = host(from);
    id_ = host(id);
    trace_.arrays.push_back({stage_, sweep_, quantity, unit, components, {}});
    TraceArray& to = trace_.arrays.back();
    to.values.resize(n_ * std::size_t(components));
    const TraceArray* follow = followed(to);
    using Scalar = std::remove_reference_t<decltype(component(v[0], 0))>;
    for (std::size_t k = 0; k < n_; ++k)
      for (int c = 0; c < components; ++c) {
        Scalar& x = component(v[k], c);
        const std::size_t row = std::size_t(id_[k]) * std::size_t(components) +
                                std::size_t(components == 3 ? axes_.of[c] : c);
        if constexpr (std::is_integral_v<Scalar>) {
          to.values[row] = double(x);
        } else {
          x = rounded(x);
          to.values[row] = sign * double(x);
          if (follow) x = rounded(Real(sign * follow->values[row]));
        }
      }
    if (!std::is_integral_v<Scalar> && (amplitude_ > 0 || follow))
      exec_.to_device(v.data(), n_, from);
  }
  /// The array of the other trace that belongs to the present one.
  const TraceArray* followed(const TraceArray& mine) {
    const std::size_t at = trace_.arrays.size() - 1;
    if (!options_.follow) return nullptr;
    if (at < options_.follow->arrays.size()) {
      const TraceArray& other = options_.follow->arrays[at];
      if (other.stage == mine.stage && other.sweep == mine.sweep &&
          other.quantity == mine.quantity && other.values.size() == mine.values.size())
        return &other;
    }
    options_.follow = nullptr;
    return nullptr;
  }
  Real rounded(Real x) {
    return amplitude_ > 0 ? Real(double(x) * (1 + amplitude_ * (2 * random_.uniform() - 1))) : x;
  }
  void by_id(const std::vector<int>& sizes, const std::vector<int>& starts,
             const std::vector<int>& all) {
    auto& begin = trace_.neighbor_begin;
    begin.assign(n_ + 1, 0);
    for (std::size_t k = 0; k < n_; ++k) begin[std::size_t(id_[k]) + 1] = sizes[k];
    for (std::size_t k = 0; k < n_; ++k) begin[k + 1] += begin[k];
    trace_.neighbors.resize(all.size());
    for (std::size_t k = 0; k < n_; ++k) {
      auto* to = trace_.neighbors.data() + begin[std::size_t(id_[k])];
      for (int m = 0; m < sizes[k]; ++m) to[m] = id_[std::size_t(all[std::size_t(starts[k] + m)])];
      std::sort(to, to + sizes[k]);
    }
  }

  Exec& exec_;
  std::size_t n_;
  Axes axes_;
  TraceOptions options_;
  SplitMix64 random_;
  std::string stage_;
  int sweep_ = 0;
  double amplitude_ = 0;
  double most_terms_ = 0;  ///< of the longest sum over neighbours, once lists() has seen them
  std::vector<int> id_;
  StepTrace trace_;
};

}  // namespace pbf::inline PBF_VARIANT
