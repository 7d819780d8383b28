"""Wave numbers by linear theory, and the lines of which records of waves are made: harmonics of a
period, or Fourier lines. A line is Re(a exp(i omega t)) with a complex amplitude a (m)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .errors import BadInput
from .wave_records import Record

HARMONICS = 4
BAND = (0.5, 2.0)  # of the peak frequency
LEAST = 20         # lines of irregular waves; with the usual band a record of 13 peak periods
TAPER = 0.1        # share of a record that rises at its start, and falls at its end


def wavenumber(period: float | np.ndarray, depth: float, gravity: float = 9.81) -> np.ndarray:
    """k (rad/m) of linear waves of a period (s) or several, omega^2 = g k tanh(k depth), by Newton's
    method to 1e-14.

    >>> print(round(2 * np.pi / float(wavenumber(1.2, 0.3)), 4), "m")
    1.7704 m
    """
    period = np.asarray(period, float)
    if not np.all(period > 0) or not np.all(np.isfinite(period)):
        raise BadInput("the period of waves must be a number above 0, in s")
    if not np.isfinite(depth) or depth <= 0:
        raise BadInput(f"the depth of {depth:g} m must be a number above 0")
    deep = (2 * np.pi / period) ** 2 * depth / gravity
    kd = deep / np.sqrt(np.tanh(deep))  # Eckart 1952, within 5 %
    for _ in range(30):
        t = np.tanh(kd)
        change = (kd * t - deep) / (t + kd * (1 - t * t))
        kd = kd - change
        if np.all(np.abs(change) <= 1e-14 * kd):
            break
    return kd / depth


def harmonics(given: Record, period: float) -> tuple[np.ndarray, float]:
    """Complex amplitudes (m) of the first harmonics of a period, over the last whole periods of the
    record, and the share of the variance that they leave unexplained.

    By least squares, together with a mean, so neither the start of the record nor its steps need to
    fit the period. Up to four, as far as there are 2.5 readings in each of their periods.
    """
    if not np.isfinite(period) or period <= 0:
        raise BadInput("regular waves need their period, a number above 0, in s")
    whole = int(given.duration / period * (1 + 1e-9))
    number = min(HARMONICS, int(period / given.step / 2.5))
    if whole < 1 or not number:
        raise BadInput(f"{given.name}: {given.duration:.4g} s at steps of {given.step:.4g} s are too "
                       f"{'short' if whole < 1 else 'coarse'} for a period of {period:g} s; the "
                       "least is one whole period, with 2.5 readings")
    kept = given.time > given.time[-1] + given.step / 2 - whole * period
    t, y = given.time[kept], given.elevation[kept]
    phase = 2 * np.pi / period * np.arange(1, number + 1) * t[:, None]
    columns = np.column_stack([np.ones(len(t)), np.cos(phase), np.sin(phase)])
    solution = np.linalg.lstsq(columns, y, rcond=None)[0]
    rest, all_of_it = np.var(y - columns @ solution), np.var(y)
    return solution[1:number + 1] - 1j * solution[number + 1:], float(rest / (all_of_it or 1))


def fourier(given: Sequence[Record], band: tuple[float, float] | None, taper: float
            ) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies of the Fourier lines in the band and, of every gauge, their amplitudes."""
    if not 0 <= taper <= 0.5:
        raise BadInput(f"taper {taper:g}: it is a share of the record, from 0 to 0.5")
    t, count = given[0].time, len(given[0].time)
    ends = np.minimum(np.arange(count) + 0.5, count - np.arange(count) - 0.5) / count
    shape = np.ones(count) if not taper else \
        0.5 - 0.5 * np.cos(np.pi * np.minimum(ends / taper, 1))
    shape /= np.sqrt(np.mean(shape ** 2))  # keeps the variance
    frequency = np.fft.rfftfreq(count, given[0].step)[1:]
    a = np.array([np.fft.rfft(r.elevation * shape)[1:] * 2 / count for r in given]) \
        * np.exp(-2j * np.pi * frequency * t[0])
    low, high = band or (f * peak_frequency(frequency, np.sum(abs(a) ** 2, axis=0)) for f in BAND)
    inside = (frequency >= low) & (frequency <= high)
    if np.count_nonzero(inside) < LEAST:
        raise BadInput(f"{np.count_nonzero(inside)} lines from {low:.3g} to {high:.3g} Hz: "
                       f"{given[0].duration:.4g} s are too short for irregular waves; give the "
                       "period of regular ones, a longer window, or another band")
    return frequency[inside], a[:, inside]


def peak_frequency(frequency: np.ndarray, power: np.ndarray) -> float:
    """Middle of the part of the spectrum around its peak, of lines averaged over a tenth of their
    frequency, Hz."""
    total = np.concatenate([[0], np.cumsum(power)])
    n = np.arange(len(power))
    reach = np.maximum(n // 20, 1)
    low, high = np.maximum(n - reach, 0), np.minimum(n + reach + 1, len(n))
    smooth = (total[high] - total[low]) / (high - low)
    top = int(np.argmax(smooth))
    part = slice(low[top], high[top])
    return float(np.sum(frequency[part] * power[part]) / (power[part].sum() or np.nan))
