"""Gauge readings of one or several runs over time, together with measured ones.

There is one panel per gauge: levels, velocities (x, y, z), flows, pressures with their peaks.
Several runs share the panels of the gauges that all of them have, one colour each. An experiment
is a CSV table with a time column; what `pbf compare-data` says of it is printed: the RMS deviation,
the correlation, the number of points compared, the peaks. A column named like a gauge ("H2", "H2_mm",
"U_x_m_s") belongs to it; --column assigns other columns. Units at the end of a name are converted, of
times too ("t_ms"); a column without one is in the gauge's unit.
"""

from __future__ import annotations

import argparse
import math
from dataclasses import replace
from typing import Any

from matplotlib.lines import Line2D

from . import gaps, measured, style
from .errors import BadInput, UnknownName, note, unknown
from .gauges import Gauge
from .logs import RUN_HELP, labels, read_run
from .measured import Measured
from .run_file import Run

EXAMPLE = """examples:
  python -m pbf_tools plot-gauges out/dam_break_over_box -o gauges.png
  python -m pbf_tools plot-gauges out/coarse out/fine --gauge H2 -o levels.png
  python -m pbf_tools plot-gauges run.vtkhdf --experiment heights.csv --column H2=h2 --column H4=h4
  python -m pbf_tools plot-gauges run.vtkhdf --gauge P1 --experiment p.csv --column p1 --lag 0.02
  python -m pbf_tools plot-gauges out/sloshing --gauge eta --experiment surge.csv \\
      --column eta_mm --time-scale 1.3 --offset 0.6       (time in periods of 1.3 s)"""

DASHES = ("-", "--", "-.")  # of the components of a velocity
PEAK = "peak of an update"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("runs", nargs="+", metavar="RUN", help=f"{RUN_HELP}, with gauges")
    parser.add_argument("--gauge", action="append", metavar="NAME",
                        help="gauge to draw (repeatable; default: all that every run has)")
    measured.add_arguments(parser)
    parser.add_argument("--peaks", action="store_true",
                        help="also draw the largest values of single updates (pressures)")
    style.add_output(parser, "gauges.png")


def choose(runs: list[tuple[str, dict[str, Gauge]]], wanted: list[str] | None) -> list[str]:
    """The gauges to draw, those asked for or all that every run has; BadInput when a run lacks one
    that was asked for, when it is another quantity there, or when nothing is left."""
    for path, gauges in runs:
        if not gauges:
            raise BadInput(f"{path}: no gauges; give the scene some (key gauges) and run it")
        for name in wanted or []:
            if name not in gauges:
                raise UnknownName(f"{path}: {unknown('gauge', name, gauges)}")
    first = runs[0][1]
    everywhere = [name for name in first if all(name in gauges for _, gauges in runs)]
    names = list(dict.fromkeys(wanted or everywhere))
    if not names:
        raise BadInput("no gauge that all runs have: " + "; ".join(
            f"{path} has {', '.join(gauges)}" for path, gauges in runs))
    left = dict.fromkeys(name for _, gauges in runs for name in gauges if name not in everywhere)
    if left and not wanted:
        note(f"not drawn, as not every run has it: {', '.join(left)}")
    for name in names:
        for path, gauges in runs:
            if not len(gauges[name].time):
                raise BadInput(f"{path}: gauge {name} has no readings yet")
            if gauges[name].kind != first[name].kind:
                raise BadInput(f"{path}: gauge {name} is one of {gauges[name].kind}, and in "
                               f"{runs[0][0]} one of {first[name].kind}; draw them apart")
    return names


def figure(args: argparse.Namespace) -> style.Picture:
    files = [read_run(path) for path in args.runs]
    runs = [(path, file.gauges) for path, file in zip(args.runs, files)]
    names, called = choose(runs, args.gauge), labels(args.runs, [file.name for file in files])
    over = measured.of_gauges(args, [runs[0][1][name] for name in names])
    said = {name: beside(files, runs[0][1][name], over[name]) for name in names}
    columns = 1 if len(names) < 4 else 2
    rows = (len(names) + columns - 1) // columns
    wide = 1.6 if len(runs) > 1 else 0  # for the legend
    fig, axes = style.figure(rows, columns, (6.4 * columns + wide, 1.0 + 2.4 * rows), sharex=True)
    for axis in axes.flat[len(names):]:
        axis.set_visible(False)
    last = 0.0
    for k, (name, axis) in enumerate(zip(names, axes.flat)):
        readings = {label: gauges[name] for label, (_, gauges) in zip(called, runs)}
        draw(axis, readings, [replace(data, time=data.time + found[0]["lag_s"])
                              for data, found in zip(over[name], said[name])], args.peaks)
        for data, found in zip(over[name], said[name]):
            for label, one in zip(called, found):
                tell(fig, readings[label], data, one, label, alone=len(runs) == 1)
        last = max(last, *(float(g.time[-1]) for g in readings.values()))
        if k + columns >= len(names):
            axis.set_xlabel("time (s)")
            axis.tick_params(labelbottom=True)
    if last > 0:
        axes.flat[0].set_xlim(0, last)
    if len(runs) > 1:
        _legend_of_runs(axes[0, -1], called, [runs[0][1][name] for name in names], over, args.peaks)
    titles = dict.fromkeys(file.title for file in files)
    scenes = ", ".join(dict.fromkeys(file.name for file in files))
    fig.suptitle(args.title or (next(iter(titles)) if len(titles) == 1 else
                                f"{scenes}: {len(runs)} runs"), fontsize=9)
    return fig


def draw(axes, readings: dict[str, Gauge], over: list[Measured], peaks: bool) -> None:
    """The panel of a gauge: its readings in every run, by the run's name, over measured values. One
    run has a colour for each component of a velocity, several have one for each run."""
    first, alone = next(iter(readings.values())), len(readings) == 1
    places = {g.place for g in readings.values()}
    style.title(axes, first.name, first.kind + (f", {first.place}" if len(places) == 1 else ""))
    axes.set_ylabel(f"{first.kind} ({first.unit})")
    for k, data in enumerate(over):
        look = _look_of_measured(k, data.time)
        if alone and data.component is not None:
            look["color"] = style.COLORS[data.component]
        axes.plot(data.time, data.value, label=f"measured ({data.column})", **look)
    for k, (name, g) in enumerate(readings.items()):
        gaps.tell(f"{first.name}, {name}", g.value, "readings", g.kind)
        if g.value.ndim == 2:
            for c, component in enumerate("xyz"):
                axes.plot(g.time, g.value[:, c], color=style.COLORS[c if alone else k % 8],
                          label=component, linestyle=DASHES[c], **gaps.points(g.value[:, c]))
        else:
            axes.plot(g.time, g.value, color=style.COLORS[k % 8], label="run",
                      **gaps.points(g.value))
        if peaks and g.peak is not None:
            axes.plot(g.time, g.peak, color=style.COLORS[1 if alone else k % 8], linewidth=0.8,
                      alpha=0.7, label="run, " + PEAK, linestyle="-" if alone else ":")
    if alone and len(axes.lines) > 1:
        style.side_legend(axes) if len(axes.lines) > 4 else axes.legend()


def beside(runs: list[Run], gauge: Gauge, over: list[Measured]) -> list[list[dict[str, Any]]]:
    """What the program says of every run beside each column."""
    return [[measured.compared(run, gauge, data) for run in runs] for data in over]


def tell(fig: style.Picture, gauge: Gauge, data: Measured, found: dict[str, Any], run: str,
         alone: bool) -> None:
    """The line of a comparison, which names the run unless it is alone, and its numbers (nan: there
    is none)."""
    numbers = {name: math.nan if value is None else value for name, value in found.items()
               if not isinstance(value, str)}
    which = gauge.name + ("" if data.component is None else "_" + "xyz"[data.component])
    alike = "no correlation, as one is constant" if found["correlation"] is None else \
        f"correlation {found['correlation']:.3f}"
    more = f"; lag {found['lag_s']:.4g} s" if found["lag_s"] else ""
    if found["peak"] is not None and found["peak_data"] is not None:
        more += f"; peak {found['peak']:.4g} {gauge.unit}, measured {found['peak_data']:.4g}"
    fig.tell(f"{which}{'' if alone else ', ' + run}: {data.column}: RMS deviation "
             f"{found['rms']:.4g} {gauge.unit}, {alike} over {found['points']:.0f} points{more}",
             gauge=which, run=run, column=data.column, unit=gauge.unit, **numbers)


def _look_of_measured(k: int, t: np.ndarray) -> dict[str, object]:
    look = {"color": "#000000" if k == 0 else style.GREY}
    if len(t) <= 200:
        return {**look, "linewidth": 0, "marker": ".dx+"[k % 4]}
    return {**look, "linewidth": 1, "linestyle": ("-", "--", "-.", ":")[k % 4]}


def _legend_of_runs(axes, labels: list[str], gauges: list[Gauge],
                    over: dict[str, list[Measured]], peaks: bool) -> None:
    """One legend for all panels: the colours of the runs, and what the kinds of lines mean."""
    entries = {label: Line2D([], [], color=style.COLORS[k % 8]) for k, label in enumerate(labels)}
    if any(g.value.ndim == 2 for g in gauges):
        entries |= {c: Line2D([], [], color=style.GREY, linestyle=line)
                    for c, line in zip("xyz", DASHES)}
    if peaks and any(g.peak is not None for g in gauges):
        entries[PEAK] = Line2D([], [], color=style.GREY, linestyle=":", linewidth=0.8)
    for columns in over.values():
        for k, data in enumerate(columns):
            entries[f"measured ({data.column})"] = Line2D([], [], **_look_of_measured(k, data.time))
    style.side_legend(axes, list(entries.values()), list(entries))
