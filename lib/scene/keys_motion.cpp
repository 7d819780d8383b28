// Keys of what moves the particles: gravity, time, solver, forces.
#include "lib/scene/key_rows.h"
#include "lib/scene/shorthand.h"

namespace pbf::inline scene_module {

#define KEY(member) MEMBER(Scene, member)

KeyRows motion_rows() {
  return {
      {{"time", "Step and end of the simulation."},
       optional_block(
           KEY(time.adaptive),
           "Updates of 2^k steps of time.step/2^k, k chosen at every measure so that the "
           "flow keeps the limits below, or finer: where the guard would stop the run, it "
           "goes back to the last good state and goes on with half the step.",
           exact("a comparison makes an update one step")),
       {"solver", "The constraint solver."},
       optional_block(KEY(tensile), "Artificial pressure against clusters (s_corr)."),
       optional_block(KEY(viscosity), "XSPH viscosity."),
       optional_block(KEY(vorticity), "Vorticity confinement.")},
      {key(KEY(gravity), number("m/s^2", kRate),
           "Acceleration of gravity, [x, y, z]. One number is its magnitude, straight down; "
           "{magnitude: 9.81, tilt: 5, toward: x_max} is tilted by so many degrees toward that "
           "face.",
           flat(FlatY::zero), form(gravity_table)),
       key(KEY(time.step), number("s", kSeconds),
           "Time of one update, dt. About 0.03 sqrt(h/g) is safe. auto: the longest up to that, "
           "and up to 0.2 h of way of the fastest body or obstacle, of which output.every is a "
           "whole "
           "number; in a tank that moves, g is the most that the fluid feels at rest. The number "
           "chosen stands in the resolved scene.",
           required, automatic, scaled(linear)),
       key(KEY(time.end), number("s", kSeconds),
           "Time simulated, rounded to whole updates; at least time.step.", required,
           effect(Effect::none)),
       key(KEY(time.motion_begin), number("s", {-1e9, 1e9}),
           "Time of the motions at the start, for a scene that goes on from a state of another "
           "run."),
       key(KEY(time.adaptive->step_min), number("s", {0, 1e9, true}),
           "No step is shorter; at least time.step/1048576. auto: time.step/64.", automatic),
       key(KEY(time.adaptive->cfl), number("", {0, 1000, true}),
           "The fastest particle moves by at most so many h in a step."),
       key(KEY(time.adaptive->force), number("", {0, 1000, true}),
           "A step is at most so many sqrt(h/a), a the acceleration of gravity or, if that is "
           "more, the change of the fastest speed between two measures over their time."),
       key(KEY(solver.iterations), number("", {0, 100000}),
           "Iterations over the constraints per substep; with a tolerance, at least."),
       key(KEY(solver.tolerance), number("", {0, 1}),
           "The iterations are repeated while the mean compression that the last one found, before "
           "it moved the particles, is above this. 0: they are not.",
           exact("a threshold, which enters no sum")),
       key(KEY(solver.max_iterations), number("", {1, 100000}),
           "Iterations per substep at most, a multiple of solver.iterations, where there is a "
           "tolerance."),
       key(KEY(solver.substeps), number("", {1, 1000}),
           "Time steps of time.step/substeps that share one update's sort and neighbour lists, "
           "as long as little moves meanwhile (pbf plan says how many lists an update makes); "
           "viscosity and vorticity act once per update."),
       key(KEY(solver.levels), one_of({"off", "auto", "on"}),
           "Corrections over a hierarchy of grids coarser than h, in every iteration: the "
           "compression of deep fluid then does not grow with its depth. In flows use one "
           "iteration per substep: more of them raise the energy. auto: from 64 layers of fluid "
           "on."),
       key(KEY(solver.method), one_of({"jacobi", "chebyshev"}),
           "jacobi: every iteration with omega = sor. chebyshev: omega follows Chebyshev's steps "
           "for "
           "eigenvalues from 1/2 to 3/2 of Jacobi's matrix, large ones first: less error for the "
           "same work from 2 iterations on."),
       key(KEY(solver.kernels), one_of({"consistent", "paper"}),
           "consistent: one kernel (Spiky) for density and its gradient. paper: Poly6 for the "
           "density, Spiky for the gradient (Macklin & Mueller 2013)."),
       key(KEY(solver.constraint), one_of({"one_sided", "two_sided"}),
           "one_sided: only compression is corrected, C = max(rho/rho0 - 1, 0). two_sided: C = "
           "rho/rho0 - 1, which pulls particles together and needs `tensile` against clusters."),
       key(KEY(solver.cfm), number("", {0, 1e12}),
           "eps h^2, in the denominator of lambda (constraint force mixing, made dimensionless). "
           "Larger is softer.",
           renamed("solver.relaxation")),
       key(KEY(solver.sor), number("", {0, 2, true}),
           "Factor omega on the position change of one iteration (successive over-relaxation; "
           "below "
           "1 it under-relaxes). auto: min(1, (2.5 d/h)^2), in two dimensions min(1, (3 "
           "d/h)^(4/3)), since more neighbours need smaller steps, and less where the density is "
           "above rest_density; with levels 2 and 2.4 in place of 2.5 and 3.",
           renamed("solver.step_length"), automatic),
       key(KEY(solver.boundary), one_of({"density", "clamp"}),
           "density: walls count in the density like fluid behind them. clamp: particles are "
           "only put back into the box."),
       key(KEY(solver.wall_margin), number("m", {0, 1e9}),
           "Distance to a wall at which particles are clamped. What is nearer at the start is "
           "put there; by more than half of fluid.spacing it is refused."),
       key(KEY(solver.velocity_damping), number("", {0, 1}),
           "Factor on every velocity, once per update. 1: no damping.", scaled(root), off_at(1)),
       key(KEY(solver.speed_limit), number("h per update", {0, 1e6}),
           "Particles that would move farther than this in time.step, however many steps that is "
           "(time.adaptive), are slowed down to it; how often is counted and reported. 0: no "
           "limit.",
           scaled(linear), exact("a bound, which all but a few particles keep")),
       key(KEY(solver.prestabilize), plain,
           "Steps without time before the first update, while the compression of the start "
           "(blocks in corners, bodies that overlap) would add to the energy: they move "
           "particles and leave velocities alone. false: the start as it is given, as for a file "
           "that continues a run."),
       key(KEY(solver.fused), plain, "Density and lambda in one loop over the neighbours."),
       key(KEY(solver.reproducible), plain,
           "The GPU gives the CPU's results bit for bit, more slowly. The CPU always does.",
           effect(Effect::none)),
       key(KEY(tensile->k), number("h^2", {0, 1000}), "Strength; 1.0e-03 to 1.0e-02 is useful.",
           scaled(quadratic)),
       key(KEY(tensile->delta_q), number("h", {0, 1, true, true}),
           "Distance at which the artificial pressure has its strength."),
       key(KEY(tensile->n), number("", {1, 16}), "Exponent."),
       key(KEY(viscosity->xsph), number("", {0, 10}), "Factor c; stable up to 1.", scaled(linear)),
       key(KEY(vorticity->epsilon), number("1/s", {0, 1000}),
           "Strength; acts up to twice the rate at which neighbours approach, so that it adds no "
           "more than the flow loses.")}};
}

}  // namespace pbf::inline scene_module
