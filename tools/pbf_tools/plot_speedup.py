"""Speed-up of one backend over another against the number of particles, one curve per scene.

If the benchmark was repeated, bars show the spread from the shortest to the longest time.
"""

from __future__ import annotations

import argparse

import numpy as np

from . import bench, style
from .errors import BadInput
from .table import Table

EXAMPLE = """example (the scenes of the reference implementation, one CPU thread against the GPU):
  python -m pbf_tools plot-speedup tests/regression/bench/reference_speedup_nvidia_h200.csv \\
      --base cpu:1 --target cuda -o speedup.png"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    bench.add_arguments(parser)
    parser.add_argument("--base", default="cpu:1", metavar="SETUP",
                        help="reference (speed-up 1): backend[:threads][:precision] (default %(default)s)")
    parser.add_argument("--target", default="cuda", metavar="SETUP",
                        help="backend to compare with it (default %(default)s)")
    style.add_output(parser, "speedup.png")


def speedups(base: Table, target: Table) -> np.ndarray:
    """Rows (particles, speed-up of the medians, lowest, highest), shape (sizes, 4), by size.

    >>> one = {"n_particles": [1000.], "ms_per_step_median": [8.], "ms_min": [6.], "ms_max": [9.]}
    >>> two = {"n_particles": [1000.], "ms_per_step_median": [2.], "ms_min": [2.], "ms_max": [3.]}
    >>> speedups(Table(one), Table(two)).tolist()
    [[1000.0, 4.0, 2.0, 4.5]]
    """
    a, b = bench.times(base), bench.times(target)
    return np.array([[n, a[n][0] / b[n][0], a[n][1] / b[n][2], a[n][2] / b[n][1]]
                     for n in sorted(a) if n in b]).reshape(-1, 4)


def figure(args: argparse.Namespace) -> style.Picture:
    table = bench.read_bench(args.csv, args.state)
    base, target = bench.Setup.parse(args.base), bench.Setup.parse(args.target)
    bases, targets = base.rows(table), target.rows(table)
    fig, ((axes,),) = style.figure()
    sizes = []
    for k, scene in enumerate(bench.pick_scenes(table, args.scene)):
        points = speedups(bases.where(bases["scene"] == scene),
                          targets.where(targets["scene"] == scene))
        if not len(points):
            raise BadInput(f"scene {scene}: {base} and {target} have no size in common")
        n, ratio, low, high = points.T
        spread = [ratio - low, high - ratio] if np.any(high > low) else None
        axes.errorbar(n, ratio, yerr=spread, label=scene, **style.cycle(k))
        sizes.append(n)
        for row in points:
            fig.tell(f"{scene:12} {row[0]:10.0f} particles  {row[1]:8.4g} x", scene=scene,
                     particles=row[0], ratio=row[1], lowest=row[2], highest=row[3])
    axes.set_yscale("log")
    style.plain_log(axes.yaxis)
    style.particle_axis(axes, np.concatenate(sizes))
    axes.set_ylabel(f"time per update, {base} / {target} (1)")
    axes.legend(title="scene", loc="best")
    style.title(axes, args.title or f"Speed-up of {target} over {base}",
                f"{_device(targets)} against {_device(bases)}, per update")
    return fig


def _device(rows: Table) -> str:
    threads = int(rows["threads"][0])
    on = f", {threads} thread{'s' if threads != 1 else ''}" if threads > 0 else ""
    return f"{rows['device'][0]} ({rows['precision'][0]}{on})"
