"""Stability map: which pairs of settings are stable, which degrade, which the guard stops.

Each cell is a run; colour and symbol show its class, and the number is the mean compression in
percent. There is a panel for each number of iterations. If the dimensionless step dt sqrt(g/h)
depends only on x, it is shown below the values of x.
"""

from __future__ import annotations

import argparse

import numpy as np

from . import style
from .errors import BadInput
from .table import Table, need, read_csvs

EXAMPLE = """example:
  python -m pbf_tools plot-map map.csv -o map.png"""

CLASSES = {"stable": ("#56B4E9", "o"), "degraded": ("#F0E442", "^"), "stopped": ("#D55E00", "X")}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("csv", nargs="+", metavar="CSV",
                        help="tables written by pbf stability --map")
    for name, default, text in (("x", "x", "setting along x"), ("y", "y", "setting along y"),
                                ("x-name", "x_key", "name of the setting along x"),
                                ("y-name", "y_key", "name of the setting along y"),
                                ("class", "class", "class: stable, degraded or stopped"),
                                ("panels", "iterations", "value that differs between panels"),
                                ("value", "compression_mean", "number shown in the cells"),
                                ("dt-hat", "dt_hat", "dimensionless step dt sqrt(g/h)")):
        parser.add_argument(f"--{name}", default=default, metavar="COLUMN",
                            dest="class_" if name == "class" else None,
                            help=f"column with the {text} (default %(default)s)")
    style.add_output(parser, "map.png")


def figure(args: argparse.Namespace) -> style.Picture:
    table, what = read_csvs(args.csv), ", ".join(args.csv)
    verdict = args.class_
    need(table, [args.x, args.y, verdict], what)
    unknown = set(table[verdict].tolist()) - set(CLASSES)
    if unknown:
        raise BadInput(f"{what}: column {verdict} holds {', '.join(map(str, sorted(unknown)))}; "
                       f"the classes are {', '.join(CLASSES)}")
    groups = _panels(table, args)
    across = min(len(groups), 3)
    down = -(-len(groups) // across)
    xs, ys = np.unique(table[args.x]), np.unique(table[args.y])
    width, height = max(2.2, 0.62 * len(xs)), max(1.8, 0.46 * len(ys))
    fig, panels = style.figure(down, across, size=(2.3 + (width + 0.5) * across,
                                                   1.3 + (height + 0.9) * down))
    for axes, (name, rows) in zip(panels.flat, groups):
        _draw(axes, rows, args, verdict, xs, ys)
        axes.set_title(name, fontsize=9)
    for axes in panels.flat[len(groups):]:
        axes.set_visible(False)
    for axes in panels[:, 0]:
        axes.set_ylabel(_name(table, args.y_name, args.y, "y"))
    handles = [panels[0, 0].scatter([], [], marker=sign, s=60, color=color, edgecolor="black",
                                    linewidth=0.6) for color, sign in CLASSES.values()]
    style.side_legend(panels[0, -1], handles, list(CLASSES))
    style.figure_title(fig, args.title or _title(table, args.value))
    for name in CLASSES:
        count = np.count_nonzero(table[verdict] == name)
        fig.tell(f"{name:9} {count:5d} of {len(table)} runs", verdict=name, runs=count)
    fig.told_last = True
    return fig


def _panels(table: Table, args: argparse.Namespace) -> list[tuple[str, Table]]:
    column = args.panels
    axes = (table[args.x], table[args.y])
    # The panels' setting may be along an axis already.
    if column not in table.columns or any(np.array_equal(table[column], a) for a in axes):
        return [("", table)]
    values = np.unique(table[column])
    return [(f"{column} {v:g}" if table[column].dtype.kind == "f" else str(v),
             table.where(table[column] == v)) for v in values]


def _draw(axes, rows: Table, args: argparse.Namespace, verdict: str, xs, ys) -> None:
    i, j = np.searchsorted(xs, rows[args.x]), np.searchsorted(ys, rows[args.y])
    if len(set(zip(i.tolist(), j.tolist()))) < len(rows):
        raise BadInput(f"two runs have the same {args.x}, {args.y} and {args.panels}; choose what "
                       "tells them apart with --panels COLUMN")
    values = rows.columns.get(args.value)
    for a, b, name, k in zip(i, j, rows[verdict], range(len(rows))):
        color, sign = CLASSES[name]
        axes.fill([a - .5, a + .5, a + .5, a - .5], [b - .5, b - .5, b + .5, b + .5], color=color,
                  edgecolor="white", linewidth=1)
        value = np.nan if values is None or name == "stopped" else values[k]
        shown = bool(np.isfinite(value))
        axes.plot(a, b + (0.2 if shown else 0), sign, color="black", markersize=5, alpha=0.75)
        if shown:
            axes.text(a, b - 0.22, f"{100 * value:.2g}", ha="center", va="center", fontsize=6.5)
    labels = [_short(x) for x in xs]
    hat = rows.columns.get(args.dt_hat)
    if hat is not None:
        at_x = [np.unique(np.round(hat[i == a], 12)) for a in range(len(xs))]
        if all(len(v) == 1 for v in at_x) and len({v[0] for v in at_x}) > 1:
            labels = [f"{label}\n{v[0]:.2g}" for label, v in zip(labels, at_x)]
    axes.set(xticks=range(len(xs)), yticks=range(len(ys)), xlim=(-.5, len(xs) - .5),
             ylim=(-.5, len(ys) - .5))
    axes.set_xticklabels(labels, fontsize=7.5)
    axes.set_yticklabels([_short(y) for y in ys], fontsize=8)
    text = _name(rows, args.x_name, args.x, "x")
    axes.set_xlabel(text + (r"; below: $\Delta t\,\sqrt{g/h}$ (1)" if "\n" in labels[0] else ""),
                    fontsize=9)
    axes.grid(False)


def _short(value: object) -> str:
    return str(value) if isinstance(value, str) else f"{value:.3g}"


UNITS = {"time.step": "s", "gravity": "m/s²", "fluid.spacing": "m", "fluid.rest_density": "kg/m³"}


def _name(table: Table, name_column: str, column: str, usual: str) -> str:
    """The setting's name with its unit; a column chosen instead of the usual one names itself."""
    there = column == usual and name_column in table.columns
    name = str(table[name_column][0]) if there else column
    unit = UNITS.get(name)
    return f"{name} ({unit})" if unit else name


def _title(table: Table, value: str) -> str:
    same = [str(table[c][0]) for c in ("scene", "backend", "precision", "device")
            if c in table.columns and len(set(table[c].tolist())) == 1]
    text = "Stability map" + (f": {', '.join(same)}" if same else "")
    return text + ("\n(numbers: mean compression, %)" if value == "compression_mean" and
                   value in table.columns else "")
