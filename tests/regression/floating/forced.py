"""A box that heaves as prescribed: added mass and damping from the load, against linear theory; and
the load on a box that is moved as a free one has moved."""

import numpy as np

import heave
from heave import BEAM, DEPTH, HEIGHT
from lab import G, RHO, harmonic
from theory import Box

DRAFT, PERIOD, LENGTH = 0.1, 0.9, 6.0  # m, s, m
# Spacing, amplitude, settings.
CASES = [(0.02, 0.02, ""), (0.01, 0.02, ""), (0.01, 0.005, ""), (0.02, 0.02, "solver.levels=on"),
         (0.02, 0.02, "solver.iterations=16")]


def measure(lab):
    omega, rows = 2 * np.pi / PERIOD, []
    added, damping, _ = Box(BEAM, DRAFT, DEPTH).heave(omega)
    for spacing, amplitude, settings in CASES:
        run = lab.run(f"""
dimensions: 2
domain: {{min: [0, 0], max: [{LENGTH}, {DEPTH + 0.4}]}}
fluid: {{spacing: {spacing}}}
bodies: [{{shape: block, min: [0, 0], max: [{LENGTH}, {DEPTH}]}}]
obstacles: [{{name: box, shape: box, center: [{LENGTH / 2}, {0.993 * DEPTH}], size: [{BEAM}, {HEIGHT}],
  loads: true, motion: {{kind: sine, direction: [0, 0, 1], amplitude: {amplitude},
  period: {PERIOD}, ramp: {PERIOD / 2}}}}}]
settle: {{duration: 2}}
time: {{step: {0.1 * spacing}, end: {2.5 * PERIOD}}}
measure_every: 5
""", settings)
        t, force = run.log["time"], run.log["load/box/force_z"] / spacing  # N per m of width
        t = t - (t[2] - t[1]) / 2  # the middle of each mean
        late = t > PERIOD
        mean, c, rest = harmonic(t[late], force[late], omega)
        # z = amplitude sin(w t); force = mean - A z'' - B z' - rho g beam z.
        a = (c.imag / amplitude + RHO * G * BEAM) / omega**2
        b = -c.real / (amplitude * omega)
        rows.append({"beam_in_spacings": round(BEAM / spacing),
                     "amplitude_in_spacings": amplitude / spacing, "set": settings,
                     "added_mass": a, "added_mass_theory": added,
                     "damping": b, "damping_theory": damping, "damping_ratio": b / damping,
                     "mean_over_buoyancy": mean / (RHO * G * BEAM * DRAFT),
                     "rest_over_stiffness": rest / (RHO * G * BEAM * amplitude)})
    lab.table("forced", rows)
    replay(lab)


def replay(lab):
    """Moves a box along the path of a free one, in the same tank from the same start. Their impulses
    may differ by the load that the packing bears at rest, a constant force."""
    rows = []
    for off in (0.02, -0.02):
        scene = heave.scene(0.02, 500, 3.0, off).replace("end: 1.1", "end: 0.7")
        run = lab.run(scene)
        t, z, v = (run.log[c] for c in ("time", "pose/box/z", "pose/box/velocity_z"))
        with open(lab.folder / "path.csv", "w") as file:
            file.write("t,x,y,z\n")
            for a, b in zip([*t, 10], [*(z - z[0]), z[-1] - z[0]]):
                file.write(f"{a:.6f},0,0,{b:.8f}\n")
        run = lab.run(scene.replace("free: {density: 500, lock: [x, ry]}",
                                    "loads: true, motion: {kind: file, path: path.csv}"))
        mass = 500 * BEAM * HEIGHT
        force = run.log["load/box/force_z"] / 0.02 - mass * G
        gained = np.concatenate([[0], np.cumsum(force[1:] * np.diff(t))]) / mass
        slope, constant = np.polyfit(t, gained - v, 1)
        rows.append({"start": off, "speed_max": np.abs(v).max(), "constant_force_over_weight":
                     slope / G, "rest": np.std(gained - v - slope * t - constant)})
    lab.table("replay", rows)
