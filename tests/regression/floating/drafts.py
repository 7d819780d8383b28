"""Drafts of bodies at rest against Archimedes."""

import numpy as np

EDGE, TANK, DEPTH = 0.2, 0.8, 0.3  # of the box, of the tank, of the water, m
DENSITIES = (50, 100, 200, 300, 500, 700, 800)
FROM = (-0.02, 0.02)               # starts beside the draft of theory, m


def scene(shape, spacing, density, off):
    flat = shape == "box 2-D"
    draft = EDGE * density / 1000     # of half a ball, too
    middle = DEPTH - draft + EDGE / 2 + off
    corner, point = (f"{TANK}", f"{TANK / 2}") if flat else (f"0.6, 0.6", "0.3, 0.3")
    place = f"center: [{point}, {middle}]"
    body = f"shape: sphere, {place}, radius: {EDGE / 2}" if shape == "ball" else (
        f"shape: box, {place}, size: [{EDGE}, {EDGE}{'' if flat else f', {EDGE}'}]")
    lock = "[x, ry]" if flat else "[x, y, rx, ry, rz]"
    low, at = ("0, 0", "0.1") if flat else ("0, 0, 0", "0.08, 0.08")
    return f"""
dimensions: {2 if flat else 3}
domain: {{min: [{low}], max: [{corner}, {DEPTH + 0.3}]}}
fluid: {{spacing: {spacing}}}
bodies: [{{shape: block, min: [{low}], max: [{corner}, {DEPTH}]}}]
obstacles: [{{name: body, {body}, free: {{density: {density}, lock: {lock}}}}}]
gauges: [{{name: level, kind: level, at: [{at}]}}]
solver: {{velocity_damping: {0.99 if flat else 0.98}}}
time: {{step: {0.1 * spacing}, end: {4 if flat else 2.4}}}
measure_every: 20
"""


def immersed(shape, draft):
    """Volume under water, m^3, in two dimensions m^2."""
    if shape == "ball":
        return np.pi * draft**2 * (1.5 * EDGE - draft) / 3
    return EDGE ** (1 if shape == "box 2-D" else 2) * draft


def measure(lab):
    rows = []
    cases = [("box 2-D", d, rho) for d in (0.02, 0.01) for rho in DENSITIES]
    cases += [("box 3-D", 0.02, 500), ("ball", 0.02, 500)]
    for shape, spacing, density in cases:
        flat = shape == "box 2-D"
        found, by_gauge, rest = [], [], []
        for off in FROM if flat else FROM[:1]:
            run = lab.run(scene(shape, spacing, density, off))
            late = run.log["time"] > 0.75 * run.log["time"][-1]
            bottom = run.log["pose/body/z"][late].mean() - EDGE / 2
            water = len(run["position"][-1]) * spacing ** (2 if flat else 3)
            low, high = 0.0, EDGE       # the draft at which level - bottom = draft
            for _ in range(50):
                draft = (low + high) / 2
                level = (water + immersed(shape, draft)) / (TANK if flat else 0.36)
                low, high = (draft, high) if level - bottom > draft else (low, draft)
            found.append(draft)
            t, v = run.gauges["level"]
            by_gauge.append(v[t > 0.75 * t[-1]].mean() - bottom)
            rest.append(np.abs(run.log["pose/body/velocity_z"][late]).max())
        rows.append({"body": shape, "edge_in_spacings": round(EDGE / spacing), "density": density,
                     "theory": EDGE * density / 1000, "draft": np.mean(found),
                     "error": np.mean(found) / (EDGE * density / 1000) - 1,
                     "error_in_spacings": (np.mean(found) - EDGE * density / 1000) / spacing,
                     "between_starts": max(found) - min(found) if flat else "",
                     "draft_by_gauge": np.mean(by_gauge), "speed_max": max(rest)})
    lab.table("drafts", rows)
    axes, save = lab.figure("drafts", 1)
    axes[0].plot([0, 1], [0, 1], "k", label="density")
    for n, mark in ((10, "o"), (20, "x")):
        chosen = [r for r in rows if r["body"] == "box 2-D" and r["edge_in_spacings"] == n]
        axes[0].plot([r["density"] / 1000 for r in chosen], [r["draft"] / EDGE for r in chosen],
                     mark, label=f"box, {n} spacings")
    axes[0].set(xlabel="density / density of water", ylabel="draft / height")
    axes[0].legend(fontsize=8)
    save()
