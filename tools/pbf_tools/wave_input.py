"""What the command `waves` reads: level gauges of a run, or columns of a table."""

from __future__ import annotations

import argparse
import math
from dataclasses import dataclass

import numpy as np

from . import measured, units
from .errors import BadInput, UnknownName, unknown
from .gauges import Gauge
from .logs import read_run
from .run_file import Run
from .scene_text import gravity_in
from .table import need, read_csv
from .wave_records import Between


@dataclass(frozen=True)
class Given:
    """Gauges (s, m), where they are along the waves (m), the depth (m), gravity (m/s^2), the height
    of the smallest wave to count (m), and a title."""

    gauges: list[Gauge]
    places: list[float]
    depth: float
    gravity: float
    smallest: float
    title: str


def read(args: argparse.Namespace, between: Between) -> Given:
    """The gauges that the command line names."""
    gravity, smallest, title = 9.81, args.smallest, args.run_file
    if args.run_file.endswith(".csv"):
        gauges, places = columns_of(args.run_file, args)
    else:
        run = read_run(args.run_file)
        gauges, places = gauges_of(run, args)
        gravity = float(np.linalg.norm(gravity_in(run.scene, args.run_file)))
        smallest = float(run.info["spacing"]) if smallest is None else smallest
        title = run.title
    depth = depth_of(gauges, between) if args.depth is None else args.depth
    return Given(gauges, places, depth, gravity, smallest or 0.0, title)


def names_and_places(text: str) -> dict[str, float | None]:
    """
    >>> names_and_places("g1,eta=2.5")
    {'g1': None, 'eta': 2.5}
    """
    found: dict[str, float | None] = {}
    for part in text.split(","):
        name, equals, place = (word.strip() for word in part.partition("="))
        if not name or name in found:
            raise BadInput(f"--gauges {text}: " + (f"{name} is there twice" if name else
                                                   "a name is missing"))
        found[name] = number(place, f"--gauges {part.strip()}") if equals else None
    if len(found) < 2:
        raise BadInput(f"--gauges {text}: incident and reflected waves need two gauges or more")
    return found


def number(text: str, option: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise BadInput(f"{option}: {text or 'nothing'} is not a number")
    return value


def pair(text: str | None, option: str) -> Between:
    """Two ascending numbers."""
    if text is None:
        return None
    parts = [number(part.strip(), f"{option} {text}") for part in text.split(",")]
    if len(parts) != 2 or not parts[0] < parts[1]:
        raise BadInput(f"{option} {text}: give two numbers that ascend, as {option} 20,120")
    return parts[0], parts[1]


def gauges_of(run: Run, args: argparse.Namespace) -> tuple[list[Gauge], list[float]]:
    """The gauges that were asked for, and where they are along the waves."""
    gauges, places = [], []
    every = run.gauges
    for name, place in names_and_places(args.gauges).items():
        if name not in every:
            raise UnknownName(f"{args.run_file}: {unknown('gauge', name, every)}")
        gauge = every[name]
        if gauge.kind != "level":
            raise BadInput(f"{args.run_file}: gauge {name} is one of kind {gauge.kind}; waves are "
                           "read from gauges of kind level")
        if place is None and args.axis not in gauge.at:
            raise BadInput(f"{args.run_file}: gauge {name} ({gauge.place}) has no {args.axis}; "
                           f"choose another --axis, or give its position, {name}=X")
        gauges.append(gauge)
        places.append(gauge.at[args.axis] if place is None else place)
    return gauges, places


def columns_of(path: str, args: argparse.Namespace) -> tuple[list[Gauge], list[float]]:
    """The same of a table."""
    table, wanted = read_csv(path), names_and_places(args.gauges)
    need(table, list(wanted), path)
    clock = measured.time_column(table, args.time_column, path)
    for name in (clock, *wanted):
        if table[name].dtype.kind != "f":
            raise BadInput(f"{path}: column {name} is not one of numbers")
    without = [name for name, place in wanted.items() if place is None]
    if without:
        raise BadInput(f"{path}: a table does not say where {without[0]} is; give its position "
                       f"along the waves in m, --gauges {without[0]}=X,...")
    if args.depth is None:
        raise BadInput(f"{path}: give the depth of the still water in m, --depth D")

    if not measured.unit_of(table, clock) and clock not in measured.SECONDS:
        raise BadInput(f"{path}: column {clock} has no unit of time; name it {clock}_s if it is in "
                       "seconds, or choose another with --time-column")

    def numbers(name: str, unit: str, scale: float | None) -> np.ndarray:
        said = measured.unit_of(table, name) or unit
        own = units.factor(said, unit) if scale is None else scale
        if own is None:
            raise BadInput(f"{path}: column {name} is in {said}, expected {unit}; name another, or "
                           f"give --scale, the {unit} of one unit")
        return table[name] * own

    return [Gauge(name, "column", "", "m", numbers(clock, "s", None), numbers(name, "m", args.scale))
            for name in wanted], [float(place) for place in wanted.values() if place is not None]


def depth_of(gauges: list[Gauge], between: Between) -> float:
    """The mean of level gauges; BadInput when they stand in different depths."""
    inside = [np.ones(len(g.time), bool) if between is None else
              (g.time >= between[0]) & (g.time <= between[1]) for g in gauges]
    depths = [float(g.value[part].mean()) if part.any() else 0.0 for g, part in zip(gauges, inside)]
    if max(depths) > 1.05 * min(depths) and min(depths) > 0:
        raise BadInput(f"the gauges stand in different depths, {min(depths):.4g} to "
                       f"{max(depths):.4g} m; choose gauges over one, or give --depth")
    return float(np.mean(depths))
