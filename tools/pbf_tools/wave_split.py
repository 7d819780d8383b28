"""Waves at several gauges along a flume: incident and reflected ones, and how they change along it.

An incident wave is Re(a exp(i (omega t - k x))), so it runs to larger x.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .errors import BadInput, note
from .table import Table
from .wave_lines import TAPER, fourier, harmonics, wavenumber
from .wave_records import Between, Pair, records, together

WORST = 6.0  # condition number beyond which a line is left out; two gauges 0.05 L apart have 6.3


@dataclass(frozen=True)
class Split:
    """Incident and reflected waves, a row for each line: of regular waves one. Amplitudes are complex
    (m), at x = 0 and t = 0. `left_out` counts the lines of the band that the gauges cannot split,
    `left_out_share` is their part of the variance in it, `misfit` what the two waves leave of the
    gauges' variance in the other lines (nothing at two gauges)."""

    frequency: np.ndarray  # Hz
    wavenumber: np.ndarray
    condition: np.ndarray
    incident: np.ndarray
    reflected: np.ndarray
    regular: bool
    left_out: int
    left_out_share: float
    misfit: float

    @property
    def reflection(self) -> float:
        """The reflection coefficient: of amplitudes, of irregular waves the root of the energies."""
        return self.reflected_height / self.incident_height if self.incident_height else float("nan")

    @property
    def incident_height(self) -> float:
        """Of regular waves H = 2 a, of others Hm0 of the lines, m."""
        return self._height(self.incident)

    @property
    def reflected_height(self) -> float:
        return self._height(self.reflected)

    def _height(self, a: np.ndarray) -> float:
        return float(2 * abs(a[0])) if self.regular else float(4 * np.sqrt(np.sum(abs(a) ** 2) / 2))


def split(gauges: Sequence[Pair], positions: Sequence[float], depth: float,
          period: float | None = None, *, between: Between = None,
          band: tuple[float, float] | None = None, taper: float = TAPER,
          gravity: float = 9.81) -> Split:
    """Incident and reflected waves of gauges in one depth (m), at positions (m) along the incident
    waves: with a `period` (s) of regular waves, without one for each Fourier line in the band (Hz;
    default 0.5 to 2 times the peak's frequency), over a window of time (s).

    Least squares over 2 gauges (Goda & Suzuki 1976), 3 (Mansard & Funke 1980) or more, by linear
    theory and without losses. Lines whose 2 x n matrix has a condition number above 6 are left out:
    two gauges serve 0.05 to 0.45 wavelengths L apart; 0, L/10 and L/4 are good places for three.
    `taper`: share of the record that a cosine rises and falls in at its ends, against leakage between
    lines; 0 when the record is exactly as long as what it repeats.
    """
    if len(gauges) < 2:
        raise BadInput(f"{len(gauges)} gauge: incident and reflected waves need two or more")
    given, x = records(gauges, between), places(gauges, positions)
    if period is not None:
        frequency = np.array([1 / period if period > 0 else np.nan])
        a = np.array([harmonics(r, period)[0][:1] for r in given])
    else:
        frequency, a = fourier(together(given), band, taper)
    k = wavenumber(1 / frequency, depth, gravity)
    n, sums = len(x), np.exp(2j * np.outer(k, x)).sum(axis=1)
    with np.errstate(divide="ignore"):
        condition = np.sqrt((n + abs(sums)) / np.maximum(n - abs(sums), 0))
    good = condition <= WORST
    if not good.any():
        apart = np.diff(np.sort(x)) * k[0] / (2 * np.pi)
        raise BadInput(f"these gauges cannot split the waves: they are {_list(apart)} wavelengths "
                       f"apart (of {2 * np.pi / k[0]:.4g} m); 0.05 to 0.45 of one is the range")
    energy = np.sum(abs(a) ** 2, axis=0)
    a, k, sums = a[:, good], k[good], sums[good]
    to, fro = np.exp(-1j * np.outer(x, k)), np.exp(1j * np.outer(x, k))
    # The normal equations of a = I to + R fro; their 2 x 2 matrix is [[n, sums], [sums*, n]].
    one, two = np.sum(a * fro, axis=0), np.sum(a * to, axis=0)
    determinant = n * n - abs(sums) ** 2
    incident, reflected = (n * one - sums * two) / determinant, \
        (n * two - sums.conj() * one) / determinant
    rest = np.sum(abs(a - incident * to - reflected * fro) ** 2)
    return Split(frequency[good], k, condition[good], incident, reflected, period is not None,
                 int(np.count_nonzero(~good)), float(energy[~good].sum() / (energy.sum() or 1)),
                 float(rest / (energy[good].sum() or 1)))


def places(gauges: Sequence[Pair], positions: Sequence[float]) -> np.ndarray:
    """The positions as an array; BadInput when they do not fit the gauges, or two are the same."""
    x = np.asarray(positions, float)
    if x.shape != (len(gauges),) or not np.all(np.isfinite(x)):
        raise BadInput(f"{len(gauges)} gauges need as many positions in m, given are {_list(x.flat)}")
    names = [getattr(g, "name", f"gauge {k}") for k, g in enumerate(gauges, 1)]
    order = np.argsort(x, kind="stable")
    for a, b in zip(order, order[1:]):
        if x[b] - x[a] < 1e-9:
            raise BadInput(f"{names[a]} and {names[b]} are at the same place, {x[a]:g} m along the "
                           "waves; incident and reflected waves need different ones")
    return x


def _list(numbers: Sequence[float]) -> str:
    return ", ".join(f"{v:.3g}" for v in numbers) or "none"


@dataclass(frozen=True)
class Along:
    """Regular waves along a flume. `table`: a row for each gauge, by position: `x`, `height` 2 a of
    the first harmonic (m), `phase` of a (rad, without jumps), `second` harmonic over first (nan where
    the readings are too coarse for it), `unexplained` share of the variance. `wavenumber` (rad/m) by
    the phases and `theory`; `loss`: share of the height that a wavelength takes."""

    table: Table
    wavenumber: float
    theory: float
    loss: float


def along(gauges: Sequence[Pair], positions: Sequence[float], depth: float, period: float, *,
          between: Between = None, gravity: float = 9.81) -> Along:
    """Height, phase and second harmonic of regular waves at every gauge, and what a straight line
    through phases and logarithms of heights says of wavenumber and loss. Reflected waves make both
    swing along the flume: use a window before they come, or gauges over half a wavelength or more."""
    if len(gauges) < 2:
        raise BadInput(f"{len(gauges)} gauge: waves along a flume need two or more")
    given, x = records(gauges, between), places(gauges, positions)
    order = np.argsort(x)
    x, given = x[order], [given[k] for k in order]
    found = [harmonics(r, period) for r in given]
    a = np.array([f[0][0] for f in found])
    if not np.all(abs(a) > 0):
        raise BadInput(f"no wave of {period:g} s at {given[int(np.argmin(abs(a)))].name}")
    theory = float(wavenumber(period, depth, gravity))
    phase = np.unwrap(np.angle(a * np.exp(1j * theory * x))) - theory * x
    second = [abs(f[0][1] / f[0][0]) if len(f[0]) > 1 else np.nan for f in found]
    unexplained = np.array([f[1] for f in found])
    if unexplained.max() > 0.2:
        worst = int(unexplained.argmax())
        note(f"{given[worst].name}: {100 * unexplained[worst]:.0f} % of the variance is not of waves "
             f"of {period:g} s; is this their period, and are they regular there?")
    slope = np.polyfit(x - x.mean(), np.log(abs(a)), 1)[0]
    k = -float(np.polyfit(x - x.mean(), phase, 1)[0])
    table = Table({"gauge": [r.name for r in given], "x": x, "height": 2 * abs(a), "phase": phase,
                   "second": second, "unexplained": unexplained},
                  {"x": "m", "height": "m", "phase": "rad"})
    return Along(table, k, theory, 1 - float(np.exp(slope * 2 * np.pi / theory)))
