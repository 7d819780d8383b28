"""Logs of runs for plots: from run files, or from the CSV tables that to-csv --log writes."""

from __future__ import annotations

from pathlib import Path

from .run_file import Run
from .table import Table, need, read_csv


def read_log(path: str, columns: list[str]) -> tuple[Table, str]:
    """The log of a run file or a CSV table, and a title for it; BadInput without these columns."""
    if path.endswith(".csv"):
        log, name = read_csv(path), Path(path).stem
    else:
        run_file = Run(path)
        log, name = run_file.log, run_file.title
    need(log, columns, path)
    return log, name


def short_names(paths: list[str]) -> list[str]:
    """What tells runs apart in a legend: their folders, or the paths where folders share a name.

    >>> short_names(["out/a/run.vtkhdf", "log.csv"]), short_names(["x/a/run.vtkhdf", "y/a/b.csv"])
    (['a', 'log'], ['x/a/run.vtkhdf', 'y/a/b.csv'])
    """
    names = [Path(p).parent.name or Path(p).stem for p in paths]
    return paths if len(set(names)) < len(names) else names
