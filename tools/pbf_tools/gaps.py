"""What a plot cannot show: columns and readings without a value (nan), told in a note."""

from __future__ import annotations

import numpy as np

from .errors import BadInput, note
from .table import Table

# By column, or kind of gauge.
_POOL = "only a pool has it: gravity along an axis, walls on all sides, no obstacles, " \
        "no tank_motion"
WHY = {"height_kept": _POOL, "hydrostatic_deviation": _POOL,
       "velocity": "no particle was within reach of this gauge (its key within, by default h)"}


def why(name: str) -> str:
    """Why a column or a kind of gauge can be nan, to follow a sentence; empty where not known.

    >>> why("velocity"), why("front_x")
    ('; no particle was within reach of this gauge (its key within, by default h)', '')
    """
    return f"; {WHY[name]}" if name in WHY else ""


def tell(who: str, values: np.ndarray, rows: str = "rows", kind: str = "") -> None:
    """A note when a curve to be drawn has gaps, or nothing to show at all. `kind`: key of `why`."""
    missing = np.isnan(values if values.ndim == 1 else values[:, 0])
    count = int(np.count_nonzero(missing))
    if count:
        every = count == len(missing)
        note(f"{who}: {'nothing to draw, ' if every else ''}nan in "
             f"{'all' if every else f'{count} of'} {len(missing)} {rows}{why(kind)}")


def numbers(table: Table, columns: list[str], path: str) -> None:
    """BadInput where one of the columns is of texts."""
    for name in columns:
        if table[name].dtype.kind == "U":
            raise BadInput(f"{path}: column {name} is not one of numbers")


def whole_rows(table: Table, columns: list[str], path: str) -> Table:
    """The rows in which all of these columns have a value; a note says how many others there are.
    BadInput where there is none."""
    numbers(table, columns, path)
    there = np.all([np.isfinite(table[name]) for name in columns], axis=0)
    if there.all():
        return table
    missing = ", ".join(name for name in columns if not np.isfinite(table[name]).all())
    said = f"left out {np.count_nonzero(~there)} of {len(there)} rows, which have no {missing}"
    if not there.any():
        raise BadInput(f"{path}: nothing to draw, {said}")
    note(f"{path}: {said}")
    return table.where(there)


def points(values: np.ndarray) -> dict[str, object]:
    """How a curve is drawn: with a mark where it has values, but no two side by side for a line.

    >>> points(np.array([1.0])), points(np.array([1.0, 2.0])), points(np.array([np.nan, 2, np.nan]))
    ({'marker': 'o'}, {}, {'marker': 'o'})
    """
    there = np.isfinite(values)
    return {} if np.any(there[1:] & there[:-1]) else {"marker": "o"}
