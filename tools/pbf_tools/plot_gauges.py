"""Gauge readings of a run over time, together with measured ones.

There is one panel per gauge: levels, velocities (x, y, z), flows, pressures with their peaks. An
experiment is a CSV table with a time column. The panel shows the RMS deviation, the correlation and
the number of points compared. A column named like a gauge ("H2", "H2_m") belongs to it; --column
assigns other columns.
"""

from __future__ import annotations

import argparse

import numpy as np

from . import style
from .errors import BadInput
from .run_file import Gauge, Run
from .table import Table, need, read_csv

EXAMPLE = """examples:
  python -m pbf_tools plot-gauges out/dam_break_over_box/run.vtkhdf -o gauges.png
  python -m pbf_tools plot-gauges run.vtkhdf --experiment heights.csv --column H2=h2 --column H4=h4
  python -m pbf_tools plot-gauges run.vtkhdf --gauge P1 --experiment p.csv --column p1 --shift 0.02"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("run_file", metavar="RUN", help="run file with gauges")
    parser.add_argument("--gauge", action="append", metavar="NAME",
                        help="gauge to draw (repeatable; default: all)")
    parser.add_argument("--experiment", action="append", default=[], metavar="FILE",
                        help="CSV table of measured values (repeatable)")
    parser.add_argument("--column", action="append", default=[], metavar="[GAUGE=]NAME",
                        help="column of a table that belongs to a gauge (repeatable; with one "
                             "gauge drawn its name may be left out)")
    parser.add_argument("--time-column", metavar="NAME",
                        help="time column of the tables (default: the first named t, time ..., else "
                             "the first)")
    parser.add_argument("--scale", type=float, default=1, metavar="F",
                        help="multiply measured values, 1000 for kPa (default 1)")
    parser.add_argument("--shift", type=float, default=0, metavar="S",
                        help="add this to the measured times (s; default 0)")
    parser.add_argument("--peaks", action="store_true",
                        help="also draw the largest values of single updates (pressures)")
    style.add_output(parser, "gauges.png")


def deviation(gauge: Gauge, t: np.ndarray, y: np.ndarray) -> tuple[float, float, int]:
    """RMS of reading - measured at the measured times that the run covers, the correlation of the
    two, and how many they are.

    >>> line = Gauge("a", "level", "", "m", np.array([0., 1., 2.]), np.array([0., 2., 4.]))
    >>> rms, correlation, n = deviation(line, np.array([0.5, 1., 9.]), np.array([2., 3., 1.]))
    >>> round(rms, 6), round(correlation, 6), n
    (1.0, 1.0, 2)
    """
    inside = (t >= gauge.time[0]) & (t <= gauge.time[-1]) & np.isfinite(y)
    run = np.interp(t[inside], gauge.time, gauge.value)
    good = np.isfinite(run)
    run, y = run[good], y[inside][good]
    if not len(y):
        return float("nan"), float("nan"), 0
    varied = len(y) > 1 and np.std(run) > 0 and np.std(y) > 0
    correlation = float(np.corrcoef(run, y)[0, 1]) if varied else float("nan")
    return float(np.sqrt(np.mean((run - y) ** 2))), correlation, len(y)


def time_column(table: Table, wanted: str | None, path: str) -> str:
    if wanted:
        need(table, [wanted], path)
        return wanted
    names = [name for name in table if name.split("_")[0].lower() in ("t", "time")]
    return names[0] if names else next(iter(table))


def measured(args: argparse.Namespace, gauges: list[Gauge]) -> dict[str, list]:
    """Of each gauge: (file, times, values)."""
    wanted: dict[str, list[str]] = {}
    names = [g.name for g in gauges]
    units = {g.name: g.unit for g in gauges}
    for text in args.column:
        gauge, equals, column = text.partition("=")
        if not equals:
            if len(gauges) > 1 and text not in names:
                raise BadInput(f"--column {text}: {len(gauges)} gauges are drawn; say to which it "
                               f"belongs, --column {names[0]}={text}")
            gauge, column = (text if text in names else names[0]), text
        if gauge not in names:
            raise BadInput(f"--column {text}: no gauge {gauge} is drawn; there are "
                           f"{', '.join(names)}")
        wanted.setdefault(gauge, []).append(column)
    out: dict[str, list] = {name: [] for name in names}
    tables = [(path, read_csv(path)) for path in args.experiment]
    for name in names:
        for column in wanted.get(name, [name, f"{name}_{units[name]}"]):
            with_it = [(path, table) for path, table in tables if column in table.columns]
            if name in wanted and not with_it:
                raise BadInput(f"no column {column} in {', '.join(args.experiment) or 'any table'}"
                               + ("" if tables else "; give --experiment FILE"))
            for path, table in with_it:
                need(table, [column], path)
                t = table[time_column(table, args.time_column, path)]
                if t.dtype.kind != "f" or table[column].dtype.kind != "f":
                    raise BadInput(f"{path}: column {column} or its times are no numbers")
                out[name].append((column, t + args.shift, args.scale * table[column]))
    if args.experiment and not any(out.values()):
        raise BadInput(f"{', '.join(args.experiment)}: no column is named as a gauge "
                       f"({', '.join(names)}); give --column GAUGE=NAME, of "
                       f"{', '.join(c for _, table in tables for c in table)}")
    return out


def run(args: argparse.Namespace) -> int:
    run_file = Run(args.run_file)
    all_gauges = run_file.gauges
    if not all_gauges:
        raise BadInput(f"{args.run_file}: no gauges; give the scene some (key gauges) and run it")
    for name in args.gauge or []:
        if name not in all_gauges:
            raise BadInput(f"{args.run_file}: no gauge {name}; there are {', '.join(all_gauges)}")
    gauges = [all_gauges[name] for name in args.gauge or all_gauges]
    for g in gauges:
        if not len(g.time):
            raise BadInput(f"{args.run_file}: gauge {g.name} has no readings yet")
    over = measured(args, gauges)
    columns = 1 if len(gauges) < 4 else 2
    rows = (len(gauges) + columns - 1) // columns
    fig, axes = style.figure(rows, columns, (6.4 * columns, 1.0 + 2.4 * rows), sharex=True)
    for axis in axes.flat[len(gauges):]:
        axis.set_visible(False)
    for g, axis in zip(gauges, axes.flat):
        draw(axis, g, over[g.name], args.peaks)
    last = max(g.time[-1] for g in gauges)
    for k, axis in enumerate(axes.flat[:len(gauges)]):
        axis.set_xlim(0, last)
        if k + columns >= len(gauges):
            axis.set_xlabel("time (s)")
            axis.tick_params(labelbottom=True)
    fig.suptitle(args.title or run_file.title, fontsize=9)
    style.save(fig, args)
    return 0


def draw(axes, g: Gauge, measured: list, peaks: bool) -> None:
    style.title(axes, g.name, f"{g.kind}, {g.place}")
    axes.set_ylabel(f"{g.kind} ({g.unit})")
    for k, (column, t, y) in enumerate(measured):
        dots = len(t) <= 200
        axes.plot(t, y, color=style.COLORS[(6 - k) % 8], linewidth=0 if dots else 1,
                  marker="." if dots else "", label=f"measured ({column})")
    if g.value.ndim == 2:
        for c, name in enumerate("xyz"):
            axes.plot(g.time, g.value[:, c], color=style.COLORS[c], label=name,
                      linestyle=("-", "--", "-.")[c])
    else:
        axes.plot(g.time, g.value, color=style.COLORS[0], label="run")
    if peaks and g.peak is not None:
        axes.plot(g.time, g.peak, color=style.COLORS[1], linewidth=0.8, alpha=0.7,
                  label="run, peak of an update")
    if measured or g.value.ndim == 2 or (peaks and g.peak is not None):
        axes.legend()
    for column, t, y in measured:
        if g.value.ndim == 2:
            continue
        rms, correlation, n = deviation(g, t, y)
        print(f"{g.name}: {column}: RMS deviation {rms:.4g} {g.unit}, correlation "
              f"{correlation:.3f} over {n} points")
