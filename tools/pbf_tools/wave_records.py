"""Records of waves: pairs (time, elevation) in s and m, a gauge of a run among them, in a window of
time and at even steps."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from .errors import BadInput, note

Pair = Iterable[np.ndarray]  # a Gauge, or (time, elevation)
Between = tuple[float, float] | None

_EVEN = 1e-3  # of a step: what rounded times may be off
_GAP = 3      # median steps


@dataclass(frozen=True)
class Record:
    """Readings of one gauge: times (s), ascending, and the surface (m). `mean` is what was taken off
    the readings: the still level, as far as the window's mean is it."""

    name: str
    time: np.ndarray
    elevation: np.ndarray
    mean: float = 0.0

    def __iter__(self) -> Iterator[np.ndarray]:
        return iter((self.time, self.elevation))

    @property
    def step(self) -> float:
        """The usual time between two readings, s."""
        return float(np.median(np.diff(self.time)))

    @property
    def duration(self) -> float:
        """What the readings stand for, s: a step more than from the first to the last."""
        return float(self.time[-1] - self.time[0]) + self.step


def record(pair: Pair, between: Between = None, name: str = "the record") -> Record:
    """The readings in a window, with their mean taken off.

    A level gauge that reads 0 is dry there. BadInput for readings that are no numbers or dry, times
    that do not ascend, windows beyond the record and records of fewer than 8 readings.
    """
    name = getattr(pair, "name", name)
    time, value = (np.asarray(part, float) for part in pair)
    if time.ndim != 1 or value.shape != time.shape:
        raise BadInput(f"{name}: times and elevations must be two arrays of one length, here of "
                       f"shapes {time.shape} and {value.shape}")
    if not np.all(np.isfinite(time)) or np.any(np.diff(time) <= 0):
        raise BadInput(f"{name}: its times must be numbers that ascend")
    if len(time) < 8:
        raise BadInput(f"{name}: {len(time)} readings are too few for waves; 8 are the least")
    if getattr(pair, "kind", "") == "level":
        value = np.where(value == 0, np.nan, value)
    if between:
        first, last = between
        slack = 1.5 * float(np.median(np.diff(time)))
        if not time[0] - slack <= first < last <= time[-1] + slack:
            raise BadInput(f"{name}: the window of {first:g} to {last:g} s must lie within its "
                           f"readings, from {time[0]:g} to {time[-1]:g} s")
        kept = (time >= first - slack * 1e-6) & (time <= last + slack * 1e-6)
        time, value = time[kept], value[kept]
        if len(time) < 8:
            raise BadInput(f"{name}: {len(time)} readings from {first:g} to {last:g} s are too few "
                           "for waves; 8 are the least")
    bad = ~np.isfinite(value)
    if bad.any():
        raise BadInput(f"{name}: {np.count_nonzero(bad)} of {len(time)} readings are no numbers, or "
                       f"0 where a level gauge is dry, the first at {time[bad][0]:g} s; choose a "
                       "window without them, or another gauge")
    mean = float(value.mean())
    return Record(name, time, value - mean, mean)


def records(pairs: Sequence[Pair], between: Between = None) -> list[Record]:
    """`record` of each; those without a name are called gauge 1, gauge 2 ..."""
    return [record(pair, between, f"gauge {k}") for k, pair in enumerate(pairs, 1)]


def even(given: Record) -> Record:
    """The record at even steps: as it is when they are even to 1e-3, else resampled through the four
    readings around each time (cubic), which a note tells. BadInput where it has a gap."""
    if _is_even(given):
        return given
    span = given.time[-1] - given.time[0]
    return _on(given, np.linspace(given.time[0], given.time[-1], round(span / given.step) + 1))


def together(given: Sequence[Record]) -> list[Record]:
    """The records at the same even steps: as they are when they have them, else those of the longest
    step over the time that all have."""
    t = given[0].time
    if all(_is_even(r) and len(r.time) == len(t) and
           np.max(np.abs(r.time - t)) <= _EVEN * r.step for r in given):
        return list(given)
    first, last = max(r.time[0] for r in given), min(r.time[-1] for r in given)
    step = max(r.step for r in given)
    if last - first < 8 * step:
        raise BadInput(f"{', '.join(r.name for r in given)}: these records have fewer than 8 steps "
                       "of time in common")
    return [_on(r, np.linspace(first, last, round((last - first) / step) + 1)) for r in given]


def _is_even(given: Record) -> bool:
    t = given.time
    return bool(np.max(np.abs(t - np.linspace(t[0], t[-1], len(t)))) <= _EVEN * given.step)


def _on(given: Record, times: np.ndarray) -> Record:
    t, step = given.time, given.step
    gaps = np.diff(t)
    if gaps.max() > _GAP * step:
        k = int(gaps.argmax())
        raise BadInput(f"{given.name}: no reading from {t[k]:g} to {t[k + 1]:g} s, "
                       f"{gaps[k] / step:.0f} of its usual steps; choose a window without that gap")
    note(f"{given.name}: its times are not even, or not those of the others; resampled at steps of "
         f"{times[1] - times[0]:.4g} s (cubic)")
    value = cubic(t, given.elevation, times)
    return Record(given.name, times, value - value.mean(), given.mean + float(value.mean()))


def cubic(t: np.ndarray, y: np.ndarray, at: np.ndarray) -> np.ndarray:
    """The polynomial through the four readings around each time (Lagrange); of a wave with n readings
    in a period it is wrong by 0.023 (2 pi/n)^4 of the amplitude.

    >>> t = np.array([0.0, 1.0, 1.5, 3.0, 4.0])
    >>> cubic(t, t**3, np.array([0.5, 2.0, 3.5])).round(12).tolist()
    [0.125, 8.0, 42.875]
    """
    first = np.clip(np.searchsorted(t, at, side="right") - 2, 0, len(t) - 4)
    nodes = first[:, None] + np.arange(4)
    out = np.zeros(len(at))
    for j in range(4):
        others = [m for m in range(4) if m != j]
        out += y[nodes[:, j]] * np.prod([(at - t[nodes[:, m]]) / (t[nodes[:, j]] - t[nodes[:, m]])
                                         for m in others], axis=0)
    return out
