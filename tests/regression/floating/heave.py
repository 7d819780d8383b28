"""A floating box that is released too high or too low, against linear theory.

Half the difference of both runs is the part of the motion that changes its sign with the start, so
neither the level of the water at rest nor its first sinking matters.
"""

import numpy as np

from lab import extreme
from theory import Box

BEAM, HEIGHT, DEPTH, AMPLITUDE = 0.2, 0.2, 0.4, 0.2  # m; a share of the draft
# Density, spacing, length of the tank, settings.
CASES = [(density, 0.02, 3.0, f"solver.levels={levels}") for density in (300, 500, 800)
         for levels in ("off", "on")]
CASES += [(300, 0.01, 3.0, "solver.levels=off"), (500, 0.01, 3.0, "solver.levels=off"),
          (500, 0.01, 3.0, "solver.levels=on"), (800, 0.01, 3.0, "solver.levels=off"),
          (500, 0.01, 3.0, "fluid.smoothing_ratio=3")]
CASES += [(500, 0.02, 4.0, settings) for settings in (
    "", "time.step=0.001", "solver.iterations=8", "solver.substeps=4 solver.iterations=1",
    "time.order=1", "solver.hyperviscosity=0", "fluid.smoothing_ratio=3")]


def scene(spacing, density, length, off):
    draft = HEIGHT * density / 1000
    rest = 0.993 * DEPTH - draft + HEIGHT / 2  # settled fluid keeps this much of its height
    return f"""
dimensions: 2
domain: {{min: [0, 0], max: [{length}, {DEPTH + 0.4}]}}
fluid: {{spacing: {spacing}}}
bodies: [{{shape: block, min: [0, 0], max: [{length}, {DEPTH}]}}]
obstacles: [{{name: box, shape: box, center: [{length / 2}, {rest + off}], size: [{BEAM}, {HEIGHT}],
  free: {{density: {density}, lock: [x, ry]}}}}]
settle: {{duration: 2}}
time: {{step: {0.1 * spacing}, end: 1.1}}
measure_every: 5
"""


def measure(lab):
    rows, shown, theory = [], {}, {}
    for density, spacing, length, settings in CASES:
        draft = HEIGHT * density / 1000
        z = []
        for off in (AMPLITUDE * draft, -AMPLITUDE * draft):
            run = lab.run(scene(spacing, density, length, off), settings)
            t = run.log["time"]
            z.append(run.log["pose/box/z"])
        odd = (z[0] - z[1]) / (z[0][0] - z[1][0])
        if density not in theory:
            times = np.linspace(0, t[-1], 561)
            theory[density] = times, Box(BEAM, draft, DEPTH).decay(times)
        half, first = extreme(t, odd, -1)
        half_theory, first_theory = extreme(*theory[density], -1)
        rows.append({"density": density, "beam_in_spacings": round(BEAM / spacing),
                     "tank": length, "set": settings, "start_in_spacings": AMPLITUDE * draft / spacing,
                     "half_period": half, "half_period_theory": half_theory,
                     "half_period_ratio": half / half_theory, "first_swing": -first,
                     "first_swing_theory": -first_theory})
        shown[density, spacing, settings] = t, odd
    lab.table("heave", rows)
    axes, save = lab.figure("heave", 3)
    for panel, density in zip(axes, (300, 500, 800)):
        panel.plot(*theory[density], "k", label="linear theory")
        for k, (spacing, settings, label) in enumerate((
                (0.02, "solver.levels=off", "10 spacings"),
                (0.02, "solver.levels=on", "10, levels on"),
                (0.01, "solver.levels=off", "20 spacings"),
                (0.01, "solver.levels=on", "20, levels on"),
                (0.01, "fluid.smoothing_ratio=3", "20, h = 3 d"))):
            if (density, spacing, settings) in shown:
                panel.plot(*shown[density, spacing, settings], f"C{k}", label=label, lw=1)
        panel.set(xlabel="time, s", ylabel="heave / start", title=f"density {density / 1000}")
    axes[1].legend(fontsize=7)
    save()
