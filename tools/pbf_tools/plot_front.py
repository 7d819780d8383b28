"""Front of a dam break over time against experiments, in the dimensionless axes of the papers.

Z = x/a against T = t sqrt(n2 g/a): x from the back of the column to the front, a the width of the
column along the flow, n2 its height over its width. The front of a run is its foremost particle
plus half a spacing; it is compared until it comes within a smoothing length of the far wall. The
experiments' clocks start with the gate, whose opening takes time: beside the RMS deviation stands
the one after the best shift of T.
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass

import numpy as np

from . import gaps, style
from .errors import BadInput
from .front_data import REFERENCES
from .logs import RUN_HELP, labels, read_run, short_names
from .scene_text import gravity_in
from .table import Table, need, read_csv

EXAMPLE = """examples:
  python -m pbf_tools plot-front out/dam_break -o front.png
  python -m pbf_tools plot-front out/coarse out/fine --reference martin-moyce
  python -m pbf_tools plot-front front.csv --width 0.4 --height 0.8   (columns time, front_x)"""


@dataclass
class Front:
    """A simulated front: T and Z, shape (measures,), until the far wall."""

    name: str
    title: str
    ratio: float
    t: np.ndarray
    z: np.ndarray


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("runs", nargs="+", metavar="RUN", help=f"{RUN_HELP}, or CSV table of a log")
    parser.add_argument("--axis", choices="xyz", default="x", help="along the flow (default x)")
    parser.add_argument("--reference", action="append", choices=list(REFERENCES), metavar="NAME",
                        help="experiment (repeatable; default: all of the column's shape): "
                             + ", ".join(REFERENCES))
    parser.add_argument("--width", type=float, metavar="M",
                        help="of the column, a; default: from the first frame")
    parser.add_argument("--height", type=float, metavar="M",
                        help="of the column; default: from the first frame")
    parser.add_argument("--gravity", type=float, metavar="M/S2",
                        help="default: of the scene; 9.81 with a table")
    parser.add_argument("--shift", type=float, default=0, metavar="T",
                        help="add this to the T of the runs (default 0)")
    style.add_output(parser, "front.png")


def deviation(t: np.ndarray, z: np.ndarray, table: Table, shift: float = 0) -> tuple[float, int]:
    """RMS of Z_run - Z_measured at the measured T that the run covers, and how many they are.

    >>> line = np.linspace(0, 4, 9)
    >>> deviation(line, 1 + line, Table({"T": np.array([1., 2., 9.]), "Z": np.array([2., 4., 9.])}))
    (0.7071067811865476, 2)
    """
    inside = (table["T"] >= t[0] + shift) & (table["T"] <= t[-1] + shift)
    off = np.interp(table["T"][inside], t + shift, z) - table["Z"][inside]
    return (float(np.sqrt(np.mean(off**2))) if len(off) else float("nan"), int(len(off)))


def best_shift(t: np.ndarray, z: np.ndarray, table: Table) -> tuple[float, float]:
    """The shift of T in -0.5..0.5 with the least RMS deviation, and that deviation."""
    points = deviation(t, z, table)[1]
    shifts = np.round(np.linspace(-0.5, 0.5, 101), 2)
    tried = [(*deviation(t, z, table, s), s) for s in shifts.tolist()]
    # A shift must not gain by pushing measured points out of the run's range.
    rms, _, shift = min(((rms, abs(s), s) for rms, n, s in tried if n >= points > 0),
                        default=(float("nan"), 0.0, 0.0))
    return shift, rms


def read_front(path: str, args: argparse.Namespace) -> Front:
    """The front of a run file or a table, dimensionless."""
    axis = "xyz".index(args.axis)
    column = f"front_{args.axis}"
    if path.endswith(".csv"):
        if args.width is None or args.height is None:
            raise BadInput(f"{path}: a table does not say how large the column was: give --width "
                           "and --height")
        log, back, wall, half, own_g = read_csv(path), 0.0, np.inf, 0.0, 9.81
        own_width, own_height = args.width, args.height
        name = title = short_names([path])[0]
    else:
        r = read_run(path)
        if not len(r.frames):
            raise BadInput(f"{path}: no frame yet, so the column is not known")
        gravity = gravity_in(r.scene, path)
        up = int(np.argmax(np.abs(gravity)))
        if up == axis:
            raise BadInput(f"{path}: gravity points along {args.axis}; choose another --axis")
        d = float(r.info["spacing"])
        low, high = r["position"][0].min(axis=0), r["position"][0].max(axis=0)
        size = high - low + d
        half, back = d / 2, float(low[axis]) - d / 2
        wall = float(r.info["domain_max"][axis]) - float(r.info["smoothing_length"])
        own_width, own_height, own_g = float(size[axis]), float(size[up]), float(abs(gravity[up]))
        log, name, title = r.log, r.name, r.title
    need(log, ["time", column], path)
    log = gaps.whole_rows(log, ["time", column], path)
    width, height, g = (own if given is None else given for given, own in
                        ((args.width, own_width), (args.height, own_height), (args.gravity, own_g)))
    if not (width > 0 and height > 0 and g > 0):
        raise BadInput(f"{path}: width, height and gravity must be above 0")
    x = log[column] + half
    end = int(np.argmax(x >= wall)) if np.any(x >= wall) else len(x)
    if end < 2:
        raise BadInput(f"{path}: fewer than two measures before the front reaches the wall")
    ratio = height / width
    return Front(name, title, ratio, log["time"][:end] * np.sqrt(ratio * g / width) + args.shift,
                 (x[:end] - back) / width)


def figure(args: argparse.Namespace) -> style.Picture:
    fronts = [read_front(path, args) for path in args.runs]
    names_of_runs = labels(args.runs, [front.name for front in fronts])

    def same_shape(name: str, front: Front) -> bool:
        return abs(REFERENCES[name].ratio - front.ratio) < 0.1

    names = args.reference or [n for n in REFERENCES if any(same_shape(n, f) for f in fronts)]
    if not names:
        raise BadInput(f"the column is {fronts[0].ratio:.3g} times as high as wide; the experiments here had "
                       "1 and 2. Choose some anyway with --reference")
    fig, ((axes,),) = style.figure(size=(6.6, 5))
    for k, (front, label) in enumerate(zip(fronts, names_of_runs)):
        axes.plot(front.t, front.z, color=style.COLORS[k % 8], label=f"pbf, {label}",
                  linestyle=("-", "--", "-.", ":")[k % 4], linewidth=2)
    for k, name in enumerate(names):
        data = REFERENCES[name].read()
        axes.plot(data["T"], data["Z"], linestyle="", color=style.COLORS[(k + len(fronts)) % 8],
                  marker=style.MARKERS[k % 8], label=REFERENCES[name].label, alpha=0.85,
                  markersize=3 if len(data) > 50 else 5)
        for front, label in zip(fronts, names_of_runs):
            if not (args.reference or same_shape(name, front)):
                continue
            rms, n = deviation(front.t, front.z, data)
            shift, least = best_shift(front.t, front.z, data)
            fig.tell(f"{label}: {REFERENCES[name].label}: RMS deviation of Z {rms:.3f} over {n} "
                     f"points; {least:.3f} with T shifted by {shift:+.2f}", run=label,
                     reference=name, rms=rms, points=n, shift=shift, rms_shifted=least)
    last = max(f.t[-1] for f in fronts)
    axes.set(xlim=(0, 1.15 * last), ylim=(0.9, 1.15 * max(f.z.max() for f in fronts)))
    axes.set_xlabel(r"$T = t\,\sqrt{n^2 g/a}$ (1)")
    axes.set_ylabel(r"front $Z = x/a$ (1)")
    axes.legend(loc="upper left")
    ratios = " and ".join(f"{r:.3g}" for r in sorted({round(f.ratio, 2) for f in fronts}))
    style.title(axes, args.title or f"Dam-break front, column {ratios} times as high as wide",
                fronts[0].title if len(fronts) == 1 else "")
    return fig
