"""Scenes of shallow water, beds of given heights, and the theories to compare with."""

import subprocess
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tools"))
import pbf_tools  # noqa: E402

G = 9.81      # m/s^2
D = 0.01      # m, spacing of particles on beds
BUMP = 6      # spacings from one bump of a bed to the next
FLOOR = 0.02  # m, mean height of a bed above the floor of the domain
RUN_UP = {"toe": 2.0, "slope": 0.1, "dam": 1.2, "high": 0.15, "low": 0.06}  # m; 1


def bed_height(x, y, rough):
    """Bumps and hollows in turn. rough: from the lowest to the highest place, in spacings."""
    k = 2 * np.pi / (BUMP * D)
    return FLOOR + 0.5 * rough * D * np.sin(k * x) * np.sin(k * y)


def write_bed(path, length, width, rough):
    """Heights half a spacing apart, which is h/4."""
    x, y = (np.linspace(0, edge, round(2 * edge / D) + 1) for edge in (length, width))
    with open(path, "w") as file:
        file.write("x,y,z\n")
        for b in y:
            for a in x:
                file.write(f"{a:.4f},{b:.4f},{bed_height(a, b, rough):.6f}\n")


def run(pbf, folder, name, scene, *settings):
    """Runs a scene, the text of a YAML file, on one thread, unless it was run; the run file."""
    out = folder / name
    if not (out / "DONE").exists():
        (folder / f"{name}.yaml").write_text(scene)
        command = [pbf, "run", folder / f"{name}.yaml", "--out", out, "--overwrite", "--quiet",
                   "--set", "threads=1"]
        for s in settings:
            command += ["--set", s]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return pbf_tools.open(out / "run.vtkhdf")


def layer(path, length, width, deep, rough, more, friction=0):
    """A layer of water over a bed, whose heights it writes to path; deep: spacings from its mean
    height to the surface. rough: None for the floor of the domain in place of a bed."""
    bed, loads, floor = "", ", loads: true", 0
    if rough is not None:
        write_bed(path, length, width, rough)
        bed = (f"obstacles: [{{name: bed, shape: heights, path: {path.name}, loads: true, "
               f"friction: {friction}}}]\n")
        loads, floor = "", FLOOR
    top = floor + deep * D
    return f"""
domain: {{min: [0, 0, 0], max: [{length}, {width}, {top + 0.1:.4g}]{loads}}}
fluid: {{spacing: {D}}}
bodies: [{{shape: block, min: [0, 0, 0], max: [{length}, {width}, {top:.4g}]}}]
{bed}measure_every: 10
{more}"""


def bore_scene(d, width=None):
    """Water 0.15 m deep behind a dam, 0.06 m before it, and a slope of 1:10."""
    s = RUN_UP
    flat = width is None
    shore = s["toe"] + s["low"] / s["slope"]

    def at(x, z, y=0):
        return f"[{x}, {z}]" if flat else f"[{x}, {y}, {z}]"

    return f"""
{"dimensions: 2" if flat else ""}
domain: {{min: {at(0, 0)}, max: {at(5 if flat else 6, 0.5, width)}}}
fluid: {{spacing: {d}}}
bodies:
  - {{shape: block, min: {at(0, 0)}, max: {at(s["dam"], s["high"], width)}}}
  - {{shape: block, min: {at(s["dam"], 0)}, max: {at(shore, s["low"], width)}}}
obstacles: [{{name: slope, shape: plane, point: {at(s["toe"], 0)}, normal: {at(-s["slope"], 1)}}}]
time: {{step: auto, end: 3.4}}
solver: {{levels: on}}
output: {{every: 0.02}}
"""


def film_speed(t, angle, depth, nu):
    """Mean speed of a film that starts from rest on a slope without slip, m/s."""
    sine = np.sin(np.radians(angle))
    odd = 2 * np.arange(60) + 1
    t = np.asarray(t, float)[..., None]
    left = (96 / (odd * np.pi) ** 4 * np.exp(-(odd * np.pi / 2) ** 2 * nu * t / depth**2)).sum(-1)
    return G * sine * depth**2 / (3 * nu) * (1 - left)


def behind_bore(depth, ratio):
    """Speed of the water and of waves behind a bore of ratio times the depth of still water."""
    speed = (ratio - 1) * np.sqrt(0.5 * G * depth * (ratio + 1) / ratio)
    return speed, np.sqrt(G * ratio * depth)


def solve(f, low, high):
    """The root of a growing f, by halving."""
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if f(middle) < 0 else (low, middle)
    return 0.5 * (low + high)


def shoreline_speed(steps=4000):
    """Speed with which the bore of RUN_UP reaches the shore, by shallow-water theory: that of the
    broken dam (Stoker), and then by Whitham's rule (Keller, Levine & Whitham 1960), by which the
    relation on the characteristic, d(u + 2c) = g dH/(u + c), holds along the bore."""
    s = RUN_UP

    def sum_of(depth, ratio):
        u, c = behind_bore(depth, ratio)
        return u + 2 * c

    ratio = solve(lambda r: sum_of(s["low"], r) - 2 * np.sqrt(G * s["high"]), 1, 100)
    depths = s["low"] * np.exp(-np.linspace(0, np.log(1e9), steps))
    for before, after in zip(depths[:-1], depths[1:]):
        u, c = behind_bore(before, ratio)
        want = u + 2 * c + G * (after - before) / (u + c)
        ratio = solve(lambda r, h=after, w=want: sum_of(h, r) - w, 1, 1e7)
    return behind_bore(depths[-1], ratio)[0]


def sliding():
    """Deceleration along x of a particle that slides up the slope, m/s^2: g sin a cos a. In
    shallow-water theory, which has no vertical acceleration, it is g tan a."""
    a = np.arctan(RUN_UP["slope"])
    return G * np.sin(a) * np.cos(a)


def way(t, speed, area):
    """How far from the shore the place is, before which `area` of water lies, t after the bore has
    reached the shore (Shen & Meyer 1963). The tip moves like a particle; behind it the depth is
    (x - x_tip)^2/(9 g t^2), as behind that of a dam break on dry ground."""
    return speed * t - 0.5 * G * RUN_UP["slope"] * t**2 - np.cbrt(27 * G * t**2 * area)


def max_way(speed, area):
    """The largest of it at any time, m."""
    return way(np.linspace(0, 2 * speed / (G * RUN_UP["slope"]), 2001), speed, area).max()
