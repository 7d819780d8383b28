"""Waves at gauges along a flume: incident and reflected, their heights, lengths and spectra.

RUN is a run with gauges of kind `level`, or a CSV table of readings, which then needs the positions
of the gauges (--gauges COLUMN=X,...) and the depth. With --period waves are regular: heights,
lengths, second harmonics and losses along the flume are printed, and one reflection coefficient.
Without it they are irregular: spectra, and the reflection of each Fourier line between 0.5 and 2
times the frequency of the peak.

Incident waves run to larger X. The gauges stand in one depth. Two gauges split waves when they are
0.05 to 0.45 of a wavelength L apart, three or more serve wider bands (0, L/10 and L/4 are good
places); lines that the gauges cannot split (condition number above 6) are left out and counted.
Readings are in m and s; the mean of a gauge's is taken off as the still level. Leave the start of
the waves out with --between; of regular waves the last whole periods in it count.
"""

from __future__ import annotations

import argparse

import numpy as np

from . import style
from .logs import RUN_HELP
from .run_up import RunUp, run_up
from .table import write_text
from .wave_analysis import Analysis, analyse, figure
from .wave_input import pair, read
from .wave_lines import TAPER, wavenumber
from .wave_split import Along, Split, along, split
from .wave_statistics import Spectrum, Waves, spectrum, zero_crossings

__all__ = ["Along", "Analysis", "RunUp", "Spectrum", "Split", "Waves", "along", "analyse", "figure",
           "run_up", "spectrum", "split", "wavenumber", "zero_crossings"]

EXAMPLE = """examples:
  python -m pbf_tools waves out/flume --gauges g1,g2,g3 --period 1.2 --between 8,14 -o waves.png
  python -m pbf_tools waves out/sea --gauges g1,g2,g3 --between 20,120 --csv waves.csv
  python -m pbf_tools waves flume.csv --gauges eta1_mm=3.0,eta2_mm=3.3 --depth 0.4 --period 2

In Python: from pbf_tools import waves; waves.split, along, spectrum, zero_crossings take pairs
(time, elevation) or gauges of a run; waves.run_up(run, obstacle) reads frames."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("run_file", metavar="RUN", help=f"{RUN_HELP}, or a CSV table (.csv)")
    parser.add_argument("--gauges", required=True, metavar="NAME[=X],...",
                        help="two or more gauges, or columns of a table; X: position along the waves "
                             "(m; default: that of the run's gauge)")
    parser.add_argument("--axis", choices="xyz", default="x", help="along which waves of a run go "
                                                                   "(default %(default)s)")
    parser.add_argument("--period", type=float, metavar="T", help="of regular waves (s)")
    parser.add_argument("--depth", type=float, metavar="D",
                        help="of the still water (m; default: the mean of a run's gauges)")
    parser.add_argument("--between", metavar="A,B", help="window of time (s; default: all readings)")
    parser.add_argument("--band", metavar="A,B", help="lines of irregular waves to split (Hz)")
    parser.add_argument("--taper", type=float, default=TAPER, metavar="F",
                        help="share of the record that fades in and out before irregular waves are "
                             "split; 0 when it is as long as what it repeats (default %(default)s)")
    parser.add_argument("--smallest", type=float, metavar="H",
                        help="waves below this height are not counted (m; default: the spacing of "
                             "the run's particles; 0 for a table)")
    parser.add_argument("--scale", type=float, metavar="F",
                        help="metres of one unit of a table (default: 0.001 and 0.01 for columns "
                             "whose names end in _mm and _cm, else 1)")
    parser.add_argument("--time-column", metavar="NAME",
                        help="time column of a table (default: the first named t, time ..., else the "
                             "first; s, or ms where the name ends in _ms)")
    style.add_output(parser, "waves.png")
    parser.add_argument("--csv", metavar="FILE", help="table to write: a row for each gauge")


def draw(args: argparse.Namespace) -> style.Picture:
    between, band = pair(args.between, "--between"), pair(args.band, "--band")
    given = read(args, between)
    found = analyse(given.gauges, given.places, given.depth, args.period, between=between, band=band,
                    taper=args.taper, smallest=given.smallest, gravity=given.gravity)
    picture = figure(found, args.title or given.title)
    picture.told = report(found, given.smallest).splitlines()
    if args.csv:
        table = found.table()
        units = ", ".join(f"{name}={unit}" for name, unit in table.units.items())
        write_text(args.csv, f"# units: {units}\n" + table.csv())
        picture.told.append(f"wrote {args.csv}")
    return picture


def run(args: argparse.Namespace) -> int:
    return style.command(draw, args)


def report(found: Analysis, smallest: float) -> str:
    """What the command prints."""
    parts, first = found.split, found.gauges[0]
    kind = f"period {found.period:g} s" if found.period else \
        f"irregular, {parts.frequency[0]:.3g} to {parts.frequency[-1]:.3g} Hz"
    lines = [f"{kind}, depth {found.depth:.4g} m, wavelength {found.length:.4g} m by linear theory; "
             f"{first.time[0]:g} to {first.time[-1]:g} s",
             f"incident {parts.incident_height:.4g} m, reflected {parts.reflected_height:.4g} m, "
             f"reflection {parts.reflection:.3f}"]
    if len(found.gauges) > 2:
        lines[-1] += f"; these leave {100 * parts.misfit:.1f} % of the variance"
    if parts.left_out:
        every = parts.left_out + len(parts.frequency)
        lines.append(f"left out {parts.left_out} of {every} lines, which these gauges cannot split: "
                     f"{100 * parts.left_out_share:.1f} % of the variance")
    if found.along and np.ptp(found.x) >= found.length / 2:
        waves = found.along
        off = 100 * (waves.wavenumber / waves.theory - 1)
        lines.append(f"along the flume: wavenumber {off:+.1f} % of linear theory, loss of height "
                     f"{100 * waves.loss:.1f} % per wavelength")
    for k, gauge in enumerate(found.gauges):
        if found.along:
            row = found.along.table
            own = f"H {row['height'][k]:.4g} m, second harmonic {row['second'][k]:.2f} of it"
        else:
            one = found.spectra[k]
            own = f"Hm0 {one.hm0:.4g} m, Tp {one.tp:.3g} s, Tm01 {one.tm01:.3g} s, Tm02 " \
                  f"{one.tm02:.3g} s, T(-1,0) {one.tm10:.3g} s"
        w = found.waves[k]
        counted = f"{w.number} waves" + (f" of {smallest:g} m or more" if smallest else "")
        if w.number >= 3:
            counted += f": H1/3 {w.h13:.4g} m, Hmax {w.hmax:.4g} m, Tz {w.tz:.3g} s"
        lines.append(f"{gauge.name} at {found.x[k]:g} m: {own}; {counted}; mean of "
                     f"{gauge.mean:.4g} m taken off")
    return "\n".join(lines) + "\n"
