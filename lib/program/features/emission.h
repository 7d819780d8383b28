// Emitters and sinks: particles that come and go.
#pragma once

#include <string>
#include <vector>

#include "kernels/pass_emit.h"
#include "lib/program/emission.h"
#include "lib/program/features/motion.h"

namespace pbf::program_module {
inline std::int64_t per_nozzle(const Sizes& n) { return std::int64_t(n.scene.emitters.size()); }
inline std::int64_t per_nozzle_step(const Sizes& n) {
  return std::int64_t(n.scene.emitters.size()) * emission_rows(n.plan);
}
inline std::int64_t per_column(const Sizes& n) {
  std::int64_t sum = 0;
  for (const PlannedNozzle& nozzle : n.plan.emission.nozzles) sum += nozzle.columns;
  return sum;
}
inline std::int64_t per_sink(const Sizes& n) { return std::int64_t(n.scene.sinks.size()); }
inline std::int64_t per_nozzle_and_sink(const Sizes& n) { return per_nozzle(n) + per_sink(n); }
}  // namespace pbf::program_module

namespace pbf::program_module::field {
/// See kernels/emission.h.
inline constexpr struct Nozzles : Objects {
} nozzles{{kBytesOf<Nozzle>, "nozzles", per_nozzle, Life::run}};
inline constexpr struct NozzleSteps : Objects {
} nozzle_steps{{kBytesOf<NozzleStep>, "nozzle steps", per_nozzle_step, Life::run}};
inline constexpr struct NozzleColumns : Vectors {
} nozzle_columns{{"nozzle columns", per_column, Life::run}};
inline constexpr struct EmissionRows : Plain<EmissionRow> {
} emission_row{{"emission row", one_row, Life::run}};
inline constexpr struct SinkBoxes : Objects {
} sink_boxes{{kBytesOf<SinkBox>, "sinks", per_sink, Life::run}};
/// Of emitters, then of sinks.
inline constexpr struct EmissionSums : Plain<EmissionSum> {
} emission_sums{{"emission", per_nozzle_and_sink, Life::state}};
/// Rows in and near pipes.
inline constexpr struct PipeRow : Plain<int> {
} pipe_row{{"pipe rows", per_particle, Life::lists}};
inline constexpr struct PipeCount : Plain<int> {
} pipe_count{{"pipe count", one_row, Life::lists}};
}  // namespace pbf::program_module::field

namespace pbf::PBF_VARIANT {

template <class Real>
Nozzle<Real> row_of(const field::Nozzles&);
template <class Real>
NozzleStep<Real> row_of(const field::NozzleSteps&);
template <class Real>
SinkBox<Real> row_of(const field::SinkBoxes&);

using PipeNeeds = Needs<Looks<field::nozzles>, Looks<field::nozzle_steps>,
                        Looks<field::nozzle_columns>, Looks<field::emission_row>>;
/// Of a pass that lists new rows as near solids: casings are some. Other rows in and near pipes are
/// listed already.
using MarkNeeds =
    Needs<Places<field::near_way_left>, Places<field::near_row>, Places<field::near_count>>;

/// From SI units and the scene's axes to the internal frame.
struct InFrame {
  const Scene& s;
  const Plan& plan;

  template <class Real>
  static Vec3<Real> rounded(const Vec3<double>& v) {
    return {Real(v.x), Real(v.y), Real(v.z)};
  }
  template <class Real>
  Vec3<Real> place(const Double3& x) const {
    return rounded<Real>(internal_place(s, plan.axes, x));
  }
  template <class Real>
  Vec3<Real> along(const Double3& v) const {
    return rounded<Real>(along_internal(plan.axes, v));
  }
  template <class Real>
  Nozzle<Real> nozzle(const PlannedNozzle& of, int first_column) const {
    const NozzlePlace& at = of.place;
    const bool flat = s.dimensions == 2;
    Nozzle<Real> n;
    n.center = place<Real>(at.center);
    n.normal = along<Real>(at.normal);
    for (int k = 0; k < 2; ++k) {
      n.side[k] = along<Real>(at.side[k]);
      n.half[k] = k == 1 && flat ? Real(1e9) : Real(at.half[k] / s.h());
    }
    n.depth = Real(at.depth / s.h());
    n.spacing = Real(s.fluid.spacing / s.h());
    n.disc = at.disc;
    n.columns = int(of.columns);
    n.first_column = first_column;
    return n;
  }
  template <class Real>
  SinkBox<Real> sink(const Sink& k) const {
    Double3 low = k.min, high = k.max;
    if (s.dimensions == 2) low[1] = s.domain.min[1] - 1, high[1] = s.domain.max[1] + 1;
    return {place<Real>(low), place<Real>(high)};
  }
};

/// mark: whether the pass declares MarkNeeds.
template <bool mark, class G>
Pipes<typename G::Real> pipes_of(const G& c, EmissionSum* sums) {
  Pipes<typename G::Real> pipes;
  pipes.nozzle = c.declared(field::nozzles);
  pipes.steps = c.declared(field::nozzle_steps);
  pipes.row = c.declared(field::emission_row);
  pipes.column = c.declared(field::nozzle_columns);
  pipes.nozzles = int(c.scene.emitters.size());
  pipes.gravity = c.p.gravity;
  pipes.book = {sums, 1 / std::sqrt(c.plan.dissipation_unit)};
  if constexpr (mark) {
    pipes.near.way_left_squared = c.declared(field::near_way_left);
    pipes.near.row = c.declared(field::near_row);
    pipes.near.count = c.declared(field::near_count);
  }
  return pipes;
}

struct NextEmission {
  static constexpr PassText text{"next emission", "predict"};
  using Needs = pbf::Needs<Looks<field::emission_row>, Places<field::emission_row>>;
  static void launch(const auto& c) { c.items(1, NextEmissionPass{c[field::emission_row]}); }
};

struct SinkRows {
  static constexpr PassText text{"sinks", "predict"};
  using Needs = pbf::Needs<Reads<field::position>, Reads<field::velocity>, Updates<field::id>,
                           Looks<field::sink_boxes>, Adds<field::emission_sums>>;
  template <class G>
  static void launch(const G& c) {
    c.items(SinkPass<typename G::Real>{
        c[field::sink_boxes],
        int(c.scene.sinks.size()),
        int(c.scene.emitters.size()),
        c.p.gravity,
        {c[field::emission_sums].sums(), 1 / std::sqrt(c.plan.dissipation_unit)},
        c[field::position],
        c[field::velocity],
        c[field::id]});
  }
};

struct EmitLayers {
  static constexpr PassText text{"emit", "predict"};
  using Needs = pbf::Needs<PipeNeeds, Looks<field::row_state>, Places<field::row_state>,
                           Writes<field::position>, Writes<field::velocity>, Writes<field::id>,
                           If<is_second_order, Writes<field::free_velocity>>, MarkNeeds,
                           Totals<field::emission_sums>>;
  template <class G>
  static void launch(const G& c) {
    using Real = typename G::Real;
    const auto pipes = pipes_of<true>(c, c[field::emission_sums]);
    std::int64_t items = 0;
    for (const PlannedNozzle& n : c.plan.emission.nozzles)
      items += n.columns * c.plan.emission.most_born;
    c.items(int(items),
            EmitLayersPass<Real>{c.p, pipes, c[field::row_state], c[field::position],
                                 c[field::velocity], c.declared(field::free_velocity), c[field::id],
                                 c.plan.emission.most_born, c.capacity()});
    c.items(1, CountEmittedPass<Real>{pipes, c[field::row_state], c.capacity()});
  }
};

/// After each prediction, before the sort.
struct HoldPredicted {
  static constexpr PassText text{"hold predicted", "predict"};
  using Needs = pbf::Needs<PipeNeeds, Updates<field::position, W::mark>, Updates<field::velocity>,
                           If<is_second_order, Updates<field::free_velocity>>, Reads<field::id>,
                           Adds<field::emission_sums>>;
  template <class G>
  static void launch(const G& c) {
    c.items(HoldPredictedPass<typename G::Real>{
        c.p, pipes_of<false>(c, c[field::emission_sums].sums()), c[field::position],
        c[field::velocity], c.declared(field::free_velocity), c[field::id]});
  }
};

struct FindPipeRows {
  static constexpr PassText text{"pipe rows", "neighbors"};
  using Needs = pbf::Needs<Looks<field::nozzles>, Reads<field::position>, Places<field::pipe_row>,
                           Places<field::pipe_count>>;
  template <class G>
  static void launch(const G& c) {
    c.items(1, ClearPipeRowsPass{c[field::pipe_count]});
    c.items(FindPipeRowsPass<typename G::Real>{pipes_of<false>(c, nullptr), c[field::position],
                                               c[field::pipe_row], c[field::pipe_count]});
  }
};

/// After each correction.
struct Hold {
  static constexpr PassText text{"hold", "delta"};
  using Needs = pbf::Needs<PipeNeeds, Updates<field::position, W::inverse_density>,
                           Updates<field::velocity>, Reads<field::id>, Looks<field::pipe_row>,
                           Looks<field::pipe_count>, Adds<field::emission_sums>>;
  template <class G>
  static void launch(const G& c) {
    c.listed(c[field::pipe_count],
             HoldPass<typename G::Real>{c.p, pipes_of<false>(c, c[field::emission_sums].sums()),
                                        c[field::pipe_row], c[field::position], c[field::velocity],
                                        c[field::id]});
  }
};

struct Emission {
  static constexpr bool changes_rows = true;
  using Passes = PassList<NextEmission, SinkRows, EmitLayers, HoldPredicted, FindPipeRows, Hold>;
  static void add(const Scene& s, auto& b) {
    if (!comes_and_goes(s))
      return b.left_out("particles that come and go", "no keys emitters, sinks");
    if (has_sinks(s)) b.rows(SinkRows());
    if (!has_emitters(s)) return;
    b.start(NextEmission());
    b.rows(EmitLayers());
    b.predicted(HoldPredicted());
    b.lists(FindPipeRows(), true);
    if (s.solver.iterations > 0) b.iteration(Hold());
    b.end(Hold());
  }

  template <class Real>
  struct Memory : NoMemory {
    double time = 0;  ///< s, of the state

    static std::int64_t most_steps(const Scene& s, const Plan& plan) {
      return has_emitters(s) ? std::max(1, kEmissionRows / plan.substeps)
                             : NoMemory::most_steps(s, plan);
    }
    template <class C>
    void make(C& c) {
      if (!comes_and_goes(c.scene)) return;
      const InFrame frame{c.scene, c.plan};
      std::vector<Nozzle<Real>> nozzles;
      std::vector<Vec4<Real>> columns;
      for (const PlannedNozzle& n : c.plan.emission.nozzles) {
        nozzles.push_back(frame.template nozzle<Real>(n, int(columns.size())));
        for (const Double3& x : n.place.column)
          columns.push_back(with_w(frame.template place<Real>(x), Real(0)));
      }
      c.put(field::nozzles, nozzles);
      c.put(field::nozzle_columns, columns);
      std::vector<SinkBox<Real>> sinks;
      for (const Sink& k : c.scene.sinks) sinks.push_back(frame.template sink<Real>(k));
      c.put(field::sink_boxes, sinks);
    }
    void stand(auto&, double now) { time = now; }
    std::int64_t new_rows(auto& c, const StepRange& r) {
      if (!has_emitters(c.scene) || !(c.p.dt > 0)) return 0;
      const EmissionPlan& plan = c.plan.emission;
      return plan.particles(double(r.first + r.count) * r.dt) -
             plan.particles(double(r.first) * r.dt);
    }
    template <class C>
    void before_steps(C& c, const StepRange& r) {
      if (!has_emitters(c.scene)) return;
      const EmissionPlan& plan = c.plan.emission;
      const double h = c.scene.h();
      std::vector<NozzleStep<Real>> steps;
      const auto add = [&](const EmitterStep& s) {
        NozzleStep<Real>& to = steps.emplace_back();
        to.front = Real(s.front / h), to.speed = Real(s.speed / h);
        to.released = s.released, to.held = s.held, to.born = s.born;
        for (int m = 0; m < s.held; ++m) to.id[m] = int(s.id[m]);
      };
      const bool timed = c.p.dt > 0;
      for (int k = 0; k < (timed ? r.count : 1); ++k)
        for (std::size_t e = 0; e < plan.nozzles.size(); ++e)
          add(timed ? emitter_step(plan, e, r.first + k, r.dt, c.plan.substeps,
                                   c.plan.lists_per_update)
                    : emitter_at(plan, e, time));
      if (timed) time = double(r.first + r.count) * r.dt;
      c.put(field::emission_row, std::vector<EmissionRow>{{}});
      c.put(field::nozzle_steps, steps);
    }
    std::string no_row_text(auto& c) {
      if (!has_emitters(c.scene)) return "";
      EmissionSum first;
      c.exec.to_host(c.data(field::emission_sums), 1, &first);
      return pbf::no_row_text(c.scene, c.plan.emission, first.first);
    }
  };
};

}  // namespace pbf::PBF_VARIANT
