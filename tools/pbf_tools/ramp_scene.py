"""One random scene of water that falls on turned plates; `ramps` writes sets of them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .lattice import lattice
from .solids import turn_about

# By the number of dimensions: the box, m, and the share of it that is water on average, m^D.
BOX = {2: np.array([1.0, 1.0]), 3: np.array([1.0, 0.6, 1.0])}
WATER = {2: 0.2, 3: 0.06}
GAP = {2: 3.0, 3: 2.5}  # spacings between plates, and to the walls: water does not clog there
DEPTH = (0.15, 0.35)  # m, of plates along their axis
TRIES = 200


@dataclass(frozen=True)
class Settings:
    """What all scenes of a set have in common. Lengths in m, times in s."""

    seed: int = 0
    dimensions: int = 2
    particles: int = 2000
    frames: int = 400
    every: float | None = None

    @property
    def spacing(self) -> float:
        """To three digits."""
        d = (WATER[self.dimensions] / self.particles) ** (1 / self.dimensions)
        return float(f"{d:.3g}")

    @property
    def interval(self) -> float:
        """Between frames: as given, else two of the longest safe steps, of which the number below
        with the first digits 1, 2, 2.5 or 5 is taken.

        >>> Settings().interval, Settings(dimensions=3).interval
        (0.0025, 0.0025)
        """
        if self.every is not None:
            return self.every
        longest = 4 * self.step_limit
        power = 10.0 ** math.floor(math.log10(longest))
        return float(f"{max(k for k in (1, 2, 2.5, 5) if k * power <= longest) * power:.9g}")

    @property
    def step_limit(self) -> float:
        """Half of what `time.step: auto` takes at most: where water hits a plate it is faster than
        at rest."""
        return 0.015 * math.sqrt(2 * self.spacing / 9.81)

    @property
    def updates(self) -> int:
        """Time steps from one frame to the next; up to 10 a number that divides it without a
        rest in decimals."""
        least = max(1, math.ceil(self.interval / self.step_limit * (1 - 1e-9)))
        return next((n for n in (1, 2, 4, 5, 8, 10) if n >= least), least)


@dataclass(frozen=True)
class Plate:
    """A box of these edges, turned about its middle. Vectors have three components, also where y
    does not count."""

    middle: np.ndarray
    size: np.ndarray
    axis: np.ndarray
    angle: float  # degrees

    @property
    def turn(self) -> np.ndarray:
        return turn_about(self.axis, self.angle)

    def distance(self, x: np.ndarray) -> np.ndarray:
        """Of points (N, 3) from its surface, m; negative inside."""
        return box_distance((x - self.middle) @ self.turn, self.size / 2)

    def surface(self, spacing: float) -> np.ndarray:
        """Points (N, 3) on the surface, with the corners, at most a spacing apart."""
        lines = [np.linspace(-s / 2, s / 2, 1 + max(1, math.ceil(s / spacing))) if s else
                 np.zeros(1) for s in self.size]
        grid = lattice(lines)
        outer = np.any((np.abs(grid) >= self.size / 2) & (self.size > 0), axis=1)
        return self.middle + grid[outer] @ self.turn.T


@dataclass(frozen=True)
class Water:
    """A block, or a ball: `size` are the edges, or all the diameter."""

    ball: bool
    middle: np.ndarray
    size: np.ndarray
    velocity: np.ndarray

    def distance(self, x: np.ndarray) -> np.ndarray:
        """As of Plate."""
        if self.ball:
            return np.linalg.norm(x - self.middle, axis=1) - self.size[0] / 2
        return box_distance(x - self.middle, self.size / 2)


def box_distance(p: np.ndarray, half: np.ndarray) -> np.ndarray:
    """Of points (N, 3) from the surface of a box about 0, m. An edge of length 0 does not count: the
    box is flat.

    >>> box_distance(np.array([[2.0, 9, 0], [0, 0, 0], [4, 0, 6]]), np.array([1.0, 0, 2])).tolist()
    [1.0, -1.0, 5.0]
    """
    q = (np.abs(p) - half)[:, half > 0]
    return np.linalg.norm(np.maximum(q, 0), axis=1) + np.minimum(q.max(axis=1), 0)


class Ramp:
    """One random scene. Sample k is the same however many there are: it has random numbers of its
    own, which follow from the seed of the set and k."""

    def __init__(self, settings: Settings, sample: int):
        self.s = settings
        self.flat = settings.dimensions == 2
        self.random = np.random.default_rng([settings.seed, sample])
        box = BOX[settings.dimensions]
        self.box = np.array([box[0], 0.0, box[1]]) if self.flat else box
        while True:  # nearly always done once
            self.water = self._water()
            self.plates = self._plates()
            if self.plates:
                break

    def _between(self, low: float, high: float) -> float:
        return float(self.random.uniform(low, high))

    def _water(self) -> Water:
        s, d = self.s, self.s.spacing
        count = s.particles * self._between(0.8, 1.2)
        ball = bool(self.random.integers(2))
        if ball:
            size = np.full(3, 2 * d * (math.sqrt(count / math.pi) if self.flat else
                                       (0.75 * count / math.pi) ** (1 / 3)))
        else:
            across = 1 if self.flat else round(self._between(0.5, 1.0) * self.box[1] / d)
            shape = math.exp(self._between(-1, 1) * math.log(2.5))  # width over height
            along = max(2, round(math.sqrt(count / across * shape)))
            # Of whole cells, so that none is cut.
            most = np.where(self.box > 0, np.floor(self.box / d + 1e-6), 1)
            size = np.minimum([along, across, max(2, round(count / along / across))], most) * d
        size = size * [1, not self.flat, 1]
        room = np.maximum(self.box - size, 0)
        lot = np.array([self._between(0, 1), self._between(0, 1), self._between(0.3, 1)])
        velocity = np.zeros(3)
        if self.random.integers(2):
            way = self._direction()
            velocity = way * self._between(0.5, 2) * [1, 1, -np.sign(way[2] or 1)]
        return Water(ball, size / 2 + room * lot, size, velocity)

    def _direction(self) -> np.ndarray:
        """A random unit vector."""
        way = self.random.normal(size=3) * [1, not self.flat, 1]
        return way / np.linalg.norm(way)

    def _plates(self) -> list[Plate]:
        """One under the water and up to three others; none when that has no room."""
        plates: list[Plate] = []
        number = int(self.random.integers(1, 5))
        for k in range(number):
            for _ in range(TRIES):
                plate = self._plate(under=k == 0)
                if self._fits(plate, plates):
                    plates.append(plate)
                    break
            else:
                if k == 0:
                    return []
        return plates

    def _plate(self, under: bool) -> Plate:
        d, w = self.s.spacing, self.water
        size = np.array([self._between(0.2, 0.5), 0 if self.flat else self._between(*DEPTH),
                         self._between(2, 3) * d])
        turn = 0 if self.flat else math.radians(self._between(-30, 30))
        low, high = np.zeros(3), self.box.copy()
        bottom = w.middle[2] - w.size[2] / 2
        if under:
            low[0], high[0] = w.middle[0] - w.size[0] / 2, w.middle[0] + w.size[0] / 2
            high[2] = bottom
        else:
            high[2] = w.middle[2]
        middle = np.array([self._between(a, b) for a, b in zip(low, high)])
        return Plate(middle, size, np.array([math.sin(turn), math.cos(turn), 0.0]),
                     self._between(-60, 60))

    def _fits(self, plate: Plate, others: list[Plate]) -> bool:
        d, gap = self.s.spacing, GAP[self.s.dimensions] * self.s.spacing
        inner = [a for a in range(3) if self.box[a]]
        corners = plate.surface(math.inf)  # says soon that most do not fit
        if np.minimum(corners, self.box - corners)[:, inner].min() < gap:
            return False
        surface = plate.surface(d)
        return bool(self.water.distance(surface).min() >= 1.5 * d and
                    all(o.distance(surface).min() >= gap and
                        plate.distance(o.surface(d)).min() >= gap for o in others))

    def text(self, name: str, head: str) -> str:
        """The scene as a file."""
        s, w = self.s, self.water
        body = f"shape: sphere, center: {self._vector(w.middle)}, radius: {w.size[0] / 2:.6g}" \
            if w.ball else f"shape: block, center: {self._vector(w.middle)}, " \
                           f"size: {self._vector(w.size)}"
        if w.velocity.any():
            body += f", velocity: {self._vector(w.velocity)}"
        plates = "".join(
            f"  - {{name: plate{k}, shape: box, center: {self._vector(p.middle)}, size: "
            f"{self._vector(p.size)},\n     turn_axis: [{', '.join(f'{v:.6g}' for v in p.axis)}], "
            f"turn_angle: {p.angle:.6g}}}\n" for k, p in enumerate(self.plates, 1))
        return (f"{head}\nname: {name}\ndimensions: {s.dimensions}\n"
                f"domain: {{min: {self._vector(np.zeros(3))}, max: {self._vector(self.box)}}}\n"
                f"fluid: {{spacing: {s.spacing:.9g}}}\n"
                f"bodies:\n  - {{{body}}}\n"
                f"obstacles:\n{plates}"
                f"time: {{step: {s.interval / s.updates:.9g}, "
                f"end: {s.interval * (s.frames - 1):.9g}}}\n"
                f"solver: {{iterations: 8}}\n"  # with 4, hard impacts gain a few % of energy
                f"viscosity: {{xsph: 0.05}}\n"
                f"output: {{every: {s.interval:.9g}, fields: []}}\n")

    def _vector(self, v: np.ndarray) -> str:
        return "[" + ", ".join(f"{v[a]:.6g}" for a in range(3) if a != 1 or not self.flat) + "]"
