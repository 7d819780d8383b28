"""Columns of the log of one or several runs over time: loads, energies, compression, front, work.

Columns with the same unit share a panel. A pattern takes several columns: 'load/*/force_x'. Without
a column, the command lists those of the first run. Takes runs, or CSV tables with a column time
(to-csv --log).
"""

from __future__ import annotations

import argparse
import os
import re
from fnmatch import fnmatchcase
from pathlib import Path

import numpy as np

from . import style
from .errors import BadInput
from .logs import RUN_HELP, read_log, short_names
from .run_path import is_run
from .table import Table, need

EXAMPLE = """examples:
  python -m pbf_tools plot-log out/demo
  python -m pbf_tools plot-log out/demo load/post/force_x compression_mean -o demo.png
  python -m pbf_tools plot-log out/a out/b front_x -o fronts.png"""

MOST_INSIDE = 6  # entries of a legend; a longer one is put beside the panel
MOST_IN_TITLE = 60  # characters


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("words", nargs="+", metavar="RUN... COLUMN...",
                        help=f"{RUN_HELP}, or CSV table (several), then columns of the log or "
                             "patterns of them")
    style.add_output(parser, "log.png")


def split(words: list[str]) -> tuple[list[str], list[str]]:
    """Runs and columns: what names a file or folder that is there, or ends like a file, is a run.

    >>> split(["a/run.vtkhdf", "b.csv", ".", "load/*/force_x", "front_x"])
    (['a/run.vtkhdf', 'b.csv', '.'], ['load/*/force_x', 'front_x'])
    """
    files = [w for w in words if is_run(w) or w.endswith(".csv") or Path(w).is_file()]
    if not files:
        raise BadInput(f"{words[0]}: no such run or table; name one before the columns")
    return files, [w for w in words if w not in files]


def choose(log: Table, patterns: list[str], path: str) -> list[str]:
    """The columns that the patterns take, in the order of the patterns and once each.

    >>> table = Table({"time": [0.], "load/a/force_x": [1.], "load/b/force_x": [2.]})
    >>> choose(table, ["load/*/force_x"], "run")
    ['load/a/force_x', 'load/b/force_x']
    """
    taken: dict[str, None] = {}
    for pattern in patterns:
        found = [name for name in log if fnmatchcase(name, pattern)]
        if not found:
            need(log, [pattern], path)
        taken.update(dict.fromkeys(found))
    return list(taken)


def common(names: list[str]) -> str:
    """The words with which the names of columns begin, for the axis of a panel.

    >>> common(["load/post/force_x", "load/post/force_peak"]), common(["stage/grid", "stage/guard"])
    ('load/post/force', 'stage')
    >>> common(["energy", "energy_rise"]), common(["front_x"]), common(["time", "front_x"])
    ('energy', 'front_x', '')
    """
    words = [re.split("([_/])", name) for name in names]
    same = os.path.commonprefix(words)
    return "".join(same).rstrip("_/")


def run(args: argparse.Namespace) -> int:
    files, patterns = split(args.words)
    logs = [read_log(path, ["time"])[0] for path in files]
    if not patterns:
        for name in logs[0]:
            print(f"{name:28} {logs[0].units.get(name, '')}")
        return 0
    names = choose(logs[0], patterns, files[0])
    for path, log in zip(files[1:], logs[1:]):
        need(log, names, path)
    units = list(dict.fromkeys(logs[0].units.get(name, "") for name in names))
    labels, panels = short_names(files), {unit: [] for unit in units}
    for name in names:
        panels[logs[0].units.get(name, "")].append(name)
    beside = any(len(here) * len(logs) > MOST_INSIDE for here in panels.values())
    size = (6.4 + (2.2 if beside else 0), 1.4 + 2.6 * len(units))
    fig, rows = style.figure(len(units), 1, size, sharex=True)
    said: list[str] | None = None  # what the legend above says
    for (axes,), (unit, here) in zip(rows, panels.items()):
        k = 0
        for name in here:
            for log, label in zip(logs, labels):
                values = np.asarray(log[name], float)
                axes.plot(log["time"], values, color=style.COLORS[k % 8],
                          linestyle=("-", "--", "-.", ":")[k // 8 % 4],
                          label=name if len(logs) == 1 else
                          label if len(here) == 1 else f"{name}, {label}")
                k += 1
                if np.isfinite(values).any():
                    print(f"{name}, {label}: {np.nanmin(values):.6g} to {np.nanmax(values):.6g}"
                          f"{'' if unit in ('', '1') else ' ' + unit}, at the end {values[-1]:.6g}")
        axes.set_ylabel(f"{common(here)} ({unit or '1'})".lstrip())
        entries = axes.get_legend_handles_labels()[1]
        if k > 1 and entries != said:
            style.side_legend(axes) if beside else axes.legend()
        said = entries
    rows[-1][0].set_xlabel("time (s)")
    text = ", ".join(names)
    style.title(rows[0][0], args.title or (text if len(text) <= MOST_IN_TITLE else "Log"),
                ", ".join(labels) if len(labels) < 4 else f"{len(labels)} runs")
    style.save(fig, args)
    return 0
