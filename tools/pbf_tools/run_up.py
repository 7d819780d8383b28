"""How far waves run up a slope, from the frames of a run."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .errors import BadInput
from .run_file import Run
from .scene_text import gravity_in, plane_in
from .table import Table
from .wave_statistics import held_side

NEAR = 3  # spacings: fluid so close to the slope is on it
FEW = 50  # run-ups, of which 2 % are one


@dataclass(frozen=True)
class RunUp:
    """The end of the connected fluid on a slope in every frame: `time` (s), and its `height` (m)
    above the still `level` (m, along gravity in the scene's coordinates); nan where no fluid is on
    the slope. `maxima`: `time` and `height` of every run-up, from one time below its own mean to the
    next."""

    time: np.ndarray
    height: np.ndarray
    level: float
    maxima: Table

    @property
    def highest(self) -> float:
        """The highest of all frames, m."""
        return float(np.nanmax(self.height))

    @property
    def r2(self) -> float:
        """R2%, the height that 2 % of the run-ups exceed, m; nan for fewer than 50."""
        found = self.maxima["height"]
        return float(np.quantile(found, 0.98)) if len(found) >= FEW else math.nan


def run_up(run: Run, obstacle: str, *, level: float | None = None, gap: float = 3.0,
           apart: float = 0.0) -> RunUp:
    """Where the fluid on a slope ends in every frame. The slope is an obstacle of shape `plane`;
    fluid is on it up to the first gap of more than `gap` spacings along it, so drops of a splash do
    not count. `level`: of the still water (m, by default half a spacing above the highest particle of
    the first frame, which has to be at rest). Of maxima less than `apart` (s) after each other, the
    highest counts: give half a period, as thin tongues tear and join.

    Water thinner than a particle is not there at all, so heights are low by about a spacing (look at
    the first frame, at rest), and a tongue of one layer tears: a solitary wave of 0.3 D, D = 20
    spacings, on 1:19.85 came up 0.42, 0.47, 0.50, 0.54 D by gaps of 2, 3, 4, 5 spacings, its outermost
    drop 0.87 D; Synolakis 1987 measured 0.55 D. Frames have to follow each other quickly
    (output.every), since a maximum between two is not seen.

        up = run_up(pbf_tools.open("out/beach"), "beach"); up.highest, up.r2
    """
    point, normal = plane_in(run.scene, obstacle, str(run.path))
    gravity = gravity_in(run.scene, str(run.path))
    if not gravity.any():
        raise BadInput(f"{run.path}: without gravity nothing runs up a slope")
    d, up = float(run.info["spacing"]), -gravity / np.linalg.norm(gravity)
    out = normal / np.linalg.norm(normal)
    along = up - np.dot(up, out) * out
    if np.linalg.norm(along) < 1e-6:
        raise BadInput(f"{run.path}: obstacle {obstacle} is level; nothing can run up it")
    along /= np.linalg.norm(along)
    if not len(run.frames):
        raise BadInput(f"{run.path}: this run has no frame yet, and run-up is read from frames")
    still = float((run["position"][0] @ up).max()) + d / 2 if level is None else level
    ends = np.array([_end(frame["position"] - point, along, out, d, gap) for frame in run.frames])
    height = np.dot(point, up) + ends * np.dot(along, up) - still
    if not np.isfinite(height).any():
        raise BadInput(f"{run.path}: no fluid within {NEAR} spacings of obstacle {obstacle} in any "
                       "frame")
    return RunUp(run.times, height, still, _maxima(run.times, height, d, apart))


def _end(x: np.ndarray, along: np.ndarray, out: np.ndarray, d: float, gap: float) -> float:
    """The place along the slope up to which fluid is connected, from its lowest place on."""
    there = np.sort(x[np.abs(x @ out) <= NEAR * d] @ along)  # particles on it may round to below
    if not len(there):
        return math.nan
    holes = np.flatnonzero(np.diff(there) > gap * d)
    return float(there[holes[0]] if len(holes) else there[-1])


def _maxima(time: np.ndarray, height: np.ndarray, d: float, apart: float) -> Table:
    """The highest of every part above the mean, which begins and ends d/2 beyond it; without a part
    that the end of the run cuts off while it rises."""
    side = held_side(np.where(np.isnan(height), -np.inf, height - np.nanmean(height)), d)
    high = np.concatenate([[False], side == 1, [False]])
    starts, ends = (np.flatnonzero(high[1:] != high[:-1])[k::2] for k in (0, 1))
    tops: list[int] = []
    for a, b in zip(starts, ends):
        top = a + int(np.nanargmax(height[a:b]))
        if not tops or time[top] - time[tops[-1]] >= apart:
            tops.append(top)
        elif height[top] > height[tops[-1]]:
            tops[-1] = top
    if tops and tops[-1] == len(height) - 1:
        tops.pop()
    return Table({"time": time[tops], "height": height[tops]}, {"time": "s", "height": "m"})
