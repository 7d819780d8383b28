"""Runs for the commands: files or folders of runs, or the CSV tables that to-csv --log writes."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from .errors import BadInput, note
from .run_file import Run
from .run_path import RUN_FILE, run_path
from .table import Table, need, read_csv

UNFINISHED = {"running": "is under way, or was killed", "stopped": "was stopped early",
              "diverged": "was stopped by the guard"}
RUN_HELP = "run file or run folder"


def read_run(path: str) -> Run:
    """A run; says on stderr when it has not come to its end."""
    run = Run(path)
    if run.status in UNFINISHED:
        reached = f"up to {run.times[-1]:g} s" if len(run.times) else "without a frame"
        note(f"{path}: this run {UNFINISHED[run.status]}; it is shown {reached}")
    return run


@dataclass
class Log:
    """A log to draw: its columns, the name of its scene or table, a title, names of gauges."""

    table: Table
    name: str
    title: str
    gauges: list[str]


def read_log(path: str, columns: list[str]) -> Log:
    """The log of a run, or a CSV table; BadInput without these columns."""
    if path.endswith(".csv"):
        name = Path(path).stem
        log = Log(read_csv(path), name, name, [])
    else:
        run = read_run(path)
        log = Log(run.log, run.name, run.title, list(run.gauges))
        if not len(log.table):
            raise BadInput(f"{path}: this run has not measured anything yet")
    need(log.table, columns, path)
    return log


def labels(paths: list[str], names: list[str]) -> list[str]:
    """What a legend calls runs: the names of their scenes where no two are the same, else what
    tells their files apart.

    >>> labels(["out/1", "out/2"], ["drop", "wave"]), labels(["out/1", "out/2"], ["drop", "drop"])
    (['drop', 'wave'], ['1', '2'])
    """
    return names if len(set(names)) == len(names) else short_names(paths)


def short_names(paths: list[str]) -> list[str]:
    """What tells files of runs apart: their folders or, of files with other names, these; the
    paths where that is the same for two.

    >>> short_names(["out/a/run.vtkhdf", "x/log.csv"])
    ['a', 'log']
    >>> short_names(["x/a/run.vtkhdf", "y/a/run.vtkhdf"])
    ['x/a/run.vtkhdf', 'y/a/run.vtkhdf']
    """
    files = [run_path(path).absolute() for path in paths]
    names = [file.parent.name if file.name == RUN_FILE else file.stem for file in files]
    return paths if len(set(names)) < len(names) else names
