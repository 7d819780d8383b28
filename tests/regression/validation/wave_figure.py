"""Draws the readings of waves in this folder beside theory and data, to waves_beside_data.png.

Usage: python3 tests/regression/validation/wave_figure.py [FILE]
"""

import csv
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

HERE = pathlib.Path(__file__).parent
DATA = HERE.parents[2] / "configs/validation"
BED = {"G4": 0.218, "G6": 0.176868, "G8": 0.126003, "G10": 0.080049}  # m, depths at rest
OVER_BAR = {"G4": 0.175, "G6": 0.1, "G8": 0.27, "G10": 0.4}


def table(path):
    """Columns of a CSV by name; empty cells are nan."""
    with open(path, newline="") as f:
        rows = list(csv.reader(line for line in f if not line.startswith("#")))
    numbers = np.array([[float(x or "nan") for x in row] for row in rows[1:]])
    return {name: numbers[:, k] for k, name in enumerate(rows[0])}


def ours(name):
    return table(HERE / f"{name}_5mm_nvidia_h200.csv")


def lag(scene):
    """s, by which the run is late at gauge 4."""
    with open(HERE / "waves_nvidia_h200.csv", newline="") as f:
        return next(float(r["run"]) for r in csv.DictReader(f) if r["scene"] == scene and
                    r["reading"] == "G4" and r["quantity"] == "lag" and
                    4.9 < 1000 * float(r["spacing_m"]) < 5.1)


def regular(axes):
    second, first = ours("regular_waves"), ours("regular_waves_order_1")
    theory = table(DATA / "regular_waves_theory.csv")
    for ax, name in zip(axes, ("x10", "x30", "x50", "x76")):
        ax.plot(theory["t_s"], 1000 * theory[f"{name}_m"], "k", lw=1.2, label="theory")
        ax.plot(first["t_s"], 1000 * (first[f"{name}_m"] - 0.3), ":", color="tab:orange",
                label="order 1")
        ax.plot(second["t_s"], 1000 * (second[f"{name}_m"] - 0.3), color="tab:blue", lw=1,
                label="order 2")
        ax.set(title=f"regular waves, x = {int(name[1:]) / 10:g} m", xlim=(9, 13), ylim=(-32, 52),
               xlabel="t, s")
    axes[0].set_ylabel("surface, mm")


def profiles(axes):
    found = ours("solitary_run_up_profiles")
    for ax, when in zip(axes, (15, 20, 25, 30)):
        part = found["T"] == when
        x = 19.85 - found["x_over_d"][part]
        ax.plot(x, found["eta_over_d"][part], "k.", ms=3, label="experiment")
        ax.plot(x, found["run_eta_over_d"][part], color="tab:blue", lw=1, label="pbf")
        ax.plot([0, 32], [-1, 32 / 19.85 - 1], color="0.6", lw=1)
        ax.set(title=f"run-up, T = {when}", xlim=(8, 32), ylim=(-0.1, 0.55),
               xlabel="x/D from the toe")
    axes[0].set_ylabel("surface over D")


def gauges(axes, scene, data, time, depth, window, title):
    run, late = ours(scene), lag(scene)
    for ax, (name, still) in zip(axes, depth.items()):
        ax.plot(data[time.format(name)], 1000 * data[f"{name}_m"], "k.-", ms=3, lw=0.8,
                label="experiment")
        ax.plot(run["t_s"] - late, 1000 * (run[f"{name}_m"] - still), color="tab:blue", lw=1,
                label="pbf, less the lag")
        ax.set(title=f"{title}, {name}", xlim=window, xlabel="t, s")
    axes[0].set_ylabel("surface, mm")


def draw(path):
    fig, axes = plt.subplots(4, 4, figsize=(13, 10.5))
    regular(axes[0])
    profiles(axes[1])
    gauges(axes[2], "solitary_wall", table(DATA / "briggs_1996_wall_gauges_B.csv"), "t_s", BED,
           (9, 20), "wall")
    gauges(axes[3], "waves_over_bar", table(DATA / "beji_battjes_1993_bar.csv"), "{}_t_s", OVER_BAR,
           (33, 39), "bar")
    for row in axes:
        low, high = row[0].get_ylim()
        row[0].set_ylim(low, high + 0.3 * (high - low))  # above the curves there is the legend
        row[0].legend(fontsize=7, loc="upper right")
        for ax in row:
            ax.title.set_fontsize(9)
            ax.tick_params(labelsize=8)
    fig.tight_layout()
    fig.savefig(path, dpi=100)


if __name__ == "__main__":
    draw(sys.argv[1] if len(sys.argv) > 1 else HERE / "waves_beside_data.png")
