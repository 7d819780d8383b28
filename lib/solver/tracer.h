// Copies to the host what the passes of one update leave behind, and rounds it at random where
// asked to.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

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

template <class Real, class Exec>
class Tracer {
 public:
  Tracer(Exec& exec, int n, const Roundings& roundings)
      : exec_(exec), n_(std::size_t(n)), roundings_(roundings), random_(roundings.seed) {}

  /// Names the stage of what follows. `terms`: those of the sums that it stores.
  void stage(const std::string& name, int sweep, double terms = 1) {
    stage_ = name;
    sweep_ = sweep;
    amplitude_ = roundings_.unit_roundoff * std::sqrt(terms);
  }
  double mean_terms() const { return mean_terms_; }

  /// Row k belongs to id[k], both in device-visible memory.
  void vectors(const char* quantity, const char* unit, Vec4<Real>* from, const int* id) {
    std::vector<Vec4<Real>> v = host(from);
    for (Vec4<Real>& x : v) x = {rounded(x.x), rounded(x.y), rounded(x.z), rounded(x.w)};
    give_back(v, from);
    double* to = add(quantity, unit, 3, id);
    for (std::size_t k = 0; k < n_; ++k) {
      const std::size_t row = 3 * std::size_t(id_[k]);
      to[row] = double(v[k].x), to[row + 1] = double(v[k].y), to[row + 2] = double(v[k].z);
    }
  }
  /// The fourth component.
  void fourth(const char* quantity, const char* unit, Vec4<Real>* from, const int* id) {
    std::vector<Vec4<Real>> v = host(from);
    for (Vec4<Real>& x : v) x.w = rounded(x.w);
    give_back(v, from);
    double* to = add(quantity, unit, 1, id);
    for (std::size_t k = 0; k < n_; ++k) to[id_[k]] = double(v[k].w);
  }
  template <class T>
  void scalars(const char* quantity, const char* unit, T* from, const int* id) {
    std::vector<T> v = host(from);
    if constexpr (!std::is_integral_v<T>) {
      for (T& x : v) x = rounded(x);
      give_back(v, from);
    }
    double* to = add(quantity, unit, 1, id);
    for (std::size_t k = 0; k < n_; ++k) to[id_[k]] = double(v[k]);
  }

  template <class Lists>
  void lists(const Lists& lists, const int* id) {
    typename Exec::template Buffer<int> size, begin, flat;
    size.resize(n_);
    exec_.for_each(int(n_), ListSizePass<Lists>{lists, size.data()});
    std::vector<int> sizes = host(size.data()), starts(n_);
    int sum = 0;
    for (std::size_t k = 0; k < n_; ++k) starts[k] = sum, sum += sizes[k];
    mean_terms_ = 1 + double(sum) / double(std::max<std::size_t>(n_, 1));
    begin.resize(n_);
    exec_.to_device(starts.data(), n_, begin.data());
    flat.resize(std::size_t(sum) + 1);
    exec_.for_each(int(n_), FlatListPass<Lists>{lists, int(n_), begin.data(), flat.data()});
    std::vector<int> all(std::size_t(sum), 0);
    exec_.to_host(flat.data(), all.size(), all.data());
    id_ = host(id);
    by_id(sizes, starts, all);
  }

  StepTrace result() { return std::move(trace_); }

 private:
  template <class T>
  std::vector<T> host(const T* from) {
    std::vector<T> v(n_);
    exec_.to_host(from, n_, v.data());
    return v;
  }
  template <class T>
  void give_back(const std::vector<T>& v, T* to) {
    if (amplitude_ > 0) exec_.to_device(v.data(), n_, to);
  }
  Real rounded(Real x) {
    return amplitude_ > 0 ? Real(double(x) * (1 + amplitude_ * (2 * random_.uniform() - 1))) : x;
  }
  double* add(const char* quantity, const char* unit, int components, const int* id) {
    id_ = host(id);
    trace_.arrays.push_back({stage_, sweep_, quantity, unit, components, {}});
    auto& values = trace_.arrays.back().values;
    values.resize(n_ * std::size_t(components));
    return values.data();
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
  Roundings roundings_;
  SplitMix64 random_;
  std::string stage_;
  int sweep_ = 0;
  double amplitude_ = 0, mean_terms_ = 1;
  std::vector<int> id_;
  StepTrace trace_;
};

}  // namespace pbf::inline PBF_VARIANT
