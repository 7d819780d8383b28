"""Differences of two runs: particle distances in every common frame, and measures over time.

Two frames match when their times agree to a thousandth of the interval between frames; particles
match by id. Distances are in smoothing lengths h of the first run. In chaotic flow, single particles
of two correct runs move apart, so judge long runs by the measures.
"""

from __future__ import annotations

import argparse

import numpy as np

from . import style
from .errors import BadInput
from .logs import RUN_HELP, read_run
from .run_file import Run
from .table import Table, write_text

EXAMPLE = """examples:
  python -m pbf_tools compare out/float out/double
  python -m pbf_tools compare out/a out/b --max-rms 0.01 --csv diff.csv --out diff.png"""
MEASURES = ("compression_mean", "kinetic_energy", "potential_energy")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("a", metavar="A", help=RUN_HELP)
    parser.add_argument("b", metavar="B", help=RUN_HELP)
    parser.add_argument("--max-rms", type=float, metavar="H",
                        help="exit 6 when the RMS distance of a frame exceeds this many h, when one run "
                             "lacks frames or particles of the other, or ended otherwise")
    parser.add_argument("--csv", metavar="FILE", help="write the table to this file")
    style.add_output(parser, "")


def matching(a: np.ndarray, b: np.ndarray) -> list[tuple[int, int]]:
    """Pairs of frames at the same time.

    >>> matching(np.array([0., .1, .2]), np.array([0., .2]))
    [(0, 0), (2, 1)]
    """
    if not len(a) or not len(b):
        return []
    steps = np.concatenate([np.diff(a), np.diff(b)])
    tolerance = 1e-3 * steps.min() if len(steps) else 1e-9
    nearest = np.abs(a[:, None] - b[None, :]).argmin(axis=1)
    return [(i, int(j)) for i, j in enumerate(nearest) if abs(a[i] - b[j]) <= tolerance]


def distances(a: Run, b: Run) -> Table:
    """One row per common frame: time (s), common particles, particles that only one run has,
    mean, rms and max distance (h), distance of the centres of mass (h); 0 where there is no common
    particle."""
    h = float(a.info["smoothing_length"])
    rows = []
    for i, j in matching(a.times, b.times):
        fa, fb = a.frames[i], b.frames[j]
        common, ia, ib = np.intersect1d(fa["id"], fb["id"], return_indices=True)
        n = len(common)
        apart = (fb["position"][ib].astype(float) - fa["position"][ia]) / h if n else np.zeros((1, 3))
        off = np.linalg.norm(apart, axis=1)
        rows.append((fa.time, n, fa.count + fb.count - 2 * n, off.mean(), np.sqrt(np.mean(off**2)),
                     off.max(), float(np.linalg.norm(apart.mean(axis=0)))))
    if not rows:
        raise BadInput(f"{a.path} and {b.path} have no frame at the same time")
    if not any(row[1] for row in rows):
        raise BadInput(f"{a.path} and {b.path} have no particle in common at any time")
    names = ("time", "particles", "unmatched", "mean", "rms", "max", "centers")
    units = dict(zip(names, ("s", "1", "1", "h", "h", "h", "h")))
    return Table({n: np.array(v) for n, v in zip(names, zip(*rows))}, units)


def one_sided(a: Run, b: Run, table: Table) -> list[str]:
    """What one run holds and the other does not, in sentences."""
    found = []
    if a.status != b.status:
        found.append(f"A is {a.status}, B is {b.status}")
    if len(table) < max(len(a.times), len(b.times)):
        found.append(f"frames at a time of both: {len(table)}, of {len(a.times)} in A and "
                     f"{len(b.times)} in B")
    if np.any(table["unmatched"] > 0):
        found.append(f"{table['unmatched'].max()} particles at most are in one run only")
    return found


def run(args: argparse.Namespace) -> int:
    a, b = read_run(args.a), read_run(args.b)
    table = distances(a, b)
    print(f"A {a.title}\nB {b.title}\ndistances in h = {a.info['smoothing_length']:g} m")
    print(f"{'time s':>10} {'particles':>10} {'mean':>10} {'rms':>10} {'max':>10} {'centres':>10}")
    every = max(1, len(table) // 20)
    for k in sorted({*range(0, len(table), every), len(table) - 1}):
        print(f"{table['time'][k]:10.4g} {table['particles'][k]:10d} " + " ".join(
            f"{table[c][k]:10.3g}" for c in ("mean", "rms", "max", "centers")))
    missing = one_sided(a, b, table)
    for line in missing:
        print(line)
    for name in MEASURES:
        la, lb = a.log, b.log
        if len(la) and len(lb):
            t = la["time"][la["time"] <= lb["time"][-1]]
            va, vb = la[name][:len(t)], np.interp(t, lb["time"], lb[name])
            print(f"{name:18} A {va[-1]:.6g}, B {vb[-1]:.6g} at {t[-1]:g} s; largest difference "
                  f"{np.abs(va - vb).max():.3g} {la.units[name].replace('1', '')}".rstrip())
    if args.csv:
        write_text(args.csv, table.csv())
    if args.out:
        _draw(a, b, table, args)
    if args.max_rms is not None and not table["rms"].max() <= args.max_rms:
        k = int(np.argmax(~(table["rms"] <= args.max_rms)))
        print(f"different: RMS distance {table['rms'][k]:.3g} h at {table['time'][k]:g} s is above "
              f"{args.max_rms:g} h")
        return 6
    if args.max_rms is not None and missing:
        print("different: " + "; ".join(missing))
        return 6
    return 0


@style.look()
def _draw(a: Run, b: Run, table: Table, args: argparse.Namespace) -> None:
    fig, panels = style.figure(3, 1, size=(6.4, 7.2), sharex=True)
    distance, compression, energy = panels[:, 0]
    for k, name in enumerate(("max", "rms", "mean")):
        shown = table[name] > 0
        distance.plot(table["time"][shown], table[name][shown], label=name, **style.cycle(k))
    if any(np.any(table[name] > 0) for name in ("max", "rms", "mean")):
        distance.set_yscale("log")
    distance.set_ylabel("distance (h)")
    for k, (run_file, label) in enumerate(((a, "A"), (b, "B"))):
        log, look = run_file.log, {"color": style.COLORS[k], "linestyle": ("-", "--")[k]}
        compression.plot(log["time"], 100 * log["compression_mean"], label=label, **look)
        energy.plot(log["time"], log["kinetic_energy"] + log["potential_energy"], label=label,
                    **look)
    compression.set_ylabel("mean compression (%)")
    energy.set(ylabel="total energy (J)", xlabel="time (s)")
    for axes in panels[:, 0]:
        axes.legend()
    style.title(distance, args.title or "Two runs compared", f"A: {a.title}\nB: {b.title}")
    style.save(fig, args)
