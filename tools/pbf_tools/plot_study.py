"""Error against run time for the settings of a study, on logarithmic axes.

Each series (method, backend, precision) has one curve through its best settings; its other settings
are faint points. A thick grey line joins the Pareto front, the settings that no other beats in both
time and error. Bars show the spread of the repeats. With --panels, tables with different names are
drawn side by side, on the same scale of errors if they show the same error.
"""

from __future__ import annotations

import argparse
import re
import sys
from pathlib import Path

import numpy as np

from . import style, units
from .errors import BadInput, FileError
from .table import Table, need, read_csvs

EXAMPLE = """example:
  python -m pbf_tools plot-study study.csv --y compression_mean -o study.png
  python -m pbf_tools plot-study out/study_motion --y center_of_mass_x_rms_m -o motion.png"""


TABLE = "study.csv"  # of pbf study, in its folder
COMPRESSION = "compression_mean"
# Columns that no table has: which panel, counted from 0, shows a row, and its error there.
PANEL, ERROR = " panel", " error"


def _table_of(path: str) -> str:
    """The table of a study that is named by its file or by the folder of `pbf study --out`."""
    if not Path(path).is_dir():
        return path
    if (Path(path) / TABLE).is_file():
        return str(Path(path) / TABLE)
    raise FileError(f"{path}: no {TABLE} in this folder; name a CSV file, or the folder that "
                    "`pbf study --out` wrote")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("csv", nargs="+", metavar="STUDY", type=_table_of,
                        help="folder that pbf study --out wrote, or a table, OUT/study.csv; several "
                             "are drawn together")
    parser.add_argument("--x", default="seconds_median", metavar="COLUMN",
                        help="run time, s (default %(default)s)")
    parser.add_argument("--x-spread", default="seconds_spread", metavar="COLUMN",
                        help="longest minus shortest time of the repeats, s: the length of the bar "
                             "at the median (default %(default)s; no bar without this column)")
    parser.add_argument("--y", nargs="+", metavar="COLUMN", default=[],
                        help="error, of compression or of motion: energy_rms_relative, front_x_rms_m "
                             "(default: the first error of the study); one, or one for each panel")
    parser.add_argument("--series", default="variant,method,backend,precision", metavar="COLUMNS",
                        help="columns that distinguish the curves (default %(default)s)")
    parser.add_argument("--pareto", metavar="COLUMN",
                        help="1 where a setting is on the front (default pareto for the first error "
                             "of the study); computed from --x and --y without this column, for "
                             "another --y or with --pareto compute")
    parser.add_argument("--percent", action=argparse.BooleanOptionalAction, default=None,
                        help="draw the error in percent (default: for compression and relative "
                             "columns)")
    parser.add_argument("--panels", nargs="+", metavar="NAME", default=[],
                        help="a name for each CSV; tables with the same name share a panel")
    parser.add_argument("--goal", nargs="+", metavar="TIME:ERROR", type=_goal, default=[],
                        help="mark this time and error with a star; one for each panel, error in "
                             "the unit of the axis")
    style.add_output(parser, "study.png")


def _goal(text: str) -> tuple[float, float]:
    """
    >>> _goal("0.2:0.1")
    (0.2, 0.1)
    """
    try:
        time, error = (float(part) for part in text.split(":"))
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not TIME:ERROR, such as 0.2:0.1") from None
    if not (0 < time < np.inf and 0 < error < np.inf):
        raise argparse.ArgumentTypeError(f"{text!r}: a logarithmic axis shows what is above 0")
    return time, error


def unit_of(column: str) -> str:
    """The unit that the name of a column ends in, "1" where it has none.

    >>> unit_of("front_x_rms_m"), unit_of("momentum_x_rms_kg_m_s"), unit_of("compression_mean")
    ('m', 'kg m/s', '1')
    """
    found = re.search(r"_rms(_\w+)$", column)
    return {**units.ENDINGS, "_h": "h"}.get(found[1], "1") if found else "1"


def front(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Which points no other point beats in both x and y, as a mask of shape (points,).

    >>> front(np.array([1., 2., 3., 4.]), np.array([9., 4., 5., 1.])).tolist()
    [True, True, False, True]
    """
    order = np.lexsort((y, x))
    best = np.minimum.accumulate(np.concatenate([[np.inf], y[order][:-1]]))
    mask = np.zeros(len(x), bool)
    mask[order] = y[order] < best
    return mask


def figure(args: argparse.Namespace) -> style.Picture:
    titles = list(dict.fromkeys(args.panels)) or [""]
    if args.panels and len(args.panels) != len(args.csv):
        raise BadInput(f"--panels: {len(args.panels)} names for {len(args.csv)} tables; give one "
                       "for each")
    if args.goal and len(args.goal) != len(titles):
        raise BadInput(f"--goal: {len(args.goal)} goals for {len(titles)} panels; give one for "
                       "each")
    if len(args.y) > 1 and len(args.y) != len(titles):
        raise BadInput(f"--y: {len(args.y)} columns for {len(titles)} panels; give one, or one for "
                       "each")
    table = read_csvs(args.csv)
    first = _first_error(table)
    errors = args.y or [first]
    if len(errors) == 1:
        errors *= len(titles)
    args.pareto = args.pareto or ("pareto" if set(errors) == {first} else "compute")
    whole = _rows(args, table, errors)
    keys = [c for c in args.series.split(",") if c in whole.columns]
    names = np.array([", ".join(_text(whole[c][i]) for c in keys) for i in range(len(whole))])
    looks = _looks(whole, keys, names)
    same = len(set(errors)) == 1
    fig, grid = style.figure(1, len(titles), size=(2.8 + 4.2 * len(titles), 4.8), sharey=same)
    for k, (axes, title, error) in enumerate(zip(grid[0], titles, errors)):
        own = whole[PANEL] == k
        if not own.any():
            raise BadInput(f"panel {title}: no row that finished has both {args.x} and {error}")
        percent = args.percent
        if percent is None:
            percent = error.startswith("compression") or error.endswith("_relative")
        _panel(axes, args, whole.where(own), error, percent, names[own], looks)
        if args.goal:
            axes.plot(*args.goal[k], "*", markersize=15, markerfacecolor="white", zorder=1.5,
                      markeredgecolor="black", linestyle="", label="goal")
        axes.set(xscale="log", yscale="log", xlabel=_label(args.x, "s"),
                 ylabel="" if k and same else _label(error, "%" if percent else unit_of(error)))
        _plain_times(axes)
        style.title(axes, title or args.title or "Error against run time",
                    _detail(whole.where(own)))
    style.side_legend(grid[0][-1])
    if args.panels and args.title:
        style.figure_title(fig, args.title)
    fig.told_last = True
    return fig


def _plain_times(axes) -> None:
    """Times at 1, 2 and 5 of each decade, written out: a panel may span less than a decade."""
    from matplotlib.ticker import FormatStrFormatter, LogLocator, NullFormatter
    axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axes.xaxis.set_major_formatter(FormatStrFormatter("%g"))
    axes.xaxis.set_minor_formatter(NullFormatter())


def _first_error(table: Table) -> str:
    """The error that the column pareto is about."""
    names = set(table["error"].tolist()) - {""} if "error" in table.columns and len(table) else set()
    return names.pop() if len(names) == 1 else COMPRESSION


def _rows(args: argparse.Namespace, table: Table, errors: list[str]) -> Table:
    """The rows that can be drawn, each with its panel and its error; what is left out is said on
    stderr."""
    need(table, [args.x, *errors], ", ".join(args.csv))
    for name in (args.x, *errors):
        if table[name].dtype.kind != "f":
            raise BadInput(f"column {name} is not one of numbers")
    titles = list(dict.fromkeys(args.panels))
    panel = np.repeat([titles.index(name) for name in args.panels] or [0] * len(args.csv),
                      [len(read_csvs([path])) for path in args.csv])
    y = np.choose(panel, [table[name] for name in errors])
    table = Table({**table.columns, PANEL: panel, ERROR: y})
    good = np.isfinite(table[args.x]) & (table[args.x] > 0) & (y > 0) & np.isfinite(y)
    wanted = " or ".join(dict.fromkeys(errors))
    if not good.any():
        raise BadInput(f"no row has both {args.x} and {wanted} above 0")
    if not good.all():
        print(f"left out: {np.count_nonzero(~good)} rows whose {args.x} or {wanted} is missing or "
              "not above 0, which a logarithmic axis cannot show", file=sys.stderr)
    table = table.where(good)
    status = table.columns.get("status")
    if status is not None and (status != "finished").any():
        print(f"left out: {np.count_nonzero(status != 'finished')} rows that did not finish or made "
              "energy", file=sys.stderr)
        table = table.where(status == "finished")
    return table


def _panel(axes, args: argparse.Namespace, table: Table, error: str, percent: bool,
           names: np.ndarray, looks: dict[str, tuple[dict[str, object], str]]) -> None:
    """Draws a table; tells the settings on its front."""
    x, y = table[args.x], table[ERROR] * (100 if percent else 1)
    spread = table.columns.get(args.x_spread)
    best = _pareto(table, args.pareto, x, y)
    at = np.flatnonzero(best)[np.argsort(x[best])]
    axes.plot(x[at], y[at], color="#BBBBBB", linewidth=7, solid_capstyle="round", zorder=1,
              label="Pareto front")
    for name, (look, line) in looks.items():
        _series(axes, x, y, spread, np.flatnonzero(names == name), name, look, line)
    axes.plot(x[at], y[at], "o", markersize=11, markerfacecolor="none", markeredgecolor="black",
              markeredgewidth=0.9, zorder=4)
    unit = " %" if percent else "" if unit_of(error) == "1" else " " + unit_of(error)
    for i in at:
        axes.figure.tell(f"{x[i]:10.4g} s  {error} {y[i]:.3g}{unit}  {names[i]}", seconds=x[i],
                         error=error, value=y[i], unit=unit.strip(), series=names[i])


def _looks(table: Table, keys: list[str],
           names: np.ndarray) -> dict[str, tuple[dict[str, object], str]]:
    """Markers and line of every series. Where several of its columns vary, the last one of them
    chooses the line (full, dashed ...) and the others the colour."""
    vary = [c for c in keys if len(set(table[c].tolist())) > 1]
    by_line = vary[-1] if len(vary) > 1 else None
    colors: dict[tuple[str, ...], int] = {}
    lines: dict[str, int] = {}
    looks = {}
    for name in dict.fromkeys(names.tolist()):
        i = int(np.flatnonzero(names == name)[0])
        color = colors.setdefault(tuple(_text(table[c][i]) for c in vary if c != by_line),
                                  len(colors))
        line = lines.setdefault(_text(table[by_line][i]), len(lines)) if by_line else 0
        look = style.cycle(color)
        if line:
            look["markerfacecolor"] = "white"
        looks[name] = look, ("-", "--", ":", "-.")[line % 4]
    return looks


def _series(axes, x, y, spread, rows: np.ndarray, name: str, look: dict[str, object],
            style_of_line: str) -> None:
    own = front(x[rows], y[rows])
    line = rows[own][np.argsort(x[rows[own]])]
    axes.plot(x[line], y[line], label=name or None, zorder=3, linewidth=1.4,
              linestyle=style_of_line, **look)
    rest = rows[~own]
    axes.plot(x[rest], y[rest], linestyle="", alpha=0.35, zorder=2, **look)
    if spread is not None:
        bar = np.where(np.isfinite(spread[rows]), spread[rows] / 2, 0)
        axes.errorbar(x[rows], y[rows], xerr=np.minimum(bar, 0.999 * x[rows]), linestyle="",
                      color=look["color"], alpha=0.6, linewidth=1, zorder=2)


def _pareto(table: Table, column: str, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    marks = table.columns.get(column)
    if column == "compute" or marks is None:
        return front(x, y)
    if marks.dtype.kind == "U":
        return np.isin(marks, ("1", "true", "True"))
    return marks == 1


def _text(value: object) -> str:
    return value if isinstance(value, str) else f"{value:g}"


def _label(column: str, unit: str) -> str:
    name = "run time, median" if column == "seconds_median" else column.replace("_", " ")
    if unit_of(column) != "1":
        name = column[:column.rindex("_rms")].replace("_", " ") + " RMS"
    return f"{name} ({unit})"


def _detail(table: Table) -> str:
    """What is the same in all rows."""
    parts = []
    for name, unit in (("scene", ""), ("device", ""), ("backend", ""), ("precision", ""),
                       ("threads", " threads"), ("particles", " particles")):
        values = set(table[name].tolist()) if name in table.columns else set()
        if len(values) == 1:
            text = _text(values.pop())
            if (name, text) == ("threads", "1"):
                unit = " thread"
            parts += [text + unit] if text not in ("", "0", "nan") else []
    return ", ".join(parts)
