"""Time per particle and update against the number of particles, one curve per configuration.

A flat curve means that the time grows in proportion to the particles. Each combination of backend,
threads, precision and (on a CPU) vector instructions has one curve. With one CPU thread it shows CPU
time if the table has it, otherwise wall time. Bars show the spread of the repeats.
"""

from __future__ import annotations

import argparse

import numpy as np

from . import bench, style
from .errors import BadInput
from .table import Table

EXAMPLE = """example:
  pbf bench --backend cpu --threads 1,2 --csv cpu.csv
  python -m pbf_tools plot-time cpu.csv -o time.png"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    bench.add_arguments(parser)
    parser.add_argument("--setup", action="append", metavar="SETUP",
                        help="curves: backend[:threads][:precision] (repeatable; default: all)")
    style.add_output(parser, "time.png")


def us_per_particle(rows: Table) -> np.ndarray:
    """Rows (particles, median, least, greatest), shape (sizes, 4), microseconds, by size.

    >>> rows = {"n_particles": [1000.], "ms_per_step_median": [2.], "ms_min": [1.], "ms_max": [3.]}
    >>> us_per_particle(Table(rows)).tolist()
    [[1000.0, 2.0, 1.0, 3.0]]
    """
    times = bench.times(rows)
    cpu = rows.columns.get("cpu_ms_per_step_median")
    if cpu is not None and "threads" in rows.columns and np.all(rows["threads"] == 1):
        for n, (_, least, greatest) in times.items():
            ours = float(np.median(cpu[rows["n_particles"] == n]))
            if np.isfinite(ours):
                times[n] = (ours, min(least, ours), max(greatest, ours))
    return np.array([[n, *(1e3 * t / n for t in times[n])] for n in sorted(times)])


def name_of(backend: str, threads: float, precision: str, vectors: str) -> str:
    """How a curve is called.

    >>> name_of("cpu", 2.0, "float", "avx2"), name_of("cuda", 0.0, "double", "580.65")
    ('cpu, float, 2 threads, avx2', 'cuda, double')
    """
    text = f"{backend}, {precision}"
    if backend == "cuda":
        return text
    text += f", {threads:g} thread{'' if threads == 1 else 's'}"
    return f"{text}, {vectors}" if vectors else text


def figure(args: argparse.Namespace) -> style.Picture:
    table = bench.read_bench(args.csv, args.state)
    scenes = bench.pick_scenes(table, args.scene)
    vectors = table.columns.get("driver", np.full(len(table), ""))
    wanted = [bench.Setup.parse(s) for s in args.setup or []]
    for setup in wanted:  # says what there is when a setup is not
        if not np.any(setup.mask(table)):
            setup.rows(table)
    chosen = np.any([s.mask(table) for s in wanted], axis=0) if wanted else np.full(len(table), True)
    keys = list(dict.fromkeys((s, b, t, p, "" if b == "cuda" else v) for s, b, t, p, v, c in zip(
        table["scene"], table["backend"], table["threads"], table["precision"], vectors, chosen)
        if c and s in scenes))
    if not keys:
        raise BadInput("no rows to draw for these scenes and setups")
    fig, ((axes,),) = style.figure(size=(8.4, 4.2))
    sizes = []
    for k, (scene, backend, threads, precision, name) in enumerate(keys):
        mask = ((table["scene"] == scene) & (table["backend"] == backend) &
                (table["threads"] == threads) & (table["precision"] == precision))
        if name:
            mask &= vectors == name
        n, time, low, high = us_per_particle(table.where(mask)).T
        label = name_of(backend, threads, precision, name)
        label = label if len(scenes) == 1 else f"{scene}, {label}"
        spread = [time - low, high - time] if np.any(high > low) else None
        axes.errorbar(n, time, yerr=spread, label=label, **style.cycle(k))
        sizes.append(n)
        flat = f"  greatest / least {time.max() / time.min():.2f}" if len(n) > 1 else ""
        fig.tell(f"{label:32} " + "  ".join(f"{style.count_text(a)}: {b:.4g} us"
                                           for a, b in zip(n, time)) + flat, curve=label,
                 least_us=time.min(), greatest_us=time.max())
    axes.set_yscale("log")
    style.plain_log(axes.yaxis)
    style.particle_axis(axes, np.concatenate(sizes))
    axes.set_ylabel("time per particle and update (µs)")
    style.side_legend(axes)
    devices = dict.fromkeys(str(d) for d in table.where(chosen)["device"])
    style.title(axes, args.title or "Time per particle", ", ".join(devices))
    return fig
