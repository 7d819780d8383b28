"""The report of `pbf compare --report FILE.json` as a picture: conclusion, diagrams, tables.

Every diagram of the comparison is a panel with a logarithmic y axis. Below them stands every part with
its finding, the source of its tolerances and its rows. A row that differs has a red background.
"""

from __future__ import annotations

import argparse
import json
import textwrap

import numpy as np

from . import style
from .errors import BadInput, FileError

EXAMPLE = """example:
  pbf compare configs/minimal.yaml --between cpu:double,cpu:float --report compare.json
  python -m pbf_tools plot-compare compare.json -o compare.png"""

NUMBERS = {"error": "%.3g", "rms": "%.3g", "relative": "%.2g", "ulps": "%.3g", "tolerance": "%.3g"}
COLUMNS = ("what", *NUMBERS, "unit", "verdict")
LINE = 0.17  # inches between lines of text
ACROSS = 120  # characters of a line


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("report", metavar="REPORT", help="what --report FILE.json has written")
    style.add_output(parser, "compare.png")


def read_report(path: str) -> dict:
    """The report as `pbf compare` has written it; BadInput where the file is something else."""
    try:
        with open(path, encoding="utf-8") as file:
            report = json.load(file)
    except OSError as problem:
        raise FileError(f"{path}: cannot be read: {problem.strerror}") from None
    except ValueError:
        report = None
    keys = ("a", "b", "same", "stage", "notes", "parts", "curves")
    if not isinstance(report, dict) or any(key not in report for key in keys):
        raise BadInput(f"{path}: is no report of pbf compare; write one with "
                       "pbf compare ... --report FILE.json")
    return report


def conclusion(report: dict) -> str:
    """The last line of what `pbf compare` prints.

    >>> conclusion({"same": True, "stage": ""}), conclusion({"same": False, "stage": "lambda"})
    ('same: every difference is within its tolerance', 'DIFFERENT, first in stage lambda')
    """
    if report["same"]:
        return "same: every difference is within its tolerance"
    return "DIFFERENT" + (f", first in stage {report['stage']}" if report["stage"] else "")


def table_lines(rows: list[dict]) -> list[str]:
    """The rows of a part below their heading, in columns; null, which is no number, as -.

    >>> row = {"what": "x", "error": 2, "rms": 1, "relative": 0.5, "ulps": None, "tolerance": 1,
    ...        "unit": "h", "verdict": "DIFFERS"}
    >>> print("\\n".join(table_lines([row])))
       error  rms  relative  ulps  tolerance  unit  verdict
    x      2    1       0.5     -          1  h     DIFFERS
    """
    words = [["" if c == "what" else c for c in COLUMNS]]
    for row in rows:
        words.append([row[c] if c not in NUMBERS else
                      "-" if row[c] is None else NUMBERS[c] % row[c] for c in COLUMNS])
    widths = [max(len(line[k]) for line in words) for k in range(len(COLUMNS))]
    return ["  ".join(f"{word:{'>' if name in NUMBERS else '<'}{width}}"
                      for name, word, width in zip(COLUMNS, line, widths)).rstrip()
            for line in words]


def part_lines(part: dict) -> list[tuple[str, dict]]:
    """The lines of a part with how each is drawn."""
    wrapped = [(line, {}) for line in textwrap.wrap(part["finding"], ACROSS)]
    wrapped += [(line, {"color": "#555555"}) for line in
                textwrap.wrap(f"tolerance: {part['tolerance_source']}", ACROSS)]
    lines = [(f"{part['part']}: {part['verdict']}", {"fontweight": "bold"}), *wrapped]
    if part["rows"]:
        heading, *rows = table_lines(part["rows"])
        lines.append((heading, {"family": "monospace", "color": "#555555"}))
        red = {"bbox": {"facecolor": "#FAD7D7", "edgecolor": "none", "pad": 1.5}}
        lines += [(line, {"family": "monospace", **(red if row["verdict"] == "DIFFERS" else {})})
                  for line, row in zip(rows, part["rows"])]
    return lines


def draw_diagram(axes, curves: list[dict]) -> None:
    """One diagram: values that a logarithmic axis cannot show are left out."""
    for k, curve in enumerate(curves):
        y = np.array(curve["y"], float)
        y[~(y > 0)] = np.nan
        axes.plot(curve["x"], y, label=curve["curve"], color=style.COLORS[k % 8],
                  marker="o" if np.count_nonzero(y > 0) == 1 else None)
    axes.set_yscale("log")
    axes.set_title(curves[0]["diagram"], loc="left", fontweight="bold")
    axes.set_xlabel(curves[0]["x_label"])
    axes.set_ylabel(curves[0]["y_label"])
    style.side_legend(axes)


def figure(args: argparse.Namespace) -> style.Picture:
    report = read_report(args.report)
    diagrams: dict[str, list[dict]] = {}
    for curve in report["curves"]:
        diagrams.setdefault(curve["diagram"], []).append(curve)
    text = [(line, {}) for about in (f"A  {report['a']}", f"B  {report['b']}", *report["notes"])
            for line in textwrap.wrap(about, ACROSS)]
    blocks = [text, *map(part_lines, report["parts"])]
    heights = [LINE * (len(lines) + 1) for lines in blocks]
    heights[1:1] = [3.0] * len(diagrams)
    fig, panels = style.figure(len(heights), 1, (9.5, sum(heights) + 0.5),
                               gridspec_kw={"height_ratios": heights})
    panels = list(panels[:, 0])
    for curves in diagrams.values():
        draw_diagram(panels.pop(1), curves)
    for axes, lines in zip(panels, blocks):
        axes.set_axis_off()
        axes.set_ylim(len(lines), 0)
        for k, (line, look) in enumerate(lines):
            axes.text(0, k + 0.5, line, va="center", fontsize=8, parse_math=False, **look)
    style.figure_title(fig, args.title or conclusion(report))
    fig.tell(conclusion(report), same=report["same"], stage=report["stage"])
    return fig
