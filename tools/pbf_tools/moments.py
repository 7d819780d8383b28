"""Mean and standard deviation of velocities and accelerations of a data set, read in blocks."""

from __future__ import annotations

import numpy as np

ROUNDING = 3e-7  # of an acceleration, relative to positions in float


class Moments:
    """As LagrangeBench defines them: differences of positions from frame to frame, and of these,
    without division by the time; over the particles and frames of a trajectory, then over
    trajectories, each of which counts the same.

    box (D,): the length over which positions repeat along a periodic axis, else inf.

    >>> moments = Moments(np.array([np.inf]))
    >>> moments.add(np.array([[[0.0]], [[1.0]], [[3.0]]]))
    >>> moments.end()
    >>> moments.values(3.0)
    {'vel_mean': [1.5], 'vel_std': [0.5], 'acc_mean': [1.0], 'acc_std': [1.0]}
    """

    def __init__(self, box: np.ndarray):
        self._box = box
        self._tail = np.zeros((0, 0, len(box)))  # positions before the next block, at most two
        self._sums = {kind: [0, np.zeros(len(box)), np.zeros(len(box))] for kind in ("vel", "acc")}
        self._means: dict[str, list[tuple[np.ndarray, np.ndarray]]] = {"vel": [], "acc": []}

    def add(self, x: np.ndarray) -> None:
        """The next positions of a trajectory, (frames, particles, D)."""
        tail = self._tail if len(self._tail) else x[:0]
        x = np.concatenate([tail, x])
        velocity = self._way(x)
        # The first velocity of a tail of two has been counted.
        self._count("vel", velocity[max(0, len(tail) - 1):])
        self._count("acc", np.diff(velocity, axis=0))
        self._tail = x[-2:]

    def end(self) -> None:
        """The end of a trajectory."""
        for kind, (number, total, squares) in self._sums.items():
            if number:
                self._means[kind].append((total / number, squares / number))
            self._sums[kind] = [0, np.zeros_like(total), np.zeros_like(total)]
        self._tail = self._tail[:0]

    def values(self, largest: float) -> dict[str, list[float]]:
        """vel_mean, vel_std, acc_mean, acc_std, each (D,). A deviation below the rounding of
        coordinates of this size, m, in float is that of an axis without motion: it is 1, so that it
        can be divided by."""
        out: dict[str, list[float]] = {}
        for kind, parts in self._means.items():
            mean = np.mean([m for m, _ in parts], axis=0) if parts else np.zeros(len(self._box))
            squares = np.mean([s for _, s in parts], axis=0) if parts else np.zeros(len(self._box))
            std = np.sqrt(np.maximum(squares - mean**2, 0))
            out[f"{kind}_mean"] = mean.tolist()
            out[f"{kind}_std"] = np.where(std <= ROUNDING * largest, 1.0, std).tolist()
        return out

    def _way(self, x: np.ndarray) -> np.ndarray:
        way = np.diff(x, axis=0)
        joined = np.isfinite(self._box)
        length = self._box[joined]
        way[..., joined] -= length * np.round(way[..., joined] / length)
        return way

    def _count(self, kind: str, values: np.ndarray) -> None:
        number, total, squares = self._sums[kind]
        flat = values.reshape(-1, values.shape[-1])
        self._sums[kind] = [number + len(flat), total + flat.sum(axis=0),
                            squares + (flat**2).sum(axis=0)]
