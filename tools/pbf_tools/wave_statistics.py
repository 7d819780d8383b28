"""One record of waves: its spectrum, and its waves one by one."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .errors import BadInput
from .table import Table
from .wave_lines import peak_frequency
from .wave_records import Between, Pair, even, record


@dataclass(frozen=True)
class Spectrum:
    """The spectrum of a record, one-sided. `bands`: a row for each band: `frequency` (Hz, its
    middle), `width` (Hz), `density` (m^2/Hz), `freedom` (degrees of freedom), and `low` and `high`,
    between which the density of the sea state is with 80 % confidence. Moments and periods are of
    the lines in `limits` (Hz), not of the bands."""

    bands: Table
    moments: dict[int, float]  # m_-1 to m_2, m^2 Hz^n
    tp: float                  # period of the peak, s
    limits: tuple[float, float]

    @property
    def hm0(self) -> float:
        """4 sqrt(m0), m."""
        return 4 * math.sqrt(self.moments[0])

    @property
    def tm01(self) -> float:
        """m0/m1, s."""
        return self.moments[0] / self.moments[1]

    @property
    def tm02(self) -> float:
        """sqrt(m0/m2), s; what is noise at high frequencies makes it short."""
        return math.sqrt(self.moments[0] / self.moments[2])

    @property
    def tm10(self) -> float:
        """The energy period T(-1,0) = m_-1/m0, s."""
        return self.moments[-1] / self.moments[0]


def spectrum(gauge: Pair, *, between: Between = None, average: int | None = None,
             limits: tuple[float, float] = (0.0, math.inf)) -> Spectrum:
    """The spectrum of a record over a window of time (s), its lines averaged in bands of `average`
    lines (default: an eighth of the peak frequency). No taper: the sum of density times width is the
    variance of the record, to rounding. `limits` (Hz) of what counts for heights and periods."""
    given = even(record(gauge, between))
    count = len(given.time)
    frequency = np.fft.rfftfreq(count, given.step)[1:]
    power = 2 * abs(np.fft.rfft(given.elevation)[1:] / count) ** 2
    freedom = np.full(len(power), 2.0)
    if count % 2 == 0:  # the last line is at the highest frequency, and has no imaginary part
        power[-1] /= 2
        freedom[-1] = 1
    inside = (frequency >= limits[0]) & (frequency <= limits[1])
    m0 = float(power[inside].sum())
    if not m0 > 0:
        raise BadInput(f"{given.name}: no waves between {limits[0]:g} and {limits[1]:g} Hz")
    peak = peak_frequency(frequency[inside], power[inside])
    width = frequency[0]
    size = max(1, round(peak / 8 / width)) if average is None else average
    if size < 1 or size > len(power):
        raise BadInput(f"average {size}: give a number of lines from 1 to {len(power)}")
    first = np.arange(0, len(power), size)
    lines = np.diff(np.append(first, len(power)))
    density = np.add.reduceat(power, first) / (lines * width)
    nu = np.add.reduceat(freedom, first)
    bounds = {n: (n / chi_square(0.9, n), n / chi_square(0.1, n)) for n in set(nu.tolist())}
    low, high = np.array([bounds[n] for n in nu.tolist()]).T
    bands = Table({"frequency": np.add.reduceat(frequency, first) / lines, "width": lines * width,
                   "density": density, "freedom": nu, "low": low * density, "high": high * density},
                  {"frequency": "Hz", "width": "Hz", "density": "m^2/Hz", "low": "m^2/Hz",
                   "high": "m^2/Hz"})
    moments = {n: float(np.sum(power[inside] * frequency[inside] ** n)) for n in range(-1, 3)}
    return Spectrum(bands, moments, 1 / peak, limits)


def chi_square(share: float, freedom: float) -> float:
    """What chi square with these degrees of freedom is below with a probability, to 1e-12.

    >>> round(chi_square(0.1, 2), 6), round(chi_square(0.9, 16), 4)
    (0.210721, 23.5418)
    """
    low, high = 0.0, freedom + 40 * math.sqrt(freedom)
    while high - low > 1e-12 * high:
        middle = (low + high) / 2
        low, high = (middle, high) if _below(middle, freedom) < share else (low, middle)
    return high


def _below(x: float, freedom: float) -> float:
    """The probability of a chi square below x: the series of the incomplete gamma function."""
    a, y = freedom / 2, x / 2
    term = total = 1 / a
    n = a
    while term > 1e-16 * total:
        n += 1
        term *= y / n
        total += term
    return total * math.exp(a * math.log(y) - y - math.lgamma(a)) if y > 0 else 0.0


@dataclass(frozen=True)
class Waves:
    """The waves of a record from one up-crossing of its mean to the next. `table`: a row for each:
    `start` (s), `period` (s), `height`, `crest`, `trough` (m). A height is nan where there are too
    few waves for it: fewer than 3 for H1/3, than 10 for H1/10."""

    table: Table

    @property
    def number(self) -> int:
        return len(self.table)

    @property
    def h13(self) -> float:
        """The mean of the highest third, m."""
        return self._highest(3)

    @property
    def h110(self) -> float:
        """The mean of the highest tenth, m."""
        return self._highest(10)

    @property
    def hmax(self) -> float:
        """The highest, m."""
        return float(self.table["height"].max()) if self.number else math.nan

    @property
    def tz(self) -> float:
        """The mean period, s."""
        return float(self.table["period"].mean()) if self.number else math.nan

    def _highest(self, part: int) -> float:
        height = np.sort(self.table["height"])[::-1]
        return float(height[:len(height) // part].mean()) if len(height) >= part else math.nan


def zero_crossings(gauge: Pair, *, smallest: float = 0.0, between: Between = None) -> Waves:
    """The waves of a record over a window of time (s). A wave counts when the surface goes below
    -smallest/2 and above smallest/2 (m); what is between belongs to the wave before. Give the spacing
    of the particles. Crests and troughs are readings: with n in a period they are at most
    1 - cos(pi/n) too low."""
    if not 0 <= smallest < math.inf:
        raise BadInput(f"the smallest wave of {smallest:g} m must be a number from 0 on")
    given = record(gauge, between)
    t, y = given.time, given.elevation
    side = held_side(y, smallest)
    rises = np.flatnonzero((side[1:] == 1) & (side[:-1] == -1)) + 1
    below = np.flatnonzero(y[:-1] < 0)  # then the last crossing before each of them
    starts = below[np.searchsorted(below, rises) - 1]
    start = t[starts] - y[starts] * (t[starts + 1] - t[starts]) / (y[starts + 1] - y[starts])
    parts = [y[a + 1:b + 1] for a, b in zip(starts, starts[1:])]
    crest, trough = (np.array([f(part) for part in parts], float) for f in (np.max, np.min))
    return Waves(Table({"start": start[:-1], "period": np.diff(start), "height": crest - trough,
                        "crest": crest, "trough": trough},
                       {name: "s" if name in ("start", "period") else "m"
                        for name in ("start", "period", "height", "crest", "trough")}))


def held_side(y: np.ndarray, width: float) -> np.ndarray:
    """+1 and -1 where y is more than half the width above and below 0; between, what it was last, and
    0 before it was either.

    >>> held_side(np.array([0, 3, 0.5, -0.5, -2, 0.9, 1.1]), 2).tolist()
    [0, 1, 1, 1, -1, -1, 1]
    """
    side = np.where(y > width / 2, 1, np.where(y < -width / 2, -1, 0))
    last = np.maximum.accumulate(np.where(side != 0, np.arange(len(y)), -1))
    return np.where(last < 0, 0, side[last])
