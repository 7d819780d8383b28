"""What `rows` reads from finished runs of the scenes of waves in configs/validation."""

import csv
import math
import pathlib
import re
import sys

import numpy as np

ROOT = pathlib.Path(__file__).parents[3]
DATA = ROOT / "configs/validation"
sys.path.insert(0, str(ROOT / "tools"))
import pbf_tools  # noqa: E402
from pbf_tools import waves  # noqa: E402
from pbf_tools.errors import BadInput  # noqa: E402

G = 9.81
COLUMNS = ("scene", "spacing_m", "reading", "quantity", "unit", "run", "data")


def table(name):
    """Columns of a file of configs/validation; empty cells are nan."""
    with open(DATA / name, newline="") as f:
        rows = list(csv.reader(line for line in f if not line.startswith("#")))
    numbers = np.array([[float(x or "nan") for x in row] for row in rows[1:]])
    return {name: numbers[:, k] for k, name in enumerate(rows[0])}


def still(run):
    """Depth at rest (m) of each comparison of a gauge, as its scene says."""
    entry = r"^ +- \{name: (\w+|\"\"), gauge: (\w+), .* offset: ([-\d.e]+),"
    return {gauge if name == '""' else name: float(offset)
            for name, gauge, offset in re.findall(entry, run.scene, re.MULTILINE)}


def compared(run):
    """Of every comparison of the scene: RMS, correlation, lag, and the crest above still water."""
    depth = still(run)
    for name, found in run.compare.items():
        yield name, "rms", "m", found["rms"], ""
        yield name, "rms_relative", "1", found["rms_relative"], ""
        yield name, "correlation", "1", found["correlation"], ""
        yield name, "lag", "s", found["lag_s"], ""
        yield (name, "crest", "m", found["peak"] - depth[name], found["peak_data"] - depth[name])


def regular(run):
    """Height and second harmonic along the flume over two periods, beside theory of second order."""
    height, period, depth = 0.06, 2.0, 0.3
    k = float(waves.wavenumber(period, depth))
    kd = k * depth
    second = height * k / 8 * math.cosh(kd) * (2 + math.cosh(2 * kd)) / math.sinh(kd) ** 3
    names = list(run.gauges)
    found = waves.along([run.gauges[n] for n in names], [int(n[1:]) / 10 for n in names], depth,
                        period, between=(9, 13))
    for name, high, part in zip(names, found.table["height"], found.table["second"]):
        yield name, "height", "m", high, height
        yield name, "second_over_first", "1", part, second
    yield "flume", "wavenumber", "1/m", found.wavenumber, found.theory
    yield "flume", "loss_per_wavelength", "1", found.loss, 0.0


def surface(x, place, d):
    """m, the top of the fluid that is connected from below at x = place; nan where there is none."""
    z = np.sort(x[abs(x[:, 0] - place) < 0.75 * d, 2])
    if not len(z):
        return math.nan
    gaps = np.flatnonzero(np.diff(z) > 3 * d)
    return (z[gaps[0]] if len(gaps) else z[-1]) + d / 2


def profiles(run):
    """T, x/D from the shoreline and eta/D of the run and of the data, at the places that Synolakis
    (1987) has read, in the frames next to his times."""
    depth, toe = 0.15, 4.0
    d = float(run.info["spacing"])
    time, level = run.gauges["crest"]
    passes = time[np.argmax(level)]
    data = table("synolakis_1987_profiles_h300.csv")
    for when in np.unique(data["T"]):
        part = (data["T"] == when) & (data["eta_over_d"] != 0)  # 0 stands for "not read" as well
        frame = int(np.argmin(abs(run.times - passes - when * math.sqrt(depth / G))))
        x = run["position"][frame]
        far = data["x_over_d"][part]
        yield when, far, np.array([surface(x, toe + (19.85 - f) * depth, d) / depth - 1
                                   for f in far]), data["eta_over_d"][part]


def run_up(run):
    """The largest run-up, beside the law that Synolakis (1987) has fitted to waves that break, and
    the surface at the times of his profiles."""
    depth, height = 0.15, 0.045
    found = waves.run_up(run, "beach", level=depth)
    yield ("beach", "run_up_over_depth", "1", found.highest / depth,
           1.109 * (height / depth) ** 0.582)
    for when, _, eta, data in profiles(run):
        name, there = f"T{when:g}", np.isfinite(eta)
        yield (name, "profile_rms_over_depth", "1", np.sqrt(np.mean((eta - data)[there] ** 2)), "")
        yield name, "profile_highest_over_depth", "1", eta[there].max(), data.max()
        yield name, "profile_share_wet", "1", there.mean(), 1.0


def harmonics(time, level, period, number=4):
    """m, amplitudes of the first harmonics by least squares, which the few readings of a digitised
    figure allow too."""
    turns = 2 * np.pi * np.outer(np.asarray(time) / period, np.arange(1, number + 1))
    found = np.linalg.lstsq(np.hstack([np.ones((len(turns), 1)), np.cos(turns), np.sin(turns)]),
                            level, rcond=None)[0][1:]
    return np.hypot(found[:number], found[number:])


def bar(run):
    """Three harmonics at the gauges, in the three periods that were measured."""
    data, period = table("beji_battjes_1993_bar.csv"), 2.02
    for name, gauge in run.gauges.items():
        part = np.isfinite(data[f"{name}_m"])
        measured = harmonics(data[f"{name}_t_s"][part], data[f"{name}_m"][part], period)
        window = (gauge.time > 33) & (gauge.time <= 33 + 3 * period)
        for k, ours in enumerate(harmonics(gauge.time[window], gauge.value[window], period)[:3]):
            yield name, f"harmonic_{k + 1}", "m", ours, measured[k]


KINDS = {"x76": regular, "crest": run_up, "G11": bar, "G10": lambda run: ()}


def rows(path):
    """Rows of COLUMNS of a run of one of the scenes."""
    run = pbf_tools.open(str(path))
    kind = next((k for name, k in KINDS.items() if name in run.gauges), None)
    if kind is None or not run.compare:
        raise BadInput(f"{path} is no finished run of a scene of waves in configs/validation")
    for reading, quantity, unit, value, data in [*compared(run), *kind(run)]:
        yield [run.name, f"{run.info['spacing']:.6g}", reading, quantity, unit, f"{value:.4g}",
               f"{data:.4g}" if data != "" else ""]


def readings(path, folder):
    """Writes NAME_gauges.csv, the gauges of a run to 0.1 mm, and of a run-up NAME_profiles.csv."""
    run = pbf_tools.open(str(path))
    time = next(iter(run.gauges.values())).time
    np.savetxt(folder / f"{path.name}_gauges.csv",
               np.column_stack([time, *(g.value for g in run.gauges.values())]), "%.4f", ",",
               header=",".join(["t_s", *(f"{name}_m" for name in run.gauges)]), comments="")
    if "crest" in run.gauges:
        np.savetxt(folder / f"{path.name}_profiles.csv",
                   np.vstack([np.column_stack([np.full(len(far), when), far, eta, data])
                              for when, far, eta, data in profiles(run)]), "%.4f", ",",
                   header="T,x_over_d,run_eta_over_d,eta_over_d", comments="")
