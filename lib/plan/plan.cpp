#include "lib/plan/plan.h"

#include <algorithm>
#include <cmath>

#include "kernels/smoothing.h"
#include "lib/base/error.h"
#include "lib/solver/calibrate.h"

namespace pbf {
namespace {

/// Cells of one h where their number is in proportion to the particles, else larger ones: a nearly
/// empty box must not cost more memory than its fluid.
void plan_grid(Plan& plan, const Scene& s) {
  double box[3];
  for (std::size_t k = 0; k < 3; ++k) box[k] = (s.domain.max[k] - s.domain.min[k]) / s.h();
  const auto number = [&](double edge) {
    return (std::floor(2 * box[0] / edge) + 1) / 2 * (std::floor(box[1] / edge) + 1) *
           (std::floor(box[2] / edge) + 1);
  };
  const double limit = std::min(double(plan.particles) + 65536, 2e8);
  plan.cell_edge = 1;
  while (number(plan.cell_edge) > limit) {
    plan.cell_edge *= std::max(1.01, std::cbrt(number(plan.cell_edge) / limit));
    if (!std::isfinite(plan.cell_edge))
      throw Error(ExitCode::bad_input, "domain: too large for its smoothing length");
  }
  plan.cells[0] = int(2 * box[0] / plan.cell_edge) + 1;
  for (int k = 1; k < 3; ++k) plan.cells[k] = int(box[k] / plan.cell_edge) + 1;
}

void plan_passes(Plan& plan, const Scene& s) {
  const int k = s.solver.iterations;
  auto add = [&](const char* name, const char* stage, const char* reads, const char* writes,
                 int times = 1) {
    plan.passes.push_back({name, stage, reads, writes, times});
  };
  add("predict", "predict", "position velocity", "position velocity bin");
  add("sort", "grid", "bin", "order bin_start");
  add("gather", "grid", "order position velocity id", "position' velocity' id'");
  add("lists", "neighbors", "position bin_start", "lists");
  if (k > 0 && !plan.fused) add("density", "density", "position lists", "density", k);
  if (k > 0) {
    add(plan.fused ? "density+lambda" : "lambda", "lambda",
        plan.fused ? "position lists" : "position lists density",
        plan.fused ? "position' density" : "position'", k);
    add(plan.tensile ? "delta+move (tensile)" : "delta+move", "delta",
        "position' lists density velocity", "position velocity", k);
  }
  if (plan.xsph) add("xsph", "xsph", "position velocity lists", "velocity'");
  if (plan.vorticity) {
    add("curl", "vorticity", "position velocity lists", "curl");
    add("confinement", "vorticity", "position curl lists velocity", "velocity");
  }
}

void plan_arrays(Plan& plan, const Scene& s) {
  const bool dbl = s.precision == Precision::dbl;
  const std::string real = dbl ? "double" : "float";
  const double r = dbl ? 8 : 4;
  auto add = [&](const char* name, const std::string& element, double bytes) {
    plan.arrays.push_back(
        {name, element, bytes, std::int64_t(std::ceil(bytes * double(plan.particles)))});
  };
  for (const char* name : {"position", "position'", "velocity", "velocity'"})
    add(name, "4 x " + real, 4 * r);
  add("density", real, r);
  for (const char* name : {"id", "id'", "bin", "order"}) add(name, "int32", 4);
  if (plan.vorticity) add("curl", "4 x " + real, 4 * r);
  if (s.guard) add("kept for the guard", "state", 8 * r + 4);
  // At rest the unit ball holds (4/3) pi (h/d)^3 particles; the lists keep 12.5 % of air.
  const double neighbors = 4.0 / 3.0 * kPi * std::pow(s.fluid.smoothing_ratio, 3) - 1;
  add("lists (at rest density)", "int32", 4 * neighbors * 1.125 + 8);
  const std::int64_t bins = std::int64_t(plan.cells[0]) * plan.cells[1] * plan.cells[2] * 4;
  plan.arrays.push_back({"bin_start", "int32", 0, 4 * (bins + 1)});
  plan.arrays.push_back({"bin histogram (per thread)", "int32", 0, 4 * bins});
}

void plan_left_out(Plan& plan, const Scene& s) {
  auto out = [&](bool absent, const char* what, const char* why) {
    if (absent) plan.left_out.push_back({what, why});
  };
  out(!plan.xsph, "xsph pass", "no key viscosity");
  out(!plan.tensile, "artificial pressure in the delta loop", "no key tensile");
  out(!plan.vorticity, "curl and confinement passes, curl array", "no key vorticity");
  out(plan.fused, "density pass of its own", "solver.fused is true");
  out(s.solver.boundary == BoundaryMode::clamp, "wall density", "solver.boundary is clamp");
  out(s.solver.iterations == 0, "lambda and delta passes", "solver.iterations is 0");
  out(!s.guard, "the guard and its copy of the state", "guard is off");
  out(s.solver.speed_limit == 0, "limit on the speed", "solver.speed_limit is 0");
  out(!s.output, "run.h5, its writer thread and downloads", "no key output");
  out(!s.render, "pictures, the GL library and its thread", "no key render");
  out(s.backend == Backend::cpu, "CUDA context", "backend is cpu");
}

void plan_files(Plan& plan, const Scene& s) {
  plan.files.push_back("scene.resolved.yaml, log.txt");
  if (s.output) {
    const double scalar = s.output->precision == Precision::dbl ? 8 : 4;
    double row = 3 * scalar + 4;
    for (const auto& f : s.output->fields) row += (f == "velocity" ? 3 : 1) * scalar;
    const double updates = std::max(1.0, std::round(s.output->every / s.time.step));
    const double all = std::round(s.time.end / s.time.step);
    const double frames = std::floor(all / updates) + 1 + (std::fmod(all, updates) != 0 ? 1 : 0);
    const double mb = (frames * row + 4) * double(plan.particles) / 1e6;
    plan.files.push_back("run.h5: " + std::to_string(std::int64_t(frames)) + " frames, about " +
                         std::to_string(std::int64_t(std::ceil(mb))) + " MB" +
                         (s.output->gzip ? " before compression" : ""));
  }
  if (s.render)
    plan.files.push_back(
        "frames/frame_*.png: about " +
        std::to_string(std::int64_t(std::floor(s.time.end / s.render->every + 1e-9)) + 1) +
        " pictures");
}

}  // namespace

std::int64_t Plan::bytes() const {
  std::int64_t sum = 0;
  for (const PlanArray& a : arrays) sum += a.bytes;
  return sum;
}

Plan make_plan(const Scene& s, std::int64_t particles) {
  Plan plan;
  plan.particles = particles;
  const double h = s.h();
  if (s.fluid.mass) {
    plan.mass = *s.fluid.mass;
    plan.vol = plan.mass / (s.fluid.rest_density * h * h * h);
    plan.wall_scale = plan.wall_range = 1;
  } else {
    const Calibration c = calibrate(s.solver.kernels, s.fluid.smoothing_ratio);
    plan.mass = s.fluid.rest_density * std::pow(s.fluid.spacing, 3);
    plan.vol = c.vol;
    plan.wall_scale = c.wall_scale;
    plan.wall_range = c.wall_range;
  }
  const double crowd = 2.5 / s.fluid.smoothing_ratio;
  plan.step_length = s.solver.step_length ? *s.solver.step_length : std::min(1.0, crowd * crowd);
  plan.fused = s.solver.fused;
  plan.tensile = s.tensile && s.tensile->k != 0;
  plan.xsph = s.viscosity && s.viscosity->xsph != 0;
  plan.vorticity = s.vorticity && s.vorticity->epsilon != 0;
  plan_grid(plan, s);
  plan_passes(plan, s);
  plan_arrays(plan, s);
  plan_left_out(plan, s);
  plan_files(plan, s);
  return plan;
}

}  // namespace pbf
