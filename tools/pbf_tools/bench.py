"""The table that `pbf bench --csv` writes: choosing rows, names for them, pairs of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .errors import BadInput, UnknownName, unknown
from .table import Table, need, read_csvs

TIME = "ms_per_step_median"
COLUMNS = ["scene", "backend", "device", "precision", "threads", "n_particles", "state", TIME,
           "ms_min", "ms_max"]


def read_bench(paths: list[str], state: str) -> Table:
    """Rows of one state ("start" or "late"); "auto" takes late where there is one, else start."""
    table = read_csvs(paths)
    what = ", ".join(paths)
    need(table, COLUMNS, what)
    if state == "auto":
        state = "late" if np.any(table["state"] == "late") else "start"
    rows = table.where(table["state"] == state)
    if not len(rows):
        raise BadInput(f"{what}: no rows of state {state}")
    return rows


def add_arguments(parser, metavar: str = "CSV", runs: str = "") -> None:
    """Which tables, and which rows of them; `runs` where a command takes these instead."""
    parser.add_argument("csv", nargs="+", metavar=metavar,
                        help="tables written by pbf bench --csv" + runs)
    parser.add_argument("--state", default="auto", choices=("auto", "start", "late"),
                        help="updates to take: from the start on, after the warm-up; auto: late "
                             "where there is one")
    parser.add_argument("--scene", action="append", metavar="NAME",
                        help="scenes to draw (repeatable; default: all)")


def pick_scenes(table: Table, wanted: list[str] | None) -> list[str]:
    """The scenes asked for, in that order; all of the table when none is."""
    there = list(dict.fromkeys(table["scene"].tolist()))
    for name in wanted or []:
        if name not in there:
            raise UnknownName(unknown("scene", name, there))
    return wanted or there


@dataclass(frozen=True)
class Setup:
    """One way of running: `cpu:1` is the CPU with 1 thread, `cuda:double` a GPU in double.

    >>> Setup.parse("cpu:1:float"), str(Setup.parse("cuda"))
    (Setup(backend='cpu', threads=1, precision='float'), 'cuda')
    """

    backend: str
    threads: int | None = None
    precision: str | None = None

    @staticmethod
    def parse(text: str) -> Setup:
        backend, *rest = text.split(":")
        threads = precision = None
        for part in rest:
            if part.isdigit():
                threads = int(part)
            elif part in ("float", "double"):
                precision = part
            else:
                raise BadInput(f"{text}: write backend, backend:threads or backend:precision, "
                               "for example cpu:1 or cuda:float")
        return Setup(backend, threads, precision)

    def __str__(self) -> str:
        parts = [self.backend, self.precision,
                 None if self.threads is None else
                 f"{self.threads} thread{'s' if self.threads != 1 else ''}"]
        return ", ".join(p for p in parts if p)

    def mask(self, table: Table) -> np.ndarray:
        """Which rows are of this setup, one bool per row."""
        mask = table["backend"] == self.backend
        for name, value in (("threads", self.threads), ("precision", self.precision)):
            if value is not None:
                mask &= table[name] == value
        return mask

    def rows(self, table: Table) -> Table:
        """The rows of this setup. BadInput when none fits, or when what is left open is not one."""
        rows = table.where(self.mask(table))
        if not len(rows):
            there = sorted({f"{b}:{t:g}:{p}" for b, t, p in
                            zip(table["backend"], table["threads"], table["precision"])})
            raise BadInput(f"no rows for {self} in the tables; there are {', '.join(there)}")
        for name in ("threads", "precision", "device"):
            values = sorted({f"{v:g}" if name == "threads" else str(v) for v in rows[name]})
            if len(values) > 1:
                raise BadInput(f"{self}: the tables hold several kinds of {name} "
                               f"({', '.join(values)}); choose one, for example {self.backend}:"
                               f"{values[0]}" if name != "device" else
                               f"{self}: the tables hold several devices ({', '.join(values)}); "
                               "give the tables of one")
        return rows


def times(rows: Table) -> dict[int, tuple[float, float, float]]:
    """Particles -> (median, least, greatest) ms per update; repeated rows are merged."""
    out = {}
    for n in np.unique(rows["n_particles"]):
        mask = rows["n_particles"] == n
        out[int(n)] = (float(np.median(rows[TIME][mask])), float(rows["ms_min"][mask].min()),
                       float(rows["ms_max"][mask].max()))
    return out
