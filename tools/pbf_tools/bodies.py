"""The obstacles of a run that the fluid moves."""

from __future__ import annotations

from dataclasses import dataclass

import h5py
import numpy as np

from .errors import UnknownName, unknown
from .index import _text


@dataclass(frozen=True, repr=False)
class Body:
    """A free body, which the fluid moves: an array over the frames for each of `middle`
    (frames, 3), m; `turn` (frames, 3, 3), the rotation from its pose in the scene; `velocity`
    (frames, 3), m/s, of its center of mass; `spin` (frames, 3), rad/s. All along the scene's axes.
    """

    name: str
    time: np.ndarray  # of the frames, s
    middle: np.ndarray
    turn: np.ndarray
    velocity: np.ndarray
    spin: np.ndarray

    def __repr__(self) -> str:
        return f"<body {self.name}: {len(self.time)} frames>"


class Bodies(dict):
    """Free bodies by name, in the order of the scene; the name of one that is not there gets a
    suggestion."""

    def __missing__(self, name: str) -> Body:
        raise UnknownName(unknown("free body", name, self))


def read_bodies(file: h5py.File, times: np.ndarray) -> Bodies:
    """The free bodies of a run file with frames at these times."""
    data = file.get("pbf/frames/bodies")
    if data is None:
        return Bodies()
    columns = [_text(c) for c in data.attrs["columns"]]
    numbers = data[:len(times)]  # what lies beyond the committed frames may be half written

    def part(body: int, what: str) -> np.ndarray:
        chosen = [k for k, name in enumerate(columns) if name.rpartition("_")[0] == what]
        return numbers[:, body, chosen]

    return Bodies({name: Body(name, times, part(k, ""), part(k, "turn").reshape(-1, 3, 3),
                              part(k, "velocity"), part(k, "spin"))
                   for k, name in enumerate(map(_text, data.attrs["names"]))})
