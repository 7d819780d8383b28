#!/usr/bin/env python3
"""A sweep from Python, cell by cell (# %% opens as a notebook in editors): which step and how many
iterations give the least error for the time that they take?

    python tools/tutorial.py

Half a minute to a minute. TUTORIAL_SPACING sets another size (m), TUTORIAL_OUT another folder.
"""

# %% A scene is a dict of the same keys as a scene file: a column of water falls into a tank.
import os
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import pbf_tools

out = Path(os.environ.get("TUTORIAL_OUT", "out/tutorial"))
scene = {
    "name": "column",
    "domain": {"min": [0, 0, 0], "max": [1.2, 0.4, 0.8]},
    "fluid": {"spacing": float(os.environ.get("TUTORIAL_SPACING", 0.025))},
    "bodies": [{"shape": "block", "min": [0, 0, 0], "max": [0.4, 0.4, 0.6]}],
    "time": {"step": 0.002, "end": 0.5},
}

# %% Before anything runs: how large is it?
plan = pbf_tools.plan(scene)
print(plan["particles"], "particles,", round(plan["memory"][0]["host_peak"] / 1e6), "MB on the CPU")

# %% One run, and a look at it. A finished one is left as it is when the cell is run again.
run = pbf_tools.run(scene, out / "one", resume=True)
energy = run.log["kinetic_energy"] + run.log["potential_energy"]
print(run)
print(f"energy: {energy[0]:.4g} {run.log.units['energy']} at the start, {energy[-1]:.4g} at the end")

# %% The sweep: every combination of the values, one run after the other.
grid = {"time.step": [0.004, 0.002, 0.001], "solver.iterations": [1, 2, 4, 8]}
table = pbf_tools.batch(scene, grid, out / "sweep", threads=1)
print(len(table), "runs:", ", ".join(table["name"].tolist()[:2]), "...")

# %% The error of a run: its mean compression (%), averaged over time. The time: its stages (s).
error = np.array([100 * r.log["compression_mean"].mean() for r in table.runs])
seconds = np.array([sum(r.log[name].sum() for name in r.log if name.startswith("stage/"))
                    for r in table.runs])
step, iterations = table["time.step"], table["solver.iterations"]

# %% Which one would you take? The one with the least error below a time.
limit = 2 * seconds.min()
best = np.flatnonzero(seconds <= limit)[error[seconds <= limit].argmin()]
print(f"least error below {limit:.2g} s: {error[best]:.2g} % with a step of {step[best]:g} s and "
      f"{iterations[best]:g} iterations")

# %% The same as a figure.
fig, axes = plt.subplots(figsize=(6.4, 4.4), layout="constrained")
for value in np.unique(step)[::-1]:
    rows = np.flatnonzero(step == value)
    line, = axes.plot(seconds[rows], error[rows], "o-", label=f"step {1000 * value:g} ms")
    for k in rows:
        axes.annotate(f"{iterations[k]:g}", (seconds[k], error[k]), textcoords="offset points",
                      xytext=(5, 4), color=line.get_color(), fontsize=8)
axes.set(xscale="log", yscale="log", xlabel="run time (s)", ylabel="mean compression (%)",
         title=f"Numbers: iterations; {plan['particles']} particles, {run.info['device']}")
axes.xaxis.set_major_formatter("{x:g}")
axes.xaxis.set_minor_formatter(lambda x, _: f"{x:g}" if f"{x:g}"[-1] in "2357" else "")
axes.grid(which="both", alpha=0.3)
axes.legend()
fig.savefig(out / "error_against_time.png", dpi=130)
print(out / "error_against_time.png")
