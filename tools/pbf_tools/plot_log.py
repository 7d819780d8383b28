"""Columns of the log of one or several runs over time: loads, energies, compression, front, work.

Columns with the same unit share a panel. A pattern takes several columns: 'load/*/force_x'. Without
a column, the command lists those of the first run. Takes runs, or CSV tables with a column time
(to-csv --log).
"""

from __future__ import annotations

import argparse
import os
import re
from collections.abc import Sequence
from fnmatch import fnmatchcase
from pathlib import Path

import numpy as np

from . import gaps, style
from .errors import BadInput
from .logs import RUN_HELP, labels, read_log
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


def choose(log: Table, patterns: list[str], path: str, gauges: Sequence[str] = ()) -> list[str]:
    """The columns that the patterns take, in the order of the patterns and once each.

    >>> table = Table({"time": [0.], "load/a/force_x": [1.], "load/b/force_x": [2.]})
    >>> choose(table, ["load/*/force_x"], "run")
    ['load/a/force_x', 'load/b/force_x']
    """
    taken: dict[str, None] = {}
    for pattern in patterns:
        found = [name for name in log if fnmatchcase(name, pattern)]
        if not found and pattern in gauges:
            raise BadInput(f"{path}: {pattern} is a gauge, which is not in the log; draw it with "
                           f"plot-gauges {path} --gauge {pattern}")
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


def figure(args: argparse.Namespace) -> style.Picture:
    files, patterns = split(args.words)
    read = [read_log(path, ["time"]) for path in files]
    logs = [log.table for log in read]
    if not patterns:
        raise BadInput(f"{files[0]}: name columns to draw; there are {', '.join(logs[0])}")
    names = choose(logs[0], patterns, files[0], read[0].gauges)
    for path, log in zip(files, logs):
        need(log, names, path)
        gaps.numbers(log, ["time", *names], path)
    runs = labels(files, [log.name for log in read])
    panels: dict[str, list[str]] = {}
    for name in names:
        panels.setdefault(logs[0].units.get(name, ""), []).append(name)
    beside = any(len(here) * len(logs) > MOST_INSIDE for here in panels.values())
    size = (6.4 + (2.2 if beside else 0), 1.4 + 2.6 * len(panels))
    fig, rows = style.figure(len(panels), 1, size, sharex=True)
    said: list[str] | None = None  # what the legend above says
    for (axes,), (unit, here) in zip(rows, panels.items()):
        draw(axes, here, unit, dict(zip(runs, logs)))
        entries = axes.get_legend_handles_labels()[1]
        if len(entries) > 1 and entries != said:
            style.side_legend(axes) if beside else axes.legend()
        said = entries
    rows[-1][0].set_xlabel("time (s)")
    text = ", ".join(names)
    style.title(rows[0][0], args.title or (text if len(text) <= MOST_IN_TITLE else "Log"),
                read[0].title if len(read) == 1 else ", ".join(runs) if len(runs) < 4
                else f"{len(runs)} runs")
    return fig


def run(args: argparse.Namespace) -> int:
    files, patterns = split(args.words)
    if patterns:
        return style.command(figure, args)
    first, *_ = [read_log(path, ["time"]).table for path in files]
    for name in first:
        print(f"{name:28} {first.units.get(name, '')}")
    return 0


def draw(axes, names: list[str], unit: str, logs: dict[str, Table]) -> None:
    """The panel of the columns of a unit, of every run by its name; tells their extremes."""
    k = 0
    for name in names:
        for label, log in logs.items():
            values = np.asarray(log[name], float)
            axes.plot(log["time"], values, color=style.COLORS[k % 8],
                      linestyle=("-", "--", "-.", ":")[k // 8 % 4],
                      label=name if len(logs) == 1 else
                      label if len(names) == 1 else f"{name}, {label}", **gaps.points(values))
            k += 1
            gaps.tell(f"{name}, {label}", values, kind=name)
            if np.isfinite(values).any():
                least, most = np.nanmin(values), np.nanmax(values)
                axes.figure.tell(f"{name}, {label}: {least:.6g} to {most:.6g}"
                                 f"{'' if unit in ('', '1') else ' ' + unit}, at the end "
                                 f"{values[-1]:.6g}", column=name, run=label, unit=unit,
                                 least=least, most=most, end=values[-1])
    axes.set_ylabel(f"{common(names)} ({unit or '1'})".lstrip())
