"""Measured values for gauges: columns of CSV tables in the gauges' units, and how far runs deviate."""

from __future__ import annotations

import argparse
from dataclasses import dataclass

import numpy as np

from . import gaps, units
from .errors import BadInput, UnknownName, unknown
from .gauges import Gauge
from .table import Table, need, read_csv

FEWEST = 10  # points that a comparison takes
SECONDS = ("t", "time", "Time")  # columns of times that need no unit in their names


@dataclass(frozen=True)
class Measured:
    """A column for a gauge, times in s and values in the gauge's unit, shape (rows,); `component` of
    a velocity, 0 to 2."""

    path: str
    column: str
    time: np.ndarray
    value: np.ndarray
    component: int | None = None


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
    parser.add_argument("--shift", type=float, default=0, metavar="S",
                        help="add this to the measured times (s; default 0)")
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


def _read(args: argparse.Namespace, gauge: Gauge, path: str, table: Table,
          column: str) -> Measured:
    need(table, [column], path)
    name = time_column(table, args.time_column, path)
    if table[name].dtype.kind != "f" or table[column].dtype.kind != "f":
        raise BadInput(f"{path}: column {column} or its times are no numbers")
    scale = _factor(gauge, table, column) if args.scale is None else args.scale
    if scale is None:
        raise BadInput(f"{path}: column {column} is in {unit_of(table, column)}, and gauge "
                       f"{gauge.name} reads a {gauge.kind} in {gauge.unit}: name another column "
                       f"(--column {gauge.name}=NAME), or give --scale, the {gauge.unit} of one "
                       "unit")
    component = None
    if gauge.value.ndim == 2:
        end = units.split(column)[0].rpartition("_")[2]
        if not args.component and end not in ("x", "y", "z"):
            raise BadInput(f"{path}: gauge {gauge.name} is a velocity, and the name of column "
                           f"{column} does not end in its component, as {gauge.name}_x_m_s does: "
                           "give --component x, y or z")
        component = "xyz".index(args.component or end)
    time = _seconds(args, table, name, path) * table[name] + args.shift
    return Measured(path, column, time, scale * table[column] + args.offset, component)


def time_column(table: Table, wanted: str | None, path: str) -> str:
    if wanted:
        need(table, [wanted], path)
        return wanted
    names = [name for name in table if name.split("_")[0].lower() in ("t", "time")]
    return names[0] if names else next(iter(table))


def _seconds(args: argparse.Namespace, table: Table, name: str, path: str) -> float:
    """The seconds of one unit of a time column."""
    if args.time_scale is not None:
        return args.time_scale
    unit = unit_of(table, name) or ("s" if name in SECONDS else "")
    if not unit:
        raise BadInput(f"{path}: column {name} has no unit of time: give --time-scale, the seconds "
                       "of one unit")
    factor = units.factor(unit, "s")
    if factor is None:
        raise BadInput(f"{path}: column {name} is in {unit}, which is no unit of time: name the "
                       "column of times with --time-column, or give --time-scale, the seconds of "
                       "one unit")
    return factor


def deviation(gauge: Gauge, data: Measured, run: str = "the run") -> tuple[float, float, int]:
    """RMS of reading - measured at the measured times that the run covers, the correlation of the
    two, nan where one is constant, and how many they are. BadInput where these are fewer than ten,
    or where less than half of the measured times are within the run.

    >>> t = np.arange(12.0)
    >>> line = Gauge("a", "level", "", "m", t, 2 * t)
    >>> rms, correlation, n = deviation(line, Measured("", "a", t + 0.5, 2 * t))
    >>> round(rms, 6), round(correlation, 6), n
    (1.0, 1.0, 11)
    """
    value = gauge.value if data.component is None else gauge.value[:, data.component]
    good = np.isfinite(data.value) & np.isfinite(data.time)
    t, y = data.time[good], data.value[good]
    first, last = gauge.time[0], gauge.time[-1]
    within = (t >= first - 1e-9 * last) & (t <= last + 1e-9 * last)  # of times in ms, say
    at = np.interp(t[within], gauge.time, value)
    common = np.isfinite(at)
    at, measured = at[common], y[within][common]
    if len(at) < FEWEST or 2 * np.count_nonzero(within) < len(t):
        span = f" from {t.min():g} to {t.max():g} s" if len(t) else ""
        raise BadInput(
            f"{data.path}: column {data.column} has {len(t)} values{span}, of which "
            f"{np.count_nonzero(within)} are within the readings of gauge {gauge.name} in {run}, "
            f"{first:g} to {last:g} s, and {len(at)} have a reading; to compare, half of them and "
            f"{FEWEST} at least must: check --time-scale and --shift, cut the table, or choose "
            "other gauges with --gauge")
    varied = np.std(at) > 0 and np.std(measured) > 0
    correlation = float(np.corrcoef(at, measured)[0, 1]) if varied else float("nan")
    return float(np.sqrt(np.mean((at - measured) ** 2))), correlation, len(at)
