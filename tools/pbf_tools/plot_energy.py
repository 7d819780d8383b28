"""Kinetic, potential and total energy of a run over time; of several runs, the total of each.

Energies are measured from the domain's lower corner. The total of several runs is drawn relative
to its value at the start, so that a gain shows as a curve above 1. Takes runs, or CSV
tables with the columns time, kinetic_energy, potential_energy (to-csv --log).
"""

from __future__ import annotations

import argparse

import numpy as np

from . import gaps, style
from .errors import BadInput
from .logs import RUN_HELP, Log, labels, read_log

EXAMPLE = """examples:
  python -m pbf_tools plot-energy out/demo -o energy.png
  python -m pbf_tools plot-energy out/float out/double -o energies.png"""
COLUMNS = ["time", "kinetic_energy", "potential_energy"]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("runs", nargs="+", metavar="RUN", help=f"{RUN_HELP}, or CSV table")
    style.add_output(parser, "energy.png")


def figure(args: argparse.Namespace) -> style.Picture:
    logs = [read_log(path, COLUMNS) for path in args.runs]
    for path, log in zip(args.runs, logs):
        log.table = gaps.whole_rows(log.table, COLUMNS, path)
    fig, ((axes,),) = style.figure()
    if len(logs) == 1:
        detail = _one(axes, logs[0])
    else:
        detail = _many(axes, logs, args.runs)
    axes.set_xlabel("time (s)")
    style.title(axes, args.title or "Energy", detail)
    return fig


def _one(axes, log: Log) -> str:
    t, kinetic, potential = (log.table[c] for c in COLUMNS)
    for k, (label, values) in enumerate((("total", kinetic + potential), ("potential", potential),
                                         ("kinetic", kinetic))):
        axes.plot(t, values, label=label, color=style.COLORS[k],
                  linestyle=("-", "--", "-.")[k])
    axes.set_ylabel("energy (J)")
    axes.set_ylim(bottom=min(0, float(np.nanmin(potential))))
    axes.legend()
    total = kinetic + potential
    most = np.nanmax(total)
    axes.figure.tell(f"total energy: {total[0]:.6g} J at the start, {most:.6g} J at most, "
                     f"{total[-1]:.6g} J at the end", run=log.name, start=total[0], most=most,
                     end=total[-1])
    return log.title


def _many(axes, logs: list[Log], paths: list[str]) -> str:
    for k, (log, label) in enumerate(zip(logs, labels(paths, [log.name for log in logs]))):
        total = log.table["kinetic_energy"] + log.table["potential_energy"]
        if not total[0] > 0:
            raise BadInput(f"{paths[k]}: the energy at the start is not above 0, so nothing can be "
                           "drawn relative to it; draw this run by itself")
        axes.plot(log.table["time"], total / total[0], label=label, color=style.COLORS[k % 8],
                  linestyle=("-", "--", "-.", ":")[k % 4])
        most = np.nanmax(total)
        axes.figure.tell(f"{label:24} energy, relative to the start: {most / total[0]:.6g} at "
                         f"most, {total[-1] / total[0]:.6g} at the end", run=label, start=total[0],
                         most=most, end=total[-1])
    axes.axhline(1, color=style.GREY, linewidth=0.8)
    axes.set_ylabel("total energy / energy at the start (1)")
    axes.legend()
    return "; ".join(dict.fromkeys(log.title for log in logs)) if len(logs) < 3 else ""
