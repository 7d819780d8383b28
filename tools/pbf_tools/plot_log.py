"""Columns of the log of one or several runs over time: loads, energies, compression, front, work.

Columns with the same unit share a panel. A pattern takes several columns: 'load/*/force_x'. Without
a column, the command lists those of the first run. Takes runs, or CSV tables with a column time
(to-csv --log).
"""

from __future__ import annotations

import argparse
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
    fig, rows = style.figure(len(units), 1, (6.4, 1.4 + 2.6 * len(units)))
    labels = short_names(files)
    for (axes,), unit in zip(rows, units):
        here, k = [n for n in names if logs[0].units.get(n, "") == unit], 0
        for name in here:
            for log, label in zip(logs, labels):
                values = np.asarray(log[name], float)
                axes.plot(log["time"], values, color=style.COLORS[k % 8],
                          linestyle=("-", "--", "-.", ":")[k // 8 % 4],
                          label=name if len(logs) == 1 else f"{name}, {label}")
                k += 1
                if np.isfinite(values).any():
                    print(f"{name}, {label}: {np.nanmin(values):.6g} to {np.nanmax(values):.6g}"
                          f"{'' if unit in ('', '1') else ' ' + unit}, at the end {values[-1]:.6g}")
        axes.set_ylabel(f"{here[0]} ({unit or '1'})" if len(here) == 1 else unit or "1")
        if k > 1:
            axes.legend()
    rows[-1][0].set_xlabel("time (s)")
    style.title(rows[0][0], args.title or (names[0] if len(names) == 1 else "Log"),
                ", ".join(labels) if len(labels) < 4 else "")
    style.save(fig, args)
    return 0
