"""The readings of a run as a table that is measured data for another run: `plot-gauges --experiment`.

Every column has its unit in its name.
"""

from __future__ import annotations

import numpy as np

from . import units
from .errors import BadInput
from .run_file import Run
from .table import Table

Readings = list[tuple[str, np.ndarray, str]]  # name, values, unit


def table(run: Run, gauges: bool, loads: bool) -> Table:
    """The gauges of a run, its loads or both, below time_s. BadInput where it has none, and for both
    where they are read at different times."""
    (time, readings), *more = [read(run) for wanted, read in ((gauges, _gauges), (loads, _loads))
                               if wanted]
    for other, further in more:
        if not np.array_equal(time, other):
            raise BadInput(f"{run.path}: gauges and loads are read at different times ({len(time)} "
                           f"and {len(other)}); write two tables, with `to-csv {run.path} --gauges` "
                           f"and with `to-csv {run.path} --loads`")
        readings = readings + further
    out = Table({"time_s": time}, {"time_s": "s"})
    for name, values, unit in readings:
        parts = {name: values} if values.ndim == 1 else \
            {f"{name}_{c}": values[:, k] for k, c in enumerate("xyz")}
        for part, v in parts.items():
            column = part + units.ending(unit)
            if column in out:
                raise BadInput(f"{run.path}: two readings would be the column {column}; rename a "
                               "gauge")
            out[column], out.units[column] = v, unit
    return out


def _gauges(run: Run) -> tuple[np.ndarray, Readings]:
    """H, U, Q and Q_total, P and P_peak."""
    gauges = list(run.gauges.values())
    if not gauges:
        raise BadInput(f"{run.path}: no gauges; give the scene some (key gauges) and run it")
    return gauges[0].time, [reading for g in gauges for reading in (
        (g.name, g.value, g.unit),
        *((f"{g.name}_{part}", v, g.further_units[part]) for part, v in g.further.items()))]


def _loads(run: Run) -> tuple[np.ndarray, Readings]:
    """load_post_x for load/post/force_x, load_post_torque_x, load_post_peak."""
    log = run.log
    names = [name for name in log if name.startswith("load/")]
    if not names:
        raise BadInput(f"{run.path}: no loads; give an obstacle or the domain `loads: true` and run "
                       "the scene")
    return log["time"], [(name.replace("/force_", "_").replace("/", "_"), log[name],
                          log.units[name]) for name in names]


def head(run: Run, table: Table) -> str:
    """The comments above a table: what it is of, and the units as `read_csv` reads them."""
    info = run.info
    source = f"run {run.path}, scene {run.name} ({info['scene_path']}), " \
             f"pbf {info['program_version']} ({info['commit']})"
    said = ", ".join(f"{name}={unit}" for name, unit in table.units.items())
    return f"# source: {' '.join(source.splitlines())}\n# units: {said}\n"
