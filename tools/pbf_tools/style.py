"""One look for all plots: colour-blind-safe colours (Okabe & Ito 2008), readable sizes."""

from __future__ import annotations

import argparse
import io
import json
import textwrap
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter, NullLocator

from .errors import BadInput, FileError
from .table import Table

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# Okabe & Ito, "Color Universal Design"; yellow last, it is faint on white.
COLORS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#000000", "#F0E442")
MARKERS = "osD^vPX*"
GREY = "#8A8A8A"

# The program's list (lib/base/stages.h) as `pbf config --stages` prints it: a stage has one colour in
# every plot; `other` is what no stage of the list booked. The groups are those of the summary of
# `pbf run`.
with open(Path(__file__).parent / "data/stages.json", encoding="utf-8") as _file:
    _LIST = json.load(_file)
STAGES = {stage["name"]: stage["color"] for stage in _LIST["stages"]} | {"other": "#D9D9D9"}
GROUP_COLORS = {group["name"]: group["color"] for group in _LIST["groups"]}
GROUPS = {name: tuple(s["name"] for s in _LIST["stages"] if s["group"] == name)
          for name in GROUP_COLORS}

_LOOK = {
    "font.size": 10, "axes.titlesize": 10, "axes.labelsize": 10, "legend.fontsize": 8.5,
    "xtick.labelsize": 9, "ytick.labelsize": 9, "figure.titlesize": 11, "axes.grid": True,
    "grid.color": "#DDDDDD", "grid.linewidth": 0.6, "axes.axisbelow": True, "lines.markersize": 5,
    "axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False,
    "errorbar.capsize": 3}


def look(**more):
    """A context and a decorator: what is drawn within has our look, what others draw keeps theirs."""
    return matplotlib.rc_context(_LOOK | more)


class Picture(Figure):
    """A figure and what there is to say of it: `told`, the lines that the command prints, and the
    same as a table, `numbers`. A notebook shows it as it is."""

    def __init__(self, *args, **more):
        super().__init__(*args, **more)
        self.told: list[str] = []
        self.told_last = False  # after the line that names the file
        self._rows: list[dict[str, object]] = []

    def tell(self, line: str, /, **numbers: object) -> None:
        """Adds a line, and its numbers as a row; the rows of a picture have the same names."""
        self.told.append(line)
        self._rows.append(numbers)

    @property
    def numbers(self) -> Table:
        """A row for each line, a column for each number or name in them; empty without lines."""
        return Table({name: np.array([row[name] for row in self._rows])
                      for name in (self._rows[0] if self._rows else ())})

    @look()  # some parts are made only now
    def draw(self, renderer) -> None:
        super().draw(renderer)

    def _repr_png_(self) -> bytes:
        out = io.BytesIO()
        self.savefig(out, format="png")
        return out.getvalue()


def figure(rows: int = 1, columns: int = 1, size: tuple[float, float] = (6.4, 4.2),
           **grid) -> tuple[Picture, np.ndarray]:
    """A figure (inches) with a grid of axes, shape (rows, columns); no window, no global state."""
    fig = Picture(figsize=size, layout="constrained")
    return fig, fig.subplots(rows, columns, squeeze=False, **grid)


def title(axes: Axes, text: str, detail: str = "") -> None:
    """What is shown in bold; below it, smaller, with which scene, backend and device."""
    lines = detail.count("\n") + 1 if detail else 0
    axes.set_title(text, loc="left", fontweight="bold", pad=6 + 12 * lines)
    if detail:
        axes.text(0, 1.015, detail, transform=axes.transAxes, fontsize=8, color="#444444",
                  va="bottom")


def figure_title(fig: Figure, text: str) -> None:
    """In bold above all panels, in as many lines as the width asks for."""
    across = int(fig.get_figwidth() * 11)  # characters that fit, in bold
    lines = [part for line in text.split("\n") for part in textwrap.wrap(line, across) or [""]]
    fig.suptitle("\n".join(lines), fontweight="bold")


def side_legend(axes: Axes, *handles_and_labels, **more) -> None:
    """A legend right of the axes, where it covers nothing."""
    axes.legend(*handles_and_labels, loc="upper left", bbox_to_anchor=(1.01, 1.02), **more)


def cycle(k: int) -> dict[str, object]:
    """Colour and marker of the k-th series; they also differ by shape, for print in grey."""
    return {"color": COLORS[k % len(COLORS)], "marker": MARKERS[k % len(MARKERS)]}


def count_text(n: float) -> str:
    """A number of particles in few characters.

    >>> [count_text(n) for n in (512, 1024, 131072, 1000000, 2500000)]
    ['512', '1024', '131k', '1M', '2.5M']
    """
    for limit, unit in ((1e6, "M"), (1e4, "k")):
        if n >= limit:
            scaled = n / (1e6 if unit == "M" else 1e3)
            return f"{scaled:.3g}{unit}"
    return f"{n:g}"


def particle_axis(axes: Axes, counts: np.ndarray) -> None:
    """Logarithmic axis of particle counts, marked at the counts that were measured."""
    axes.set_xscale("log")
    ticks = np.unique(counts)
    if len(ticks) <= 10:
        axes.set_xticks(ticks)
        axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_formatter(FuncFormatter(lambda n, _: count_text(n)))
    axes.set_xlabel("particles")


def plain_log(axis) -> None:
    """Plain numbers at 1, 2, 5, 10 ... along a logarithmic axis of a few decades."""
    axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axis.set_minor_formatter(NullFormatter())
    axis.set_major_formatter(FuncFormatter(lambda v, _: f"{v:g}"))


def add_output(parser: argparse.ArgumentParser, default: str) -> None:
    """The options that every plot has."""
    shown = " (default %(default)s)" if default else " (default: none)"
    parser.add_argument("-o", "--out", default=default, metavar="FILE",
                        help="picture to write; .png, .svg or .pdf" + shown)
    parser.add_argument("--title", help="title instead of the automatic one")
    parser.add_argument("--dpi", type=dots, default=150, help="dots per inch of a .png")


def drawn(figure: Callable[[argparse.Namespace], Picture], args: argparse.Namespace) -> Picture:
    """The figure that `figure` makes of the arguments of its command."""
    with look(**{"figure.dpi": args.dpi}):
        return figure(args)


def command(figure: Callable[[argparse.Namespace], Picture], args: argparse.Namespace) -> int:
    """The command around a figure: draws it, prints what there is to say of it, and saves it."""
    fig = drawn(figure, args)
    if fig.told_last:
        save(fig, args)
    print(*fig.told, sep="\n", end="\n" if fig.told else "")
    if not fig.told_last:
        save(fig, args)
    return 0


def dots(text: str | float) -> float:
    """The argument of --dpi."""
    if not 10 <= float(text) <= 2400:
        raise argparse.ArgumentTypeError(f"{text}: give a number from 10 to 2400")
    return float(text)


def save(fig: Figure, args: argparse.Namespace) -> None:
    """Writes the figure where `--out` says, and prints the path."""
    try:
        fig.savefig(args.out, dpi=args.dpi)
    except OSError as problem:
        raise FileError(f"{args.out}: cannot write the picture: {problem.strerror}") from None
    except ValueError as problem:
        raise BadInput(f"{args.out}: {problem}") from None
    print(f"wrote {args.out}")
