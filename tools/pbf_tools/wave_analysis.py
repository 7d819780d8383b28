"""Everything that the command `waves` says of gauges along a flume, and its table and figure."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes

from . import style
from .table import Table
from .wave_lines import TAPER
from .wave_records import Between, Pair, Record, records, together
from .wave_split import Along, Split, along, places, split
from .wave_statistics import Spectrum, Waves, spectrum, zero_crossings

FAINT = 0.05  # of the largest density: below it the reflection of a band is not drawn


@dataclass(frozen=True)
class Analysis:
    """Gauges by position `x` (m). Regular waves have a `period` (s) and `along`, others `spectra`."""

    gauges: list[Record]
    x: np.ndarray
    depth: float
    period: float | None
    split: Split
    along: Along | None
    spectra: list[Spectrum]
    waves: list[Waves]

    @property
    def length(self) -> float:
        """By linear theory, m: of the period, or of the line with most incident waves."""
        return float(2 * np.pi / self.split.wavenumber[np.argmax(abs(self.split.incident))])

    def table(self) -> Table:
        """A row for each gauge: what was taken off as the still level (`mean`), its waves one by one,
        its first harmonic or its spectrum, and what the split of all of them says."""
        units = {"x": "m", "mean": "m", "height": "m", "phase": "rad", "hm0": "m", "tp": "s",
                 "tm01": "s", "tm02": "s", "tm10": "s", "h13": "m", "h110": "m", "hmax": "m",
                 "tz": "s", "incident": "m", "reflected": "m"}
        columns = {"gauge": [g.name for g in self.gauges], "x": self.x,
                   "mean": [g.mean for g in self.gauges]}
        if self.along:
            columns |= {name: self.along.table[name]
                        for name in ("height", "phase", "second", "unexplained")}
        else:
            columns |= {name: [getattr(s, name) for s in self.spectra]
                        for name in ("hm0", "tp", "tm01", "tm02", "tm10")}
        columns |= {name: [getattr(w, name) for w in self.waves]
                    for name in ("number", "h13", "h110", "hmax", "tz")}
        same = {"incident": self.split.incident_height, "reflected": self.split.reflected_height,
                "reflection": self.split.reflection}
        columns |= {name: np.full(len(self.x), value) for name, value in same.items()}
        return Table(columns, {name: unit for name, unit in units.items() if name in columns})


def analyse(gauges: Sequence[Pair], positions: Sequence[float], depth: float,
            period: float | None = None, *, between: Between = None,
            band: tuple[float, float] | None = None, taper: float = TAPER, smallest: float = 0.0,
            gravity: float = 9.81) -> Analysis:
    """`split` and `zero_crossings` (waves of `smallest`, m, or more), with a period `along`, without
    one `spectrum`; see these for the arguments. Gauges may come in any order."""
    order = np.argsort(places(gauges, positions))
    gauges, x = [gauges[k] for k in order], np.asarray(positions, float)[order]
    given = records(gauges, between)
    if period is None:
        given = together(given)
    parts = split(given, x, depth, period, band=band, taper=taper, gravity=gravity)
    return Analysis(
        given, x, depth, period, parts,
        None if period is None else along(given, x, depth, period, gravity=gravity),
        _spectra(given) if period is None else [],
        [zero_crossings(r, smallest=smallest) for r in given])


def _spectra(gauges: Sequence[Pair]) -> list[Spectrum]:
    """In the same bands, those of the first gauge."""
    first = spectrum(gauges[0])
    lines = round(first.bands["freedom"][0] / 2)
    return [first, *(spectrum(gauge, average=lines) for gauge in gauges[1:])]


def figure(found: Analysis, title: str = "") -> style.Picture:
    """Of regular waves heights and second harmonics along the flume, of others the spectra with their
    incident and reflected parts, and the reflection of each band."""
    fig, axes = style.figure(2, 1, (6.8, 6.0), sharex=True, height_ratios=(2, 1))
    parts = found.split
    what = "H" if found.period else "Hm0"
    style.title(axes[0, 0], f"incident {what} {parts.incident_height:.3g} m, reflected "
                            f"{parts.reflected_height:.3g} m, R = {parts.reflection:.3f}", title)
    if found.along:
        _draw_along(axes[:, 0], found, found.along)
    else:
        _draw_spectra(axes[:, 0], found)
    style.side_legend(axes[0, 0])
    return fig


def _draw_along(axes: Sequence[Axes], found: Analysis, waves: Along) -> None:
    parts, margin = found.split, 0.05 * np.ptp(found.x)
    x = np.linspace(found.x[0] - margin, found.x[-1] + margin, 400)
    to, fro = (np.exp(sign * 1j * parts.wavenumber[0] * x) for sign in (-1, 1))
    axes[0].plot(x, 2 * abs(parts.incident[0] * to + parts.reflected[0] * fro), color=style.GREY,
                 label="both together")
    for k, (label, height) in enumerate((("incident", parts.incident_height),
                                         ("reflected", parts.reflected_height))):
        axes[0].plot(x, np.full(len(x), height), color=style.COLORS[k], label=label,
                     linestyle=("--", ":")[k])
    axes[0].plot(found.x, waves.table["height"], "o", color=style.COLORS[6], label="gauges")
    axes[0].set_ylabel("height of the first harmonic (m)")
    axes[1].plot(found.x, waves.table["second"], "o-", color=style.COLORS[2])
    axes[1].set_ylabel("second over first")
    axes[1].set_xlabel("x (m)")
    for panel in axes:
        panel.set_ylim(0, 1.05 * panel.get_ylim()[1])


def _draw_spectra(axes: Sequence[Axes], found: Analysis) -> None:
    parts, bands = found.split, found.spectra[0].bands
    for k, (gauge, one) in enumerate(zip(found.gauges, found.spectra)):
        axes[0].plot(one.bands["frequency"], one.bands["density"], linewidth=0.9,
                     color=style.COLORS[(k + 2) % 8], label=gauge.name)
    axes[0].fill_between(bands["frequency"], bands["low"], bands["high"], color=style.COLORS[2],
                         alpha=0.15, linewidth=0, label=f"{found.gauges[0].name}, 80 %")
    frequency, incident, reflected = in_bands(parts, bands)
    axes[0].plot(frequency, incident, color=style.COLORS[0], linewidth=2, label="incident")
    axes[0].plot(frequency, reflected, color=style.COLORS[1], linewidth=2, label="reflected")
    axes[0].set_ylabel("density (m$^2$/Hz)")
    axes[0].set_ylim(bottom=0)
    there = incident >= FAINT * incident.max()
    axes[1].plot(frequency[there], np.sqrt(reflected[there] / incident[there]), "o-", markersize=3,
                 color=style.COLORS[6])
    axes[1].set_ylabel("reflection")
    axes[1].set_ylim(0, max(1.0, axes[1].get_ylim()[1]))
    axes[1].set_xlabel("frequency (Hz)")
    axes[1].set_xlim(0, 1.3 * float(parts.frequency.max()))


def in_bands(parts: Split, bands: Table) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Frequencies (Hz) and densities (m^2/Hz) of the incident and the reflected waves of irregular
    ones, averaged over the lines of each band of a spectrum; bands without a line are left out."""
    edges = np.concatenate([[0], np.cumsum(bands["width"])]) + bands["frequency"][0] \
        - bands["width"][0] / 2
    where = np.searchsorted(edges, parts.frequency) - 1
    step = float(np.diff(parts.frequency).min()) if len(parts.frequency) > 1 else math.nan
    there = np.unique(where)

    def mean(a: np.ndarray) -> np.ndarray:
        return np.array([np.mean(abs(a[where == b]) ** 2) / 2 / step for b in there])

    return np.array([parts.frequency[where == b].mean() for b in there]), mean(parts.incident), \
        mean(parts.reflected)
