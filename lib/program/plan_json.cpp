// The plan as JSON.
#include <nlohmann/json.hpp>

#include "lib/base/json.h"
#include "lib/program/body_mass.h"
#include "lib/program/numbers.h"
#include "lib/program/plan.h"
#include "lib/program/relaxation.h"
#include "lib/program/settings_row.h"
#include "lib/program/threads.h"
#include "lib/program/wave_plan.h"
#include "lib/scene/auto_step.h"

namespace pbf::program_module {
namespace {

/// One object per backend and precision, with its arrays.
Json memory_json(const Plan& plan, const Scene& scene) {
  Json out = Json::array();
  const auto place = [](bool on_device) { return on_device ? "device" : "host"; };
  for (const MemoryChoice& c : memory_choices(scene, plan)) {
    const MemoryPlan& m = c.memory;
    Json fixed = Json::array(), arrays = Json::array();
    for (const FixedMemory& f : m.fixed)
      fixed.push_back({{"name", f.name}, {"bytes", f.bytes}, {"place", place(f.on_device)}});
    for (const PlanArray& a : m.arrays)
      arrays.push_back({{"name", a.name},
                        {"type", a.type},
                        {"components", a.components},
                        {"elements", a.elements},
                        {"bytes", a.bytes},
                        {"held", kHeldNames[int(a.held)]},
                        {"place", place(a.on_device)}});
    out.push_back({{"backend", word(c.backend)},
                   {"precision", word(c.precision)},
                   {"solver_bytes", m.solver_bytes()},
                   {"host_arrays", m.host_arrays},
                   {"host_fixed", m.fixed_bytes(false)},
                   {"host_peak", m.host_peak()},
                   {"device_arrays", m.device_arrays},
                   {"device_fixed", m.fixed_bytes(true)},
                   {"device_peak", m.device_peak()},
                   {"fixed", fixed},
                   {"arrays", arrays}});
  }
  return out;
}

/// One object per emitter: its columns, and at its highest speed what it brings.
Json emission_json(const Plan& plan, const Scene& scene) {
  Json out = Json::array();
  for (std::size_t e = 0; e < scene.emitters.size(); ++e) {
    const PlannedNozzle& n = plan.emission.nozzles[e];
    const double rate = fastest_of(scene.emitters[e]) * double(n.columns) / scene.fluid.spacing;
    out.push_back({{"name", scene.emitters[e].name},
                   {"columns", n.columns},
                   {"area_m2", n.area},
                   {"particles_per_s", rate},
                   {"kg_per_s", rate * plan.mass},
                   {"particles", n.columns * plan.emission.released(e, scene.time.end)},
                   {"pipe_m", n.place.depth}});
  }
  return out;
}

/// One object per free body. In two dimensions mass and inertia are of 1 m of width.
Json bodies_json(const Scene& scene) {
  Json out = Json::array();
  for (const Obstacle& o : scene.obstacles) {
    if (!o.free) continue;
    const BodyMass m = body_mass(scene, o);
    out.push_back({{"name", o.name},
                   {"mass_kg", m.mass},
                   {"volume_m3", m.volume},
                   {"center_m", m.center},
                   {"inertia_kg_m2", m.inertia},
                   {"lock", o.free->lock}});
  }
  return out;
}

}  // namespace

Json plan_json(const Plan& plan, const Scene& s) {
  Json axes = Json::array(), passes = Json::array(), files = Json::array(), left = Json::array(),
       numbers = Json::array();
  for (const int axis : plan.axes.of) axes.push_back(std::string(1, char('x' + axis)));
  for (const PassCount& c : count_passes(plan.program))
    passes.push_back({{"name", c.pass->name},
                      {"stage", c.pass->stage},
                      {"reads", reads_text(*c.pass)},
                      {"writes", writes_text(*c.pass)},
                      {"gathers", gathers_text(*c.pass)},
                      {"per_update", c.times}});
  for (const PlanFile& f : plan.files)
    files.push_back({{"name", f.name}, {"number", f.number}, {"bytes", f.bytes}});
  for (const LeftOut& l : plan.left_out) left.push_back({{"what", l.what}, {"because", l.because}});
  const std::optional<SettingsRow> row = settings_row(s);
  for (const SceneNumber& n : scene_numbers(s))
    numbers.push_back({{"name", n.name}, {"value", n.value}, {"formula", n.formula}});
  const PlanTotals totals = plan_totals(plan, s);
  return {{"scene", s.name},
          {"particles", plan.particles},
          {"most_particles", plan.most_particles()},
          {"emitters", emission_json(plan, s)},
          {"free_bodies", bodies_json(s)},
          {"waves", wave_json(s)},
          {"numbers", numbers},
          {"settings_row", row ? Json(row->row) : Json()},
          {"spacing_m", s.fluid.spacing},
          {"h_m", s.h()},
          {"end_s", totals.end},
          {"step_s", s.time.step},
          {"updates", totals.updates},
          {"settling_updates", totals.settling},
          {"relative_step", relative_step(s)},
          {"host_bytes", totals.host_bytes},
          {"device_bytes", totals.device_bytes},
          {"disk_bytes", totals.disk_bytes},
          {"bytes", plan.bytes()},
          {"cells", {plan.cells[0], plan.cells[1], plan.cells[2]}},
          {"cell_edge_h", plan.cell_edge},
          {"sor", plan.sor},
          {"sor_limit", sor_limit(s)},
          {"viscosity",
           {{"sweeps", plan.viscosity.sweeps},
            {"factor", plan.viscosity.factor},
            {"kinematic_m2_per_s", kinematic_viscosity(s)},
            {"of_method_m2_per_s_per_m_per_s", kOwnViscosity * s.fluid.spacing}}},
          {"hyperviscosity",
           {{"every_updates", plan.hyperviscosity.every}, {"factor", plan.hyperviscosity.factor}}},
          {"vol", plan.vol},
          {"wall_scale", plan.wall_scale},
          {"wall_range_h", plan.wall_range},
          {"mass_kg", plan.mass},
          {"axes", axes},
          {"finest_level", plan.finest_level},
          {"lists_per_update", plan.lists_per_update},
          {"threads", about(s.backend).on_device ? 0 : solver_threads(s, plan.particles)},
          {"passes", passes},
          {"memory", memory_json(plan, s)},
          {"files", files},
          {"left_out", left}};
}

}  // namespace pbf::program_module
