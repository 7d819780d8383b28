"""The loads of walls and obstacles of a run, over windows of time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .errors import BadInput, UnknownName, unknown
from .table import Table


@dataclass(frozen=True, repr=False)
class Load:
    """Forces on a wall or obstacle, along the scene's axes, at the times of the log.

    `force` (rows, 3), N: means since the row before. `impulse` (rows, 3), N s: since the start of
    the run. Means over any window are differences of impulses, so they do not depend on how often
    the run was measured.

    >>> t = np.array([0.0, 0.1, 0.2, 0.3])
    >>> load = Load("post", t, np.zeros((4, 3)), np.array([[0, 0, 0], [2, 0, 0], [2, 0, 0], [3, 0, 0.]]))
    >>> [float(f) for f in load.mean(0.2)[:, 0]]
    [20.0, 10.0, 5.0, 10.0]
    >>> load.peak(0.1)
    (20.0, 0.05)
    """

    name: str
    time: np.ndarray  # s
    force: np.ndarray
    impulse: np.ndarray

    def mean(self, window: float) -> np.ndarray:
        """The force averaged over `window` s about each row (at the ends over what there is of it),
        shape (rows, 3), N. BadInput for a window shorter than the time between two rows."""
        steps = np.diff(self.time)
        if not len(steps) or not window >= float(np.median(steps)) * (1 - 1e-9):
            raise BadInput(f"load {self.name}: a window of {window:g} s is shorter than the time "
                           "between two rows of the log" +
                           (f", {np.median(steps):g} s: give a longer one, or run with a smaller "
                            "measure_every" if len(steps) else ""))
        return self._mean(self.time, window)

    def peak(self, window: float, axis: int | None = None) -> tuple[float, float]:
        """The largest mean over `window` s (N) and the middle of that window (s): of the force's
        length, or with `axis` 0, 1, 2 of a component by size, with its sign. Windows begin and end
        at rows of the log where it has them."""
        self.mean(window)
        half = 0.5 * window
        middles = np.unique(np.concatenate([self.time + half, self.time - half]))
        middles = middles[(middles - half >= self.time[0] - 1e-9)
                          & (middles + half <= self.time[-1] + 1e-9)]
        if not len(middles):
            raise BadInput(f"load {self.name}: a window of {window:g} s is longer than the run")
        force = self._mean(middles, window)
        size = np.linalg.norm(force, axis=1) if axis is None else np.abs(force[:, axis])
        k = int(np.argmax(size))
        return float(size[k] if axis is None else force[k, axis]), float(middles[k])

    def _mean(self, middles: np.ndarray, window: float) -> np.ndarray:
        begin = np.clip(middles - 0.5 * window, self.time[0], self.time[-1])
        end = np.clip(middles + 0.5 * window, self.time[0], self.time[-1])
        rise = [np.interp(end, self.time, i) - np.interp(begin, self.time, i)
                for i in self.impulse.T]
        return np.stack(rise, axis=1) / (end - begin)[:, None]

    def __repr__(self) -> str:
        return f"<load on {self.name}: {len(self.time)} rows>"


def load_of(log: Table, name: str, path: str) -> Load:
    """That of a log. UnknownName where it has none; BadInput for a run of an earlier version."""
    every = sorted({column.split("/")[1] for column in log if column.startswith("load/")})
    if name not in every:
        raise UnknownName(f"{path}: {unknown('load', name, every)}")
    if f"load/{name}/impulse_x" not in log:
        raise BadInput(f"{path}: its log has no impulses, as it is of an earlier version")

    def vectors(of: str) -> np.ndarray:
        return np.stack([log[f"load/{name}/{of}_{axis}"] for axis in "xyz"], axis=1)

    return Load(name, log["time"], vectors("force"), vectors("impulse"))
