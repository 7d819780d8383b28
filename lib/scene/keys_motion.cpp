// Keys that determine the motion of particles: gravity, time, solver, forces.
#include "lib/scene/key_rows.h"
#include "lib/scene/shorthand.h"

namespace pbf::scene_module {

#define KEY(member) MEMBER(Scene, member)

KeyRows motion_rows() {
  return {
      {{"time", "Step and end of the simulation."},
       optional_block(KEY(time.adaptive),
                      "Divides an update into 2^k equal steps. Every measurement chooses k so that "
                      "the limits below hold. Where the guard would stop the run, the run goes "
                      "back to the last good state and continues with half the step.",
                      exact("a comparison makes an update one step")),
       optional_block(
           KEY(settle),
           "Lets the fluid come to rest before time 0. The run then begins with the packing and "
           "the "
           "level of fluid at rest, without the waves of a start that was put together; motions of "
           "obstacles and tank begin with the run. Velocities are damped meanwhile, and are those "
           "of the bodies when the run begins."),
       {"solver", "The constraint solver."},
       optional_block(KEY(tensile), "Artificial pressure against clusters (s_corr)."),
       optional_block(KEY(viscosity),
                      "Viscosity, of a share per update (xsph) or in physical units (kinematic)."),
       optional_block(KEY(vorticity), "Vorticity confinement.")},
      {key(KEY(gravity), number("m/s^2", kRate),
           "Acceleration of gravity, [x, y, z]. One number is its magnitude, straight down; "
           "{magnitude: 9.81, tilt: 5, toward: x_max} is tilted by so many degrees toward that "
           "face.",
           flat(FlatY::zero), form(gravity_table)),
       key(KEY(settle->duration), number("s", kSeconds),
           "How long. Waves fall to less than 1 % if it is longer than a period of the longest of "
           "them; a lattice needs 1 to 2 s to become a packing at rest."),
       key(KEY(settle->gravity), number("m/s^2", kRate),
           "Gravity meanwhile, as a vector. One that is tilted leaves a level that is tilted when "
           "the run begins: a standing wave. auto: that of the run, in a tank that begins tilted "
           "as "
           "it is there.",
           automatic, flat(FlatY::zero)),
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
           "Time at which the prescribed motions start, for a scene that continues from a state of "
           "another run."),
       key(KEY(time.order), one_of({"auto", "1", "2"}),
           "Order of accuracy of the time steps. 1: as in the paper, which takes energy out of "
           "every "
           "motion under pressure, the more the longer the step. 2: pushes act on average where a "
           "step begins, so that far less energy is lost; velocities are then those of half a step "
           "earlier. auto: 2, and 1 with solver.kernels: paper."),
       key(KEY(time.adaptive->step_min), number("s", {0, 1e9, true}),
           "Shortest step allowed; at least time.step/1048576. auto: time.step/64.", automatic),
       key(KEY(time.adaptive->cfl), number("", {0, 1000, true}),
           "Largest distance, in h, that the fastest particle may move in a step."),
       key(KEY(time.adaptive->force), number("", {0, 1000, true}),
           "Longest step, in units of sqrt(h/a). a is the acceleration of gravity, or the rate at "
           "which the largest speed has changed between two measurements, whichever is larger."),
       key(KEY(solver.iterations), number("", {0, 100000}),
           "Solver iterations per substep; with a tolerance, the least number of them."),
       key(KEY(solver.tolerance), number("", {0, 1}),
           "Mean compression above which the iterations are repeated, as found by the last one "
           "before it moved the particles. 0: a fixed number of iterations.",
           exact("a threshold, which enters no sum")),
       key(KEY(solver.max_iterations), number("", {1, 100000}),
           "Largest number of iterations per substep with a tolerance; a multiple of "
           "solver.iterations."),
       key(KEY(solver.substeps), number("", {1, 1000}),
           "Divides an update into this many time steps, which share the sort and the neighbor "
           "lists as long as little moves (pbf plan says how many lists an update makes). "
           "Viscosity and vorticity act once per update."),
       key(KEY(solver.levels), one_of({"off", "auto", "on"}),
           "Corrects the density on a hierarchy of grids coarser than h in every iteration, so "
           "that the compression does not grow with the depth of the fluid. configs/SETTINGS.md "
           "says "
           "when to use them. auto: on from 64 layers of particles."),
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
           "d/h)^(4/3)), since more neighbors need smaller steps, and less where the density is "
           "above rest_density. With 1, 2 and 3 iterations 1.8 (at most 0.85), 2.2 and 2.3 take "
           "the place of 2.5, in two dimensions 1.7 (at most 0.85) and 2.7 that of 3; with levels "
           "2 and 2.4, in three dimensions with 1 iteration 1.9. With time.order 2 the numbers are "
           "up to an eighth smaller, and with levels and 1 iteration 1.6 (at most 0.75), in two "
           "dimensions 1.85 (at most 0.8).",
           renamed("solver.step_length"), automatic),
       key(KEY(solver.boundary), one_of({"density", "clamp"}),
           "density: walls count in the density like fluid behind them. clamp: particles are "
           "only put back into the box."),
       key(KEY(solver.wall_margin), number("m", {0, 1e9}),
           "Particles are kept at least this far from a wall. Particles that start closer are "
           "moved; if that takes more than half of fluid.spacing, the scene is refused."),
       key(KEY(solver.velocity_damping), number("", {0, 1}),
           "Factor on every velocity, once per update. 1: no damping.", scaled(root), off_at(1)),
       key(KEY(solver.hyperviscosity), number("sqrt(g/h)", {0, 10}),
           "Rate at which a viscosity of fourth order (biharmonic) damps differences of velocity "
           "between neighbors up to 0.05 sqrt(g h), those of fluid that comes to rest; the flow "
           "hardly changes. It acts about every 0.5 sqrt(h/g), above 1 more often. 0: none. auto: "
           "1 with time.order 2, where nothing else calms the particles of fluid at rest, 4 there "
           "with levels, which stir them, otherwise 0. Without gravity it is 0.",
           automatic, off_at(0)),
       key(KEY(solver.speed_limit), number("h per update", {0, 1e6}),
           "Particles that would move farther than this in time.step (however many steps "
           "time.adaptive makes of it) are slowed down. The run counts and reports them. 0: no "
           "limit.",
           scaled(linear), exact("a bound, which all but a few particles keep")),
       key(KEY(solver.prestabilize), plain,
           "Removes the compression of the initial state (blocks in corners, bodies that overlap) "
           "before the first update, by steps that move particles and leave velocities alone. "
           "false: start as given, for a file that continues another run."),
       key(KEY(solver.fused), plain,
           "Computes density and lambda in one loop over the neighbors. false: in two, for timing "
           "them apart."),
       key(KEY(solver.reproducible), plain,
           "Makes the GPU give the same bits as the CPU, more slowly. The CPU always gives these "
           "bits.",
           effect(Effect::none)),
       key(KEY(tensile->k), number("h^2", {0, 1000}), "Strength; 1.0e-03 to 1.0e-02 is useful.",
           scaled(quadratic)),
       key(KEY(tensile->delta_q), number("h", {0, 1, true, true}),
           "Distance, in h, at which the artificial pressure equals k."),
       key(KEY(tensile->n), number("", {1, 16}), "Exponent."),
       key(KEY(viscosity->xsph), number("", {0, 10}),
           "Factor c, not a viscosity in Pa s or m^2/s; stable up to 1. It stands for another "
           "viscosity with every step and spacing. 0 beside kinematic.",
           scaled(linear)),
       key(KEY(viscosity->kinematic), number("m^2/s", {0, 1e9, true}),
           "Kinematic viscosity nu: 1e-6 for water. It acts besides the viscosity of the method "
           "itself, about 0.2 times speed times fluid.spacing. pbf plan compares the two. auto: "
           "none.",
           automatic),
       key(KEY(vorticity->epsilon), number("1/s", {0, 1000}),
           "Strength. The force is limited to twice the rate at which neighbors approach, so that "
           "it adds no more energy than the flow loses.")}};
}

}  // namespace pbf::scene_module
