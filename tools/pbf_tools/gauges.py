"""The readings of the gauges of a run."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

import h5py
import numpy as np

from . import index
from .errors import UnknownName, unknown


@dataclass(frozen=True, repr=False)
class Gauge:
    """Readings of a gauge: `value` has shape (readings,), of a velocity (readings, 3). `further` has
    what else its kind reads, by name, also as attributes: pressures have the `peak` of single
    updates, flows the `total` since the start (kg); None where a gauge has none.

    >>> gauge = Gauge("H", "level", "x = 0 m", "m", np.array([0.0, 1.0]), np.array([0.5, 0.25]))
    >>> time, value = gauge
    >>> value
    array([0.5 , 0.25])
    """

    name: str
    kind: str  # level, velocity, flow, pressure ...
    place: str
    unit: str
    time: np.ndarray
    value: np.ndarray
    further: dict[str, np.ndarray] = field(default_factory=dict)
    further_units: dict[str, str] = field(default_factory=dict)

    @property
    def at(self) -> dict[str, float]:
        """The coordinates that its place says, m: of a level those across its line.

        >>> Gauge("H", "level", "x = 0.7 m, y = 0.1 m", "m", np.array([]), np.array([])).at
        {'x': 0.7, 'y': 0.1}
        >>> Gauge("U", "velocity", "(0.2, 0.1, 1e-05) m", "m/s", np.array([]), np.array([])).at
        {'x': 0.2, 'y': 0.1, 'z': 1e-05}
        >>> Gauge("R", "line", "(0, 0.1, 0) to (1, 0.1, 1) m", "m", np.array([]), np.array([])).at
        {}
        """
        if " to " in self.place:  # a line
            return {}
        said = re.findall(r"([xyz]) = ([^ ,]+) m", self.place)
        point = re.search(r"\(([^)]*)\) m", self.place)
        if not said and point:
            said = list(zip("xyz", point[1].split(", ")))
        return {axis: float(number) for axis, number in said}

    def __getattr__(self, name: str) -> np.ndarray | None:
        further = self.__dict__.get("further", {})
        if name not in further and name not in ("total", "peak"):
            raise AttributeError(unknown("attribute", name, further))
        return further.get(name)

    def __iter__(self) -> Iterator[np.ndarray]:
        return iter((self.time, self.value))

    def __repr__(self) -> str:
        return f"<gauge {self.name}: {self.kind} ({self.unit}) at {self.place}, " \
               f"{len(self.time)} readings>"


class Gauges(dict):
    """Gauges by name; the name of one that is not there gets a suggestion."""

    def __missing__(self, name: str) -> Gauge:
        raise UnknownName(unknown("gauge", name, self))


def read_gauges(file: h5py.File) -> Gauges:
    """All of them, empty where the scene has none."""
    group = file.get("pbf/gauges")
    if group is None:
        return Gauges()
    more = {part: d for part, d in group.items() if isinstance(d, h5py.Group)}
    data = {name: d for name, d in group.items()
            if isinstance(d, h5py.Dataset) and name not in ("time", "update")}
    every = [group["time"], *data.values(), *(d for g in more.values() for d in g.values())]
    # A process killed while it wrote them may leave columns of different lengths.
    rows = min(len(d) for d in every)
    time = group["time"][:rows]
    return Gauges(
        {name: Gauge(name, index._text(d.attrs.get("kind", "")),
                     index._text(d.attrs.get("place", "")), index._text(d.attrs.get("units", "1")),
                     time, d[:rows],
                     {part: g[name][:rows] for part, g in more.items() if name in g},
                     {part: index._text(g[name].attrs.get("units", "1"))
                      for part, g in more.items() if name in g})
         for name, d in data.items()})
