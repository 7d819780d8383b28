// Copies the results of the passes of one update to the host. Options round these results at random
// or replace them.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "kernels/axes.h"
#include "lib/program/pass.h"
#include "lib/scene/random.h"
#include "lib/solver/step_context.h"
#include "lib/solver/step_trace.h"

namespace pbf::PBF_VARIANT {

/// Number of neighbors of each particle.
template <class Lists>
struct ListSizePass {
  Lists lists;
  int* size;  ///< out
  PBF_HD void operator()(int i) const { size[i] = lists.size(i); }
};

/// The concatenated lists without padding.
template <class Lists>
struct FlatListPass {
  Lists lists;
  int n;
  const int* begin;
  int* out;
  PBF_HD void operator()(int i) const {
    int* to = out + begin[i];
    lists.for_each(i, [&](Neighbor j) {
      if (j.row < n) *to++ = j.row;
    });
  }
};

/// Context: a StepContext.
template <class Context>
class Tracer {
 public:
  Tracer(Context& c, const Axes& axes, const TraceOptions& options)
      : c_(c),
        n_(changes_rows(c.scene) ? 0 : std::size_t(c.host_particles(nullptr))),
        axes_(axes),
        options_(options),
        random_(options.seed) {
    if (changes_rows(c.scene))
      throw Error(ExitCode::bad_input,
                  "an update can be traced only where the number of particles is constant");
  }

  /// Records the results of a pass.
  void record(const PassInfo& pass, int number) {
    for (const Written& w : pass.written) {
      stage_ = w.stage ? w.stage : pass.stage;
      iteration_ = number;
      amplitude_ = options_.unit_roundoff * (w.sum ? 4 + std::sqrt(most_terms_) : 1);
      const FieldInfo& f = *w.field;
      grain_ = f.shown.grain;
      const auto vectors = [&] { return c_.template data<Vec4<Real>>(f); };
      const auto component = [](Vec4<Real>& x, int k) -> Real& { return (&x.x)[k]; };
      const auto fourth = [](Vec4<Real>& x, int) -> Real& { return x.w; };
      switch (w.part) {
        case Written::vector:
          array(w, 3, vectors(), component, f.shown.axial ? axes_.handedness() : 1);
          break;
        case Written::fourth:
          array(w, 1, vectors(), fourth);
          break;
        case Written::scalar:
          if (f.type == Type::int32)
            array(w, 1, c_.template data<int>(f), [](int& x, int) -> int& { return x; });
          else
            array(w, 1, c_.template data<Real>(f), [](Real& x, int) -> Real& { return x; });
          break;
        case Written::pairs:
          lists();
          break;
      }
    }
  }

  StepTrace result() { return std::move(trace_); }

 private:
  using Real = typename Context::Real;

  void lists() {
    using Lists = typename Context::Lists;
    const Lists& lists = c_.lists;
    auto& exec = c_.exec;
    typename Context::template Buffer<int> size, begin, flat;
    const auto rows = std::size_t(c_.host_rows());
    size.resize(rows);
    exec.items(c_.rows(), ListSizePass<Lists>{lists, size.data()});
    std::vector<int> sizes = host(size.data(), rows), starts(rows);
    id_ = host(c_.ids(), rows);
    int sum = 0;
    for (std::size_t k = 0; k < rows; ++k) {
      if (!is_particle(k)) sizes[k] = 0;
      starts[k] = sum, sum += sizes[k];
    }
    if (n_ > 0) most_terms_ = 1 + *std::max_element(sizes.begin(), sizes.end());
    begin.resize(rows);
    exec.to_device(starts.data(), rows, begin.data());
    flat.resize(std::size_t(sum) + 1);
    exec.items(c_.rows(), FlatListPass<Lists>{lists, int(rows), begin.data(), flat.data()});
    std::vector<int> all(std::size_t(sum), 0);
    exec.to_host(flat.data(), all.size(), all.data());
    by_id(sizes, starts, all);
  }

  /// Whether row k is that of a particle, not of an image (kernels/pass_images.h).
  bool is_particle(std::size_t k) const { return id_[k] >= 0 && !is_image(id_[k]); }
  template <class T>
  std::vector<T> host(const T* from, std::size_t n) {
    std::vector<T> v(n);
    c_.exec.to_host(from, n, v.data());
    return v;
  }
  /// Records n rows of `components` scalars, component(from[row], c), and rounds or replaces them
  /// as the options say. sign: factor for the scene's axes.
  template <class T, class Component>
  void array(const Written& w, int components, T* from, const Component& component, int sign = 1) {
    const Shown& shown = w.field->shown;
    const auto rows = std::size_t(shown.before_sort ? c_.rows_of_sort() : c_.host_rows());
    const std::vector<int> named =
        shown.row ? host(c_.template data<int>(*shown.row), rows) : std::vector<int>{};
    std::vector<T> all =
        shown.row ? host(from, std::size_t(c_.rows_of(*w.field))) : std::vector<T>{};
    std::vector<T> v = shown.row ? std::vector<T>(rows) : host(from, rows);
    for (std::size_t k = 0; k < named.size(); ++k)
      if (named[k] >= 0) v[k] = all[std::size_t(named[k])];
    id_ = host(shown.before_sort ? c_.template data<int>(other<field::id>) : c_.ids(), rows);
    trace_.arrays.push_back(
        {stage_, iteration_, w.quantity, w.unit, components, {}, w.stage != nullptr});
    TraceArray& to = trace_.arrays.back();
    to.values.resize(n_ * std::size_t(components));
    const TraceArray* follow = followed(to);
    using Scalar = std::remove_reference_t<decltype(component(v[0], 0))>;
    for (std::size_t k = 0; k < rows; ++k)
      for (int c = 0; is_particle(k) && c < components; ++c) {
        Scalar& x = component(v[k], c);
        const std::size_t row = std::size_t(id_[k]) * std::size_t(components) +
                                std::size_t(components == 3 ? axes_.of[c] : c);
        if constexpr (std::is_integral_v<Scalar>) {
          to.values[row] = double(x);
        } else {
          x = rounded(x);
          to.values[row] = sign * double(x);
          if (follow) x = rounded(Real(sign * followed_value(*follow, row, w, c, double(x))));
        }
      }
    if constexpr (!std::is_integral_v<Scalar>) {
      if (amplitude_ == 0 && !follow) return;
      for (std::size_t k = 0; k < named.size(); ++k)
        if (named[k] >= 0) all[std::size_t(named[k])] = v[k];
      if (shown.row)
        c_.exec.to_device(all.data(), all.size(), from);
      else
        c_.exec.to_device(v.data(), rows, from);
    }
  }
  /// The array of the other trace that corresponds to `mine`, or null.
  const TraceArray* followed(const TraceArray& mine) {
    const std::size_t at = trace_.arrays.size() - 1;
    if (!options_.follow) return nullptr;
    if (at < options_.follow->arrays.size()) {
      const TraceArray& other = options_.follow->arrays[at];
      if (other.stage == mine.stage && other.iteration == mine.iteration &&
          other.quantity == mine.quantity && other.values.size() == mine.values.size())
        return &other;
    }
    options_.follow = nullptr;
    return nullptr;
  }
  /// The value of the other trace. Places near a periodic face may be at the opposite one there:
  /// images belong to this side's.
  double followed_value(const TraceArray& follow, std::size_t row, const Written& w, int axis,
                        double mine) const {
    const double other = follow.values[row], period = double((&c_.p.period.x)[axis]);
    const bool place = w.part == Written::vector && &w.field->primary() == &field::position;
    if (!place || !(period > 0)) return other;
    return other - mine > period / 2   ? other - period
           : mine - other > period / 2 ? other + period
                                       : other;
  }
  Real rounded(Real x) {
    if (amplitude_ == 0) return x;
    const double r = 2 * random_.uniform() - 1;
    return Real(double(x) * (1 + amplitude_ * r) + (x != Real(0) ? grain_ * r : 0));
  }
  void by_id(const std::vector<int>& sizes, const std::vector<int>& starts,
             const std::vector<int>& all) {
    auto& begin = trace_.neighbor_begin;
    begin.assign(n_ + 1, 0);
    for (std::size_t k = 0; k < id_.size(); ++k)
      if (is_particle(k)) begin[std::size_t(id_[k]) + 1] = sizes[k];
    for (std::size_t k = 0; k < n_; ++k) begin[k + 1] += begin[k];
    trace_.neighbors.resize(all.size());
    for (std::size_t k = 0; k < id_.size(); ++k) {
      if (!is_particle(k)) continue;
      auto* to = trace_.neighbors.data() + begin[std::size_t(id_[k])];
      for (int m = 0; m < sizes[k]; ++m)
        to[m] = particle_of(id_[std::size_t(all[std::size_t(starts[k] + m)])]);
      std::sort(to, to + sizes[k]);
    }
  }

  Context& c_;
  std::size_t n_;
  Axes axes_;
  TraceOptions options_;
  SplitMix64 random_;
  std::string stage_;
  int iteration_ = 0;
  double amplitude_ = 0, grain_ = 0;
  double most_terms_ = 0;  ///< of the longest sum over neighbors; set by lists()
  std::vector<int> id_;
  StepTrace trace_;
};

}  // namespace pbf::PBF_VARIANT
