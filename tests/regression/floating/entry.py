"""Wedges of 45 and 30 degrees deadrise that enter calm water, against the similarity solution.

There is no gravity, as in the solution. The wedge of 45 degrees is a box turned by 45 degrees in two
dimensions, that of 30 degrees a prism from a file in a thin slab.
"""

import numpy as np

from lab import RHO
from wedge import solve

SPEED, WIDTH, DEPTH = 2.0, 2.0, 0.8  # m/s, m
REACH = 0.2                          # depth of the tip at the end, m
GAP = 0.02                           # of the tip over the water at the start, m
# Deadrise, spacing, size of the tank over that above, settings.
CASES = [(45, 0.02, 1, ""), (45, 0.02, 2, ""), (45, 0.01, 1, ""),
         (45, 0.02, 1, "fluid.smoothing_ratio=3"), (30, 0.02, 1, "")]


def prism(path, thick):
    """A wedge of 30 degrees, 0.8 m wide, with its tip at the origin, between -thick and thick along
    y, as OBJ."""
    w, h = 0.4, 0.4 * np.tan(np.radians(30))
    section = [(0, 0), (w, h), (w, h + 0.2), (-w, h + 0.2), (-w, h)]
    n = len(section)
    with open(path, "w") as file:
        for y in (-thick, thick):
            for x, z in section:
                file.write(f"v {x} {y} {z}\n")
        for k in range(1, n - 1):
            file.write(f"f 1 {k + 1} {k + 2}\n")              # seen from -y
            file.write(f"f {n + 1} {n + k + 2} {n + k + 1}\n")
        for k in range(n):
            a, b = k + 1, (k + 1) % n + 1
            file.write(f"f {a} {a + n} {b + n}\nf {a} {b + n} {b}\n")


def scene(lab, deadrise, spacing, size, free, mass):
    """`mass`: of the free wedge, kg per m of width."""
    flat = deadrise == 45
    width, depth = size * WIDTH, size * DEPTH
    step = 0.04 * spacing / SPEED
    thick = 6 * spacing
    if flat:
        edge = 0.4
        shape = (f"shape: box, center: [{width / 2}, {depth + GAP + edge / np.sqrt(2)}], "
                 f"size: [{edge}, {edge}], turn_axis: [0, 1, 0], turn_angle: 45")
    else:
        # A free body has to stay within the walls.
        prism(lab.folder / "prism.obj", 0.4999 * thick if free else thick)
        shape = (f"shape: mesh, path: prism.obj, "
                 f"translate: [{width / 2}, {thick / 2}, {depth + GAP}]")
        mass *= thick
    move = (f"free: {{mass: {mass}, lock: [x{'' if flat else ', y, rx'}, ry{'' if flat else ', rz'}], "
            f"velocity: [0, {'' if flat else '0, '}{-SPEED}]}}" if free else
            f"motion: {{kind: velocity, velocity: [0, 0, {-SPEED}]}}")
    corner = f"{width}, " + ("" if flat else f"{thick}, ")
    low = "0, 0" if flat else "0, 0, 0"
    end = (GAP + REACH) / SPEED * (1.3 if free else 1)
    return f"""
dimensions: {2 if flat else 3}
domain: {{min: [{low}], max: [{corner}{depth + 1}]}}
fluid: {{spacing: {spacing}}}
bodies: [{{shape: block, min: [{low}], max: [{corner}{depth}]}}]
obstacles: [{{name: wedge, {shape}, loads: true, {move}}}]
gravity: [{low}]
time: {{step: {step}, end: {end:.4f}}}
measure_every: 10
"""


def measure(lab):
    solutions = {45: solve(45), 30: solve(30)}
    rows, curves = [], []
    for deadrise, spacing, size, settings in CASES:
        theory = solutions[deadrise]["force"]
        thick = spacing if deadrise == 45 else 6 * spacing
        run = lab.run(scene(lab, deadrise, spacing, size, False, 0), settings)
        t = run.log["time"]
        force = run.log["load/wedge/force_z"] / thick
        deep = SPEED * (t - (t[2] - t[1]) / 2) - GAP   # in the middle of each mean
        share = force[1:] / (RHO * SPEED**2 * np.maximum(deep[1:], 1e-9))
        chosen = (deep[1:] > 0.25 * REACH) & (deep[1:] < 0.95 * REACH)
        # The impulse of F = C rho V^2 s over depths s from s0 to s1 is C rho V (s1^2 - s0^2)/2.
        tip = np.maximum(SPEED * t - GAP, 0)
        impulse = np.concatenate([[0], np.cumsum(force[1:] * np.diff(t))])
        inside = np.flatnonzero((tip > 0.25 * REACH) & (tip < 0.95 * REACH))[[0, -1]]
        mean = np.diff(impulse[inside])[0] / (RHO * SPEED * np.diff(tip[inside]**2)[0] / 2)
        # Momentum is kept: (m + C rho s^2/2) V = m V0 with the added mass of constant speed.
        mass = RHO * REACH**2 * theory / 2
        free = lab.run(scene(lab, deadrise, spacing, size, True, mass), settings)
        name = "pose/wedge/"
        sunk = free.log[name + "z"][0] - free.log[name + "z"] - GAP
        speed = -free.log[name + "velocity_z"] / SPEED
        expected = 1 / (1 + theory * RHO * np.maximum(sunk, 0) ** 2 / (2 * mass))
        half = (sunk > 0.25 * REACH) & (sunk < 0.95 * REACH)
        at = np.interp(0.9 * REACH, sunk, speed), np.interp(0.9 * REACH, sunk, expected)
        rows.append({"deadrise": deadrise, "spacing": spacing, "tank": size * WIDTH, "set": settings,
                     "force": mean, "scatter": share[chosen].std(),
                     "theory": theory, "error": mean / theory - 1,
                     "free_speed": at[0], "free_theory": at[1],
                     "free_error_rms": np.sqrt(np.mean((speed - expected)[half] ** 2))})
        label = f"{deadrise}°, {REACH / spacing:.0f} spacings deep" + (
            ", h = 3 d" if settings else "") + (", wide tank" if size > 1 else "")
        curves.append((label, tip, impulse / (RHO * SPEED * theory * REACH**2 / 2), sunk, speed,
                       expected))
    lab.table("entry", rows)
    axes, save = lab.figure("entry", 2)
    for k, (label, tip, impulse, sunk, speed, expected) in enumerate(curves):
        axes[0].plot(tip / REACH, impulse, f"C{k}", label=label, lw=1)
        wet = (sunk > 0) & (sunk < REACH)
        axes[1].plot(sunk[wet] / REACH, speed[wet], f"C{k}", label=label, lw=1)
    line = np.linspace(0, 1)
    axes[0].plot(line, line**2, "k--", lw=0.8, label="similarity solution")
    axes[1].plot(sunk[wet] / REACH, expected[wet], "k--", lw=0.8, label="momentum")
    axes[0].set(xlabel="depth of the tip / largest", ylabel="impulse / C ρ V s²/2 at the end")
    axes[1].set(xlabel="depth of the tip / largest", ylabel="speed of the free wedge / start")
    axes[0].legend(fontsize=7)
    axes[1].legend(fontsize=7)
    save()
