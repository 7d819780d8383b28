#!/usr/bin/env python3
"""A sweep from Python, cell by cell (# %% opens as a notebook in editors): which step and how many
iterations give the least error for the time that they take?

    python tools/tutorial.py

Half a minute to a minute. TUTORIAL_SPACING sets another size (m), TUTORIAL_OUT another folder.
"""

# %% A scene is a dict of the same keys as a scene file: a column of water falls into a tank.
import os
from pathlib import Path

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

# %% The error of a run: its mean compression, averaged over time. Its time: that of the stages.
table["error"] = [100 * r.log["compression_mean"].mean() for r in table.runs]
table["run_time"] = [sum(r.log[name].sum() for name in r.log if name.startswith("stage/"))
                     for r in table.runs]
table.units |= {"error": "%", "run_time": "s"}

# %% Which one would you take? The one with the least error below a time.
limit = 2 * table["run_time"].min()
fast = table.where(table["run_time"] <= limit)
best = fast["error"].argmin()
print(f"least error below {limit:.2g} s: {fast['error'][best]:.2g} % with a step of "
      f"{fast['time.step'][best]:g} s and {fast['solver.iterations'][best]:g} iterations")

# %% The same as a figure. pbf_tools.plot has a function for every plot command; a notebook shows what
# they return.
fig = pbf_tools.plot.batch(table, x="run_time", y="error", log=True,
                           title=f"{plan['particles']} particles, {run.info['device']}")
fig.savefig(out / "error_against_time.png")
print(out / "error_against_time.png")
fig  # noqa: B018

# %% Where the energy of the first run went.
fig = pbf_tools.plot.energy(run)
fig.savefig(out / "energy.png")
print(fig.told[0])
fig  # noqa: B018
