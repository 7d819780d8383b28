"""Measured values for gauges: which columns of CSV tables belong to which, and what the program says of
a run beside them (`pbf compare-data`)."""

from __future__ import annotations

import argparse
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from . import gaps, units
from .comparison import compare_data
from .errors import BadInput, PbfError, UnknownName, unknown
from .gauges import Gauge
from .run_file import Run
from .table import Table, need, read_csv

SECONDS = ("t", "time", "Time")  # columns of times that need no unit in their names


@dataclass(frozen=True)
class Measured:
    """A column for a gauge, times in s and values in the gauge's unit, shape (rows,), nan where the
    unit is none of theirs, which the program refuses; `component` of a velocity, 0 to 2. `options`:
    with which the program reads the same."""

    path: str
    column: str
    time: np.ndarray
    value: np.ndarray
    component: int | None
    options: Mapping[str, Any]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--experiment", action="append", default=[], metavar="FILE",
                        help="CSV table of measured values, or of another run (to-csv --gauges) "
                             "(repeatable)")
    parser.add_argument("--column", action="append", default=[], metavar="[GAUGE=]NAME",
                        help="column of a table that belongs to a gauge (repeatable; with one "
                             "gauge drawn its name may be left out)")
    parser.add_argument("--component", choices="xyz",
                        help="of a velocity that a column has (default: as its name says, U_x_m_s)")
    parser.add_argument("--time-column", metavar="NAME",
                        help="time column of the tables (default: the first named t, time ..., else "
                             "the first)")
    parser.add_argument("--time-scale", type=float, metavar="F",
                        help="seconds of one unit of that column (default: as its name says, t_ms; "
                             "1 for t and time)")
    parser.add_argument("--lag", "--shift", default="0", metavar="S",
                        help="by how much runs are late (s): added to the measured times. fit: the "
                             "shift of largest correlation within --lag-range; the picture has that "
                             "of the first run (default 0)")
    parser.add_argument("--lag-range", metavar="A,B", help="least and largest shift of fit (s)")
    parser.add_argument("--average", metavar="S",
                        help="compare means over windows of this length (s)")
    parser.add_argument("--between", metavar="A,B", help="compare at these measured times (s)")
    parser.add_argument("--scale", type=float, metavar="F",
                        help="multiply measured values (default: as the column's name says, P1_kPa; "
                             "1 without a unit)")
    parser.add_argument("--offset", type=float, default=0, metavar="F",
                        help="add this to the measured values then, in the gauge's unit (default 0)")


def of_gauges(args: argparse.Namespace, gauges: list[Gauge]) -> dict[str, list[Measured]]:
    """The measured columns of each gauge, by its name."""
    names = [g.name for g in gauges]
    wanted = _assigned(args.column, names)
    tables = [(path, read_csv(path)) for path in args.experiment]
    out: dict[str, list[Measured]] = {name: [] for name in names}
    for gauge in gauges:
        for column in wanted.get(gauge.name, ()):
            if not any(column in table for _, table in tables):
                raise BadInput(f"no column {column} in {', '.join(args.experiment) or 'any table'}"
                               + ("" if tables else "; give --experiment FILE"))
        for path, table in tables:
            own = wanted[gauge.name] if gauge.name in wanted else \
                _named_like(gauge, names, table, args)
            out[gauge.name] += [_read(args, gauge, path, table, column) for column in own
                                if column in table]
    if tables and not any(out.values()):
        raise BadInput(f"{', '.join(args.experiment)}: no column is named as a gauge "
                       f"({', '.join(names)}); give --column GAUGE=NAME, of "
                       f"{', '.join(c for _, table in tables for c in table)}")
    return out


def _assigned(texts: list[str], names: list[str]) -> dict[str, list[str]]:
    """Of each gauge that --column names: its columns."""
    wanted: dict[str, list[str]] = {}
    for text in texts:
        gauge, equals, column = text.partition("=")
        if not equals:
            if len(names) > 1 and text not in names:
                raise BadInput(f"--column {text}: {len(names)} gauges are drawn; say to which it "
                               f"belongs, --column {names[0]}={text}")
            gauge, column = (text if text in names else names[0]), text
        if gauge not in names:
            raise UnknownName(f"--column {text}: {unknown('drawn gauge', gauge, names)}")
        wanted.setdefault(gauge, []).append(column)
    return wanted


def _named_like(gauge: Gauge, names: list[str], table: Table,
                args: argparse.Namespace) -> list[str]:
    """The columns that have the name of a gauge, of a velocity with the component, but for a unit;
    of another quantity only where there is none of its own."""
    like = {gauge.name}
    if gauge.value.ndim == 2:
        like = {f"{gauge.name}_{c}" for c in args.component or "xyz"}
        like |= {gauge.name} if args.component else set()
    found = [c for c in table if c in like or units.split(c)[0] in like
             and (units.split(c)[0] == gauge.name or units.split(c)[0] not in names)]
    found = [c for c in found if _factor(gauge, table, c) is not None] or found
    empty = [c for c in found if table[c].dtype.kind == "f" and np.isnan(table[c]).all()]
    for column in empty:  # a velocity of a run, say, that had no fluid at this gauge
        gaps.tell(f"{gauge.name}, measured ({column})", table[column])
    return [c for c in found if c not in empty]


def _factor(gauge: Gauge, table: Table, column: str) -> float | None:
    unit = unit_of(table, column, gauge.name)
    return units.factor(unit, gauge.unit) if unit else 1.0


def unit_of(table: Table, column: str, name: str = "") -> str:
    """The unit that the head of a table or the name of a column says; a gauge's name says none."""
    said = table.units.get(column, "1")
    return said if said != "1" else "" if column == name else units.split(column)[1]


def time_column(table: Table, wanted: str | None, path: str) -> str:
    if wanted:
        need(table, [wanted], path)
        return wanted
    names = [name for name in table if name.split("_")[0].lower() in ("t", "time")]
    return names[0] if names else next(iter(table))

def _read(args: argparse.Namespace, gauge: Gauge, path: str, table: Table,
          column: str) -> Measured:
    need(table, [column], path)
    clock = time_column(table, args.time_column, path)
    if table[clock].dtype.kind != "f" or table[column].dtype.kind != "f":
        raise BadInput(f"{path}: column {column} or its times are no numbers")
    component = None
    if gauge.value.ndim == 2:
        end = units.split(column)[0].rpartition("_")[2]
        if not args.component and end not in ("x", "y", "z"):
            raise BadInput(f"{path}: gauge {gauge.name} is a velocity, and the name of column "
                           f"{column} does not end in its component, as {gauge.name}_x_m_s does: "
                           "give --component x, y or z")
        component = "xyz".index(args.component or end)
    second = args.time_scale if args.time_scale is not None else \
        units.factor(unit_of(table, clock) or ("s" if clock in SECONDS else ""), "s")
    scale = args.scale if args.scale is not None else _factor(gauge, table, column)
    options = {"time_column": clock, "time_scale": second, "scale": scale, "offset": args.offset,
               "lag": args.lag, "lag_range": args.lag_range, "average": args.average,
               "between": args.between}
    return Measured(path, column, (math.nan if second is None else second) * table[clock],
                    (math.nan if scale is None else scale) * table[column] + args.offset, component,
                    {name: value for name, value in options.items() if value is not None})


def compared(run: Run, gauge: Gauge, data: Measured) -> dict[str, Any]:
    """What the program says of a gauge beside a column: `rms`, `correlation`, `lag_s`, `peak` ...,
    None where there is none. PbfError, with the run's path, where it cannot be compared."""
    reading = gauge.name + ("" if data.component is None else "/" + "xyz"[data.component])
    try:
        return next(iter(compare_data(run, data.path, gauge={reading: data.column},
                                      **data.options).values()))
    except PbfError as problem:
        raise PbfError(f"{run.path}: {problem}", problem.exit_code) from None
