"""Fields and frames of a run file: arrays that are read when they are indexed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, overload

import h5py
import numpy as np

from . import index
from .errors import BadInput, MissingPackage

if TYPE_CHECKING:
    import pyvista

    from .run_file import Run


class Field:
    """One quantity over all frames and particles, read when it is indexed.

    `field[k]` is frame k, shape (particles, components) or (particles,) for a scalar; a second
    index picks rows (particles), a third one a component. Several frames at once need the same
    number of particles in each.

    >>> import pbf_tools
    >>> run = pbf_tools.open("run.vtkhdf")
    >>> velocity = run["velocity"]
    >>> velocity.shape, velocity.unit
    ((26, 4000, 3), 'm/s')
    >>> velocity[-1].shape, velocity[0, 7].shape, velocity[::5, 100:200, 2].shape
    ((4000, 3), (3,), (6, 100))
    """

    def __init__(self, run: Run, name: str, place: index.Place):
        self.name = name
        self.unit = place.unit
        self.dtype = place.dtype
        self._run = run
        self._place = place

    @property
    def shape(self) -> tuple[int | None, ...]:
        """(frames, particles, components); None for particles when their number varies."""
        counts = self._run.counts
        same = len(counts) == 0 or bool(np.all(counts == counts[0]))
        particles = (int(counts[0]) if len(counts) else 0) if same else None
        tail = (self._place.components,) if self._place.components > 1 else ()
        return (len(counts), particles, *tail)

    def __len__(self) -> int:
        return len(self._run.counts)

    def __repr__(self) -> str:
        return f"<{self.name} in {self.unit}, {self.shape} {self.dtype}>"

    def __getitem__(self, key: object) -> np.ndarray:
        keys = key if isinstance(key, tuple) else (key,)
        if len(keys) > len(self.shape) or any(k is None or k is Ellipsis for k in keys):
            raise IndexError(f"{self.name} takes up to {len(self.shape)} indices: "
                             "frame, particles, component")
        rows = keys[1] if len(keys) > 1 else slice(None)
        frames = np.arange(len(self))[keys[0]]
        many = frames.ndim > 0
        frames = np.atleast_1d(frames)
        counts = self._run.counts[frames]
        if len(counts) and np.any(counts != counts[0]):
            raise BadInput(f"{self._run.path}: the number of particles varies over these frames; "
                           f"read them one by one, or one particle with run.track(id)")

        def read(file: h5py.File) -> list[np.ndarray]:
            data = file[self._place.path]
            return [self._frame(data, k, rows) for k in frames]

        parts = self._run._read(read, f"cannot read {self.name}")
        if not many:
            out = parts[0]
        elif parts:
            out = np.stack(parts)
        else:
            particles = int(self._run.counts[0]) if len(self) else 0
            tail = (self._place.components,) if self._place.components > 1 else ()
            out = np.empty((0, particles, *tail), self.dtype)[:, rows]
        return out[(..., *keys[2:])] if len(keys) > 2 else out

    def _frame(self, data: h5py.Dataset, k: int, rows: object) -> np.ndarray:
        first, n = int(self._place.offsets[k]), int(self._run.counts[k])
        if first < 0 or first + n > len(data):
            raise ValueError(f"{self.name} ends before frame {k} does")
        if isinstance(rows, slice):
            start, stop, step = rows.indices(n)
            if step > 0:
                return data[first + start:first + max(start, stop):step]
        if isinstance(rows, (int, np.integer)):
            if not -n <= rows < n:
                raise IndexError(f"no particle {rows}; frame {k} has {n}")
            return data[first + int(rows) % n]
        return data[first:first + n][rows]


class Frame:
    """One frame: time (s), update, count of particles; fields by name, shape (count, ...)."""

    def __init__(self, run: Run, k: int):
        self.k = k
        self.time = float(run.times[k])
        self.update = int(run.updates[k])
        self.count = int(run.counts[k])
        self._run = run

    def __getitem__(self, name: str) -> np.ndarray:
        return self._run[name][self.k]

    def polydata(self) -> pyvista.PolyData:
        """The frame for PyVista, all fields as point data: `run.frames[-1].polydata().plot(
        scalars="velocity")` colours by speed. MissingPackage without PyVista."""
        try:
            import pyvista
        except ImportError:
            raise MissingPackage("PyVista is not installed: pip install pyvista") from None
        data = pyvista.PolyData(self["position"])
        for name in self._run.fields:
            if name != "position":
                data[name] = self[name]
        return data

    def __repr__(self) -> str:
        return f"<frame {self.k}: t = {self.time:g} s, {self.count} particles>"


class Frames(Sequence["Frame"]):
    """The frames of a run as a sequence: `len(run.frames)`, `run.frames[-1]`, iteration."""

    def __init__(self, run: Run):
        self._run = run

    def __len__(self) -> int:
        return len(self._run.times)

    @overload
    def __getitem__(self, k: int) -> Frame: ...
    @overload
    def __getitem__(self, k: slice) -> list[Frame]: ...
    def __getitem__(self, k: int | slice) -> Frame | list[Frame]:
        if isinstance(k, slice):
            return [Frame(self._run, i) for i in range(len(self))[k]]
        if not -len(self) <= k < len(self):
            raise IndexError(f"{self._run.path}: no frame {k}; the file has {len(self)}")
        return Frame(self._run, range(len(self))[k])
