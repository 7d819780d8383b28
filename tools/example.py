#!/usr/bin/env python3
"""What a run file holds and how to get at it, cell by cell (# %% opens as a notebook in editors).

    python tools/example.py [out/demo]
"""

# %% Open a run: nothing is read yet but what lies where. Works while the run is under way.
import sys

import numpy as np

import pbf_tools

run = pbf_tools.open(sys.argv[1] if len(sys.argv) > 1 else "out/demo")
print(run)
print("fields:", {name: run.units[name] for name in run.fields})
print("spacing:", run.info["spacing"], run.units["spacing"])

# %% One frame: arrays of shape (particles,) or (particles, 3), row i is the i-th id.
last = run.frames[-1]
speed = np.linalg.norm(last["velocity"], axis=1)
print(f"at t = {last.time:g} s: {last.count} particles, at most {speed.max():.3g} m/s fast")

# %% Many frames, some particles: only these rows are read.
heights = run["position"][:, ::100, 2]  # (frames, every 100th particle), m
print("heights:", heights.shape, "mean at the end:", round(float(heights[-1].mean()), 4), "m")

# %% One particle through time, by its id.
track = run.track(17)
way = np.linalg.norm(np.diff(track["position"], axis=0), axis=1).sum()
print(f"particle 17 went {way:.3g} m in {track['time'][-1]:g} s")

# %% The log: measures and seconds per stage.
log = run.log
energy = log["kinetic_energy"] + log["potential_energy"]
print(f"energy: {energy[0]:.4g} J at the start, {energy[-1]:.4g} J at the end")
print(f"compression: at most {100 * log['compression_mean'].max():.3g} % in the mean")
stages = {name[6:]: float(log[name].sum()) for name in log if name.startswith("stage/")}
print("most time in:", max(stages, key=stages.get))

# %% The scene as it ran, every default filled in.
print(run.scene.splitlines()[0])
