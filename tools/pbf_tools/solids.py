"""Particles on the surfaces of obstacles and walls, for networks that know solids by particles only."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from .errors import BadInput
from .lattice import lattice

Profile = list[tuple[float, float]]  # distance from the axis, place along it


@dataclass(frozen=True)
class Solid:
    """An obstacle of a scene as particles: one layer, whose centers lie half a spacing below its
    surface. `points` (N, 3), m, where the scene puts them; `middle` (3,), about which poses turn
    them."""

    name: str
    moves: bool
    middle: np.ndarray
    points: np.ndarray

    def at(self, turn: np.ndarray, middle: np.ndarray) -> np.ndarray:
        """The points in a pose of Run.obstacle_pose, or (poses, N, 3) in several."""
        return middle[..., None, :] + (self.points - self.middle) @ np.swapaxes(turn, -1, -2)


def solid_of(obstacle: Mapping[str, Any], spacing: float, flat: bool, low: np.ndarray,
             high: np.ndarray) -> Solid:
    """The particles of an obstacle as a resolved scene says it; those outside the domain, from low
    to high (3,), are left out where it does not move. flat: in the plane x, z.

    BadInput for a shape that is not known here, and for a plane that moves, which has no end.
    """
    shape, name = obstacle["shape"], str(obstacle["name"])
    moves = "motion" in obstacle or "free" in obstacle
    keys = {key: np.asarray(value, float) for key, value in obstacle.items()
            if key in ("min", "max", "center", "from", "to", "radius", "point", "normal",
                       "turn_axis", "turn_angle")}
    if shape == "box":
        middle = (keys["min"] + keys["max"]) / 2
        turn = turn_about(keys.get("turn_axis", np.array([0, 0, 1])), float(keys.get("turn_angle", 0)))
        points = middle + box_shell(keys["max"] - keys["min"], spacing, flat) @ turn.T
    elif shape == "sphere" or shape == "cylinder" and flat:
        middle = keys["center"] if shape == "sphere" else (keys["from"] + keys["to"]) / 2
        points = middle + round_shell(_arc(float(keys["radius"]), 0, spacing), spacing, flat)
    elif shape in ("cylinder", "capsule"):
        middle, way = (keys["from"] + keys["to"]) / 2, keys["to"] - keys["from"]
        profile = (_can if shape == "cylinder" else _arc)(
            float(keys["radius"]), float(np.linalg.norm(way)), spacing)
        points = middle + round_shell(profile, spacing, flat) @ frame_along(way)
    elif shape == "plane" and not moves:
        middle = keys["point"]
        points = _plane(middle, keys["normal"], spacing, flat, low, high)
    else:
        what = "a plane that moves" if shape == "plane" else f"a {shape}"
        raise BadInput(f"obstacle {name} is {what}, of which no particles can be made here; leave "
                       "obstacles out with --no-solids")
    if not moves:
        points = points[np.all((points >= low) & (points <= high), axis=1)]
    return Solid(name, moves, middle, points)


def walls(low: np.ndarray, high: np.ndarray, spacing: float, walled: np.ndarray,
          flat: bool) -> np.ndarray:
    """Particles (N, 3) of the walls of the domain, half a spacing outside of it. walled: (3, 2),
    which faces, below and above, are walls."""
    lines, outside = [], []
    for a in range(3):
        cells = max(1, round((high[a] - low[a]) / spacing))
        edge = (high[a] - low[a]) / cells
        numbers = np.arange(-1, cells + 1)
        there = (walled[a, 0] | (numbers >= 0)) & (walled[a, 1] | (numbers < cells))
        if a == 1 and flat:
            lines.append(np.array([(low[a] + high[a]) / 2]))
            outside.append(np.array([False]))
        else:
            lines.append(low[a] + (numbers[there] + 0.5) * edge)
            outside.append(((numbers < 0) | (numbers >= cells))[there])
    return lattice(lines)[np.any(lattice(outside), axis=1)]


def turn_about(axis: np.ndarray, degrees: float) -> np.ndarray:
    """The rotation (3, 3) about an axis by the right-hand rule (Rodrigues' formula).

    >>> turn_about(np.array([0, 0, 2.0]), 90).round(12).tolist()
    [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
    """
    x, y, z = np.asarray(axis, float) / np.linalg.norm(axis)
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = math.radians(degrees)
    return np.eye(3) + math.sin(angle) * k + (1 - math.cos(angle)) * k @ k


def frame_along(way: np.ndarray) -> np.ndarray:
    """Three unit vectors at right angles (3, 3), as rows; the last has this direction, and the
    first has no y where that can be."""
    last = np.asarray(way, float) / np.linalg.norm(way)
    first = np.cross([0.0, 1, 0], last)
    if np.linalg.norm(first) < 1e-9:
        first = np.array([1.0, 0, 0])
    first /= np.linalg.norm(first)
    return np.array([first, np.cross(last, first), last])


def box_shell(size: np.ndarray, spacing: float, flat: bool) -> np.ndarray:
    """The outer cells of a box about 0 that is cut into cells of about a spacing."""
    cells = [1 if flat and a == 1 else max(1, round(size[a] / spacing)) for a in range(3)]
    numbers = lattice([np.arange(n) for n in cells])
    last = np.array(cells) - 1
    outer = [(numbers[:, a] == 0) | (numbers[:, a] == last[a]) for a in range(3)
             if a != 1 or not flat]
    return ((numbers + 0.5) / cells - 0.5)[np.any(outer, axis=0)] * size


def round_shell(profile: Profile, spacing: float, flat: bool) -> np.ndarray:
    """A body about the z axis: a ring of about a spacing at every point of its profile; flat: the
    profile and its mirror image, in the plane x, z."""
    rings = []
    for radius, z in profile:
        number = max(1, round(2 * math.pi * radius / spacing))
        if flat:
            number = 1 if radius < spacing / 4 else 2
        angle = 2 * math.pi * np.arange(number) / number
        rings.append(np.column_stack([radius * np.cos(angle), radius * np.sin(angle) * (not flat),
                                      np.full(number, z)]))
    return np.concatenate(rings)


def _arc(radius: float, length: float, spacing: float) -> Profile:
    """Of a ball, and with a length of a capsule."""
    r = max(radius - spacing / 2, 0)
    steps = max(2, round(math.pi * r / 2 / spacing))
    quarter = [(r * math.sin(a), r * math.cos(a)) for a in
               (math.pi / 2 * k / steps for k in range(steps + 1))]
    along = max(1, round(length / spacing)) if length else 0
    straight = [(r, length / 2 - length * k / along) for k in range(1, along)]
    top = [(p, z + length / 2) for p, z in quarter]
    return top + straight + [(p, -z) for p, z in reversed(top if length else top[:-1])]


def _can(radius: float, length: float, spacing: float) -> Profile:
    """Of a cylinder."""
    r, end = max(radius - spacing / 2, 0), max(length - spacing, 0) / 2
    across = max(1, round(r / spacing))
    lid = [(r * k / across, end) for k in range(across + 1)]
    along = max(1, round(2 * end / spacing)) if end else 0
    side = [(r, end - 2 * end * k / along) for k in range(1, along)]
    return lid + side + ([(p, -z) for p, z in reversed(lid)] if end else [])


def _plane(point: np.ndarray, normal: np.ndarray, spacing: float, flat: bool, low: np.ndarray,
           high: np.ndarray) -> np.ndarray:
    """A lattice half a spacing behind a plane, large enough for the domain."""
    first, second, out = frame_along(normal)
    reach = spacing * math.ceil(np.linalg.norm(high - low) / spacing)
    middle = (low + high) / 2
    foot = middle - out * np.dot(middle - point, out) - out * spacing / 2
    line = np.arange(-reach, reach + spacing / 2, spacing)
    if flat:  # the normal has no y, and so has `first`
        return foot + line[:, None] * first
    return foot + (line[:, None, None] * first + line[None, :, None] * second).reshape(-1, 3)
