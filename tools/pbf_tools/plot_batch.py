"""The summary of a batch: error against run time, or any column against another or a swept key.

Takes summary.csv or the folder of the batch. Over a swept key, every combination of the other keys
is a curve. Over a measured column, points are joined in the order of the last key, whose values
stand beside them, and the other keys make the curves. Runs that did not finish are left out.
"""

from __future__ import annotations

import argparse
import copy
from pathlib import Path

import numpy as np
from matplotlib.ticker import NullLocator

from . import gaps, style
from .errors import BadInput, note
from .run_path import ENDINGS
from .simulate import opened
from .sweep import Batch, read_batch
from .table import Table, need

EXAMPLE = """examples:
  python -m pbf_tools plot-batch out/sweep -o sweep.png          (error against run time)
  python -m pbf_tools plot-batch out/sweep --x solver.iterations --y compression_mean --log
  python -m pbf_tools plot-batch out/sweep/summary.csv --x time.step --y energy_drift"""
RUN_TIME, ERROR = "seconds", "compression_mean"
MOST_LABELS = 80  # beside points; more cover each other


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("summary", metavar="SUMMARY",
                        help="summary.csv of pbf batch, or the folder that it is in")
    parser.add_argument("--x", default=RUN_TIME, metavar="KEY|COLUMN",
                        help="swept key or measured column (default %(default)s, the run time)")
    parser.add_argument("--y", default=ERROR, metavar="COLUMN",
                        help="measured column: its last value in every run (default %(default)s)")
    parser.add_argument("--series", metavar="KEYS",
                        help="keys that distinguish the curves, separated by commas")
    parser.add_argument("--log", action=argparse.BooleanOptionalAction, default=None,
                        help="logarithmic axes (default: for error against run time)")
    for axis in "xy":
        parser.add_argument(f"--log-{axis}", action="store_true",
                            help=f"only {axis} logarithmic")
    parser.add_argument("--percent", action=argparse.BooleanOptionalAction, default=None,
                        help="draw y in percent (default: for compression columns)")
    style.add_output(parser, "batch.png")


def read_summary(batch: str | Batch) -> Batch:
    """The summary of a batch, given by its file, its folder or itself; scenes by their names."""
    table = copy.copy(batch) if isinstance(batch, Batch) else read_batch(batch)
    if "scene" in table:
        paths = table["scene"].tolist()
        names = scene_names(table, list(dict.fromkeys(paths)))
        table["scene"] = np.array([names[scene] for scene in paths], str)
    return table


def scene_names(table: Batch, paths: list[str]) -> dict[str, str]:
    """What the scenes of a batch are called: as they say themselves in a run, else as their files;
    the whole paths where that is the same for two."""
    def name_of(path: str) -> str:
        for row in np.flatnonzero(table["scene"] == path) if "name" in table else ():
            run = opened(table.out / str(table["name"][row]))
            if run:
                return run.name
        return file_name(path)

    for names in ([name_of(path) for path in paths], [file_name(path) for path in paths]):
        if len(set(names)) == len(paths):
            return dict(zip(paths, names))
    return {path: path for path in paths}


def file_name(path: str) -> str:
    """Of a scene file or a run file without the ending, of the folder of a run the whole.

    >>> file_name("scenes/dam.yaml"), file_name("out/v1.2/")
    ('dam', 'v1.2')
    """
    given = Path(path)
    return given.stem if given.suffix in (".yaml", ".yml", *ENDINGS) else given.name or path


def swept_keys(table: Table) -> list[str]:
    """The keys of the scene whose values differ between the rows: they stand between `settings` and
    `exit_code`. The scene is one of them where a batch has several.

    >>> swept_keys(Table({"scene": ["a", "a"], "settings": ["", ""], "time.step": [1., 2.],
    ...                   "solver.iterations": [4., 4.], "exit_code": [0., 0.]}))
    ['time.step']
    """
    names = list(table)
    if "settings" not in table or "exit_code" not in table:
        return []
    keys = names[names.index("settings") + 1:names.index("exit_code")]
    return [key for key in ("scene", *keys) if len(set(map(str, table.get(key, ())))) > 1]


def finished(table: Table) -> Table:
    """The rows whose run came to its end; how the others ended is said on stderr."""
    if "reason" not in table:
        return table
    other = [str(reason) for reason in table["reason"] if reason != "finished"]
    if other:
        kinds = ", ".join(f"{other.count(kind)} {kind}" for kind in dict.fromkeys(other))
        note(f"left out {len(other)} of {len(table)} runs, which did not finish: {kinds}")
    rows = table.where(table["reason"] == "finished")
    if not len(rows):
        raise BadInput("no run of this batch has finished; its summary says why (columns reason "
                       "and message)")
    return rows


def figure(args: argparse.Namespace) -> style.Picture:
    table = read_summary(args.summary)
    args.summary = table.out if isinstance(args.summary, Batch) else args.summary
    chosen = args.series.split(",") if args.series else None
    need(table, [args.x, args.y, *(chosen or ())], args.summary)
    if table[args.y].dtype.kind != "f":
        raise BadInput(f"{args.summary}: column {args.y} is not one of numbers")
    percent = args.y.startswith("compression") if args.percent is None else args.percent
    both = args.log if args.log is not None else \
        (args.x, args.y) == (RUN_TIME, ERROR) and not (args.log_x or args.log_y)
    log_x, log_y = both or args.log_x, both or args.log_y
    keys = swept_keys(table)
    table = _drawable(finished(table), args, log_x, log_y)
    if percent:
        table[args.y], table.units[args.y] = 100 * table[args.y], "%"
    free = [key for key in keys if key not in (args.x, args.y)]
    along = None if args.x in keys or not free else \
        next((key for key in reversed(free) if key not in (chosen or ())), None)
    series = chosen if chosen is not None else [key for key in free if key != along]
    fig, ((axes,),) = style.figure(size=(7.4 if series else 6.4, 4.6))
    _curves(axes, table, args, series, along, args.x in keys)
    _axis(axes, "x", table, args.x, log_x, args.x in keys)
    _axis(axes, "y", table, args.y, log_y, False)
    what = "Error against run time" if (args.x, args.y) == (RUN_TIME, ERROR) else \
        f"{_words(args.y)} against {_words(args.x)}"
    style.title(axes, args.title or what[0].upper() + what[1:], _detail(table, along))
    return fig


def _drawable(table: Table, args: argparse.Namespace, log_x: bool, log_y: bool) -> Table:
    """The rows that the axes can show; why others are left out is said on stderr."""
    good, reasons = np.full(len(table), True), []
    for name, log in ((args.x, log_x), (args.y, log_y)):
        values = table[name]
        if values.dtype.kind != "f":
            if log:
                raise BadInput(f"{args.summary}: column {name} is not one of numbers, and has no "
                               "logarithmic axis")
            continue
        missing = ~np.isfinite(values)
        low = ~missing & (values <= 0) & log
        good &= ~missing & ~low
        for bad, text in ((missing, f"is missing{gaps.why(name)}"),
                          (low, "is not above 0, which a logarithmic axis cannot show")):
            if bad.any():
                reasons.append(f"in {np.count_nonzero(bad)} {name} {text}")
    said = f"{np.count_nonzero(~good)} of {len(good)} finished runs: {'; '.join(reasons)}"
    if not good.any():
        raise BadInput(f"{args.summary}: nothing to draw, left out {said}")
    if reasons:
        note(f"left out {said}")
    return table.where(good)


def _curves(axes, table: Table, args: argparse.Namespace, series: list[str],
            along: str | None, over_key: bool) -> None:
    """A curve for each combination of the series' values; tells its points."""
    names = [", ".join(_value(table, key, row) for key in series) for row in range(len(table))]
    first = {name: tuple(table[key][row] for key in series) for row, name in enumerate(names)}
    order = np.argsort(table[along or args.x], kind="stable")
    labels = along or ("name" if not over_key and "name" in table else None)
    for k, name in enumerate(sorted(first, key=first.get)):
        rows = np.array([row for row in order if names[row] == name])
        x, y = table[args.x][rows], table[args.y][rows]
        line = ("-", "--", "-.", ":")[k // 8 % 4] if along or over_key else ""
        axes.plot(x, y, label=name or None, linestyle=line, linewidth=1.4, **style.cycle(k))
        for row, a, b in zip(rows, x, y):
            if labels and len(table) <= MOST_LABELS:
                axes.annotate(_text(table[labels][row]), (a, b), textcoords="offset points",
                              xytext=(5, 4), fontsize=8, color=style.cycle(k)["color"])
            words = [w for w in (name, labels and _value(table, labels, row)) if w]
            axes.figure.tell(
                f"{args.x} {_quantity(table, args.x, a)}  {args.y} {_quantity(table, args.y, b)}"
                + ("  " + ", ".join(words) if words else ""),
                **{args.x: a, args.y: b, "which": ", ".join(words)})
    if any(names):
        style.side_legend(axes)


def _axis(axes, which: str, table: Table, name: str, log: bool, key: bool) -> None:
    """Label and scale of an axis; that of a swept key has its marks at the values."""
    axes.set(**{f"{which}label": _label(table, name)})
    axis, values = getattr(axes, f"{which}axis"), np.unique(table[name])
    if log:
        axes.set(**{f"{which}scale": "log"})
        if values[-1] < 1e3 * values[0]:
            style.plain_log(axis)
    if key and values.dtype.kind == "f" and len(values) <= 8:
        axis.set_ticks(values, [_text(value) for value in values])
        axis.set_minor_locator(NullLocator())


def _words(name: str) -> str:
    """A column in words, a key as the scene spells it.

    >>> _words("seconds"), _words("energy_drift"), _words("fluid.rest_density")
    ('run time', 'energy drift', 'fluid.rest_density')
    """
    known = {RUN_TIME: "run time", ERROR: "mean compression at the end"}
    return known.get(name, name if "." in name else name.replace("_", " "))


def _label(table: Table, name: str) -> str:
    return _words(name) + table.label(name)[len(name):]


def _text(value: object) -> str:
    return str(value) if isinstance(value, str) else f"{value:g}"


def _quantity(table: Table, name: str, value: object) -> str:
    unit = table.units.get(name, "1")
    return _text(value) if unit == "1" else f"{_text(value)} {unit}"


def _value(table: Table, key: str, row: int) -> str:
    text = _quantity(table, key, table[key][row])
    return text if key in ("name", "scene") else f"{key} {text}"


def _detail(table: Table, along: str | None) -> str:
    scenes = set(table["scene"].tolist()) if "scene" in table else set()
    parts = [scenes.pop()] if len(scenes) == 1 else []
    parts.append(f"{len(table)} runs")
    if along and len(table) <= MOST_LABELS:
        parts.append(f"beside the points: {_label(table, along)}")
    return ", ".join(parts)
