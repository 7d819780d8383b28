"""Named columns with units: what a log, a track and a CSV file have in common."""

from __future__ import annotations

import csv
import io
from collections.abc import Collection, Mapping, MutableMapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .errors import BadInput, FileError, MissingPackage, UnknownName, unknown

if TYPE_CHECKING:
    import pandas


class Table(dict):
    """Columns of equal length, by name: arrays of shape (rows,) or (rows, components).

    A dict of its columns, so `name in table`, `table.items()` and `pandas.DataFrame(table)` do what
    they do with a dict. Only `len` counts rows, as that of a DataFrame does. A column may be added;
    BadInput when its length is another.

    >>> table = Table({"time": np.array([0.0, 0.1]), "speed": np.array([0.0, 0.98])},
    ...               {"time": "s", "speed": "m/s"})
    >>> table
    <Table of 2 rows: time (s), speed (m/s)>
    >>> len(table), list(table), table.units["speed"]
    (2, ['time', 'speed'], 'm/s')
    >>> table["way"] = table["speed"] * 0.1
    >>> print(table.csv(), end="")
    time,speed,way
    0.0,0.0,0.0
    0.1,0.98,0.098
    """

    def __init__(self, columns: Mapping[str, Any] | None = None,
                 units: Mapping[str, str] | None = None):
        super().__init__()
        self.units = dict(units or {})
        self.update(columns or {})

    def __setitem__(self, name: str, values: Any) -> None:
        values = np.asarray(values)
        rows = next((len(v) for key, v in self.items() if key != name), None)
        if values.ndim == 0 or rows not in (None, len(values)):
            raise BadInput(f"column {name}: a table's columns must have one length" +
                           (f", here {rows}" if rows is not None else ""))
        super().__setitem__(name, values)

    # Those of dict would store what __setitem__ has not seen.
    update = MutableMapping.update
    setdefault = MutableMapping.setdefault

    def __ior__(self, other: Mapping[str, Any]) -> Table:
        self.update(other)
        return self

    def __missing__(self, name: str) -> np.ndarray:
        raise UnknownName(unknown("column", name, self))

    def __len__(self) -> int:
        """Number of rows."""
        return len(next(iter(self.values()), ()))

    def __repr__(self) -> str:
        return f"<Table of {len(self)} rows: {', '.join(map(self._with_unit, self))}>"

    def __reduce__(self) -> tuple:
        return type(self), (self.columns, self.units)

    @property
    def columns(self) -> dict[str, np.ndarray]:
        """The columns as a plain dict."""
        return {name: self[name] for name in self}

    def copy(self) -> Table:
        """Another table of the same arrays."""
        return Table(self.columns, self.units)

    def _with_unit(self, name: str) -> str:
        unit = self.units.get(name, "1")
        return name + ("" if unit == "1" else f" ({unit})")

    def where(self, rows: np.ndarray) -> Table:
        """The rows of a mask, or of an array of row numbers."""
        return Table({name: values[rows] for name, values in self.columns.items()}, self.units)

    def label(self, name: str) -> str:
        """Name and unit for an axis: "front x (m)"."""
        unit = self._with_unit(name)[len(name):]
        return name.replace("_", " ") + unit

    def flat(self) -> Table:
        """One column per component: position becomes position_x, position_y, position_z."""
        columns, units = {}, {}
        for name, values in self.columns.items():
            parts = [(name, values)]
            if values.ndim == 2:
                parts = [(f"{name}_{'xyz'[c] if values.shape[1] == 3 else c}", values[:, c])
                         for c in range(values.shape[1])]
            for part, v in parts:
                columns[part] = v
                units[part] = self.units.get(name, "1")
        return Table(columns, units)

    def csv(self) -> str:
        """RFC 4180 text; every number in the shortest form that reads back as the same."""
        out = io.StringIO()
        flat = self.flat()
        writer = csv.writer(out, lineterminator="\n")
        writer.writerow(flat.columns)
        for row in zip(*(values.tolist() if values.dtype != np.float32 else map(str, values)
                         for values in flat.columns.values())):
            writer.writerow(row)
        return out.getvalue()

    def pandas(self) -> pandas.DataFrame:
        """The flat table as a pandas DataFrame (needs pandas); units in `.attrs["units"]`."""
        try:
            import pandas
        except ImportError:
            raise MissingPackage("pandas is not installed: pip install pandas") from None
        flat = self.flat()
        frame = pandas.DataFrame(flat.columns)
        frame.attrs["units"] = flat.units
        return frame


def write_text(path: str | Path, text: str, parents: bool = False) -> None:
    """Writes a text file, and the folders that lead to it with `parents`; FileError with the
    system's reason when that fails."""
    try:
        if parents:
            Path(path).parent.mkdir(parents=True, exist_ok=True)
        Path(path).write_text(text, encoding="utf-8")
    except OSError as problem:
        raise FileError(f"{path}: cannot write the file: {problem.strerror}") from None


def read_csv(path: str | Path, text: Collection[str] = ()) -> Table:
    """A CSV file with a header; lines that start with # are comments, of which "# units: time=s,
    speed=m/s" gives units.

    A column of numbers becomes float64 with nan for empty cells, any other one of strings, and
    those named in `text` always.
    FileError when the file cannot be read, BadInput naming the line when it is not a table.
    """
    try:
        lines = Path(path).read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as problem:
        reason = getattr(problem, "strerror", None) or "not a text file"
        raise FileError(f"{path}: cannot read the table: {reason}") from None
    numbered = [(n, line) for n, line in enumerate(lines, 1)
                if line.strip() and not line.startswith("#")]
    rows = list(csv.reader(line for _, line in numbered))
    if not rows:
        raise BadInput(f"{path}: the table is empty")
    header = rows[0]
    for (line, _), row in zip(numbered[1:], rows[1:]):
        if len(row) != len(header):
            raise BadInput(f"{path}:{line}: {len(row)} values for {len(header)} columns")
    cells = {name: [row[c] for row in rows[1:]] for c, name in enumerate(header)}
    return Table({name: np.array(column, dtype=str) if name in text else _column(column)
                  for name, column in cells.items()}, _units(lines))


def _units(lines: list[str]) -> dict[str, str]:
    mark = "# units: "
    return {name: unit for line in lines if line.startswith(mark)
            for name, _, unit in (part.rpartition("=") for part in line[len(mark):].split(", "))}


def read_csvs(paths: list[str]) -> Table:
    """Several CSV files one below the other; a column that one of them lacks is nan or ''."""
    tables = [read_csv(path) for path in paths]
    names = list(dict.fromkeys(name for table in tables for name in table))
    columns = {}
    for name in names:
        text = any(t[name].dtype.kind == "U" for t in tables if name in t.columns)
        parts = []
        for t in tables:
            if name in t.columns and len(t):
                parts.append(t[name].astype(str) if text else t[name])
            else:
                parts.append(np.full(len(t), "" if text else np.nan))
        columns[name] = np.concatenate(parts)
    return Table(columns, {n: u for table in tables for n, u in table.units.items()})


def need(table: Table, names: list[str], what: str) -> None:
    """BadInput unless the table has these columns and at least one row."""
    for name in names:
        if name not in table:
            raise UnknownName(f"{what}: {unknown('column', name, table)}")
    if not len(table):
        raise BadInput(f"{what}: the table has no rows")


def _column(cells: list[str]) -> np.ndarray:
    try:
        return np.array([float(cell) if cell.strip() else np.nan for cell in cells])
    except ValueError:
        return np.array(cells, dtype=str)
