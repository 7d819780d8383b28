"""Readings of a run beside measurements, compared by the program (`pbf compare-data`)."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any

import h5py

from . import index
from . import program as pbf
from .errors import UnknownName, unknown
from .run_file import Run

Names = str | Sequence[str] | Mapping[str, str]


class Comparisons(dict):
    """Results by the name of the comparison; one that is not there gets a suggestion."""

    def __missing__(self, name: str) -> dict[str, Any]:
        raise UnknownName(unknown("comparison", name, self))


def compare_data(run: Run | str | os.PathLike[str], data: str | os.PathLike[str] | Run | None = None,
                 *, gauge: Names = (), load: Names = (), log: Names = (),
                 program: str | os.PathLike[str] | None = None, **options: Any) -> Comparisons:
    """RMS, bias, correlation, lag, peak, arrival, mean and impulse of readings beside `data`, a CSV
    table or another run; without `data` what the run's scene compares. Each result is a dict.

        compare_data("out/a", "heights.csv", gauge={"H2": "H2_mm"}, average=0.02)["H2"]["rms"]

    gauge, load, log: readings as on the command line ("H2", "U/x", "post/x", "front_x"), with their
    columns where they are named otherwise. options: those of the command, with _ for -
    (lag_range=(-0.2, 0.2)). PbfError with the program's message where something cannot be compared.
    """
    words = ["compare-data", os.fspath(run), "--json"]
    if data is not None:
        words += ["--data", os.fspath(data)]
    for option, names in (("--gauge", gauge), ("--load", load), ("--log", log)):
        pairs = names.items() if isinstance(names, Mapping) else \
            [(name, "") for name in ([names] if isinstance(names, str) else names)]
        for name, column in pairs:
            words += [option, f"{name}={column}" if column else name]
    for name, value in options.items():
        text = value if isinstance(value, str) or not isinstance(value, Sequence) else \
            ",".join(str(v) for v in value)
        words.append(f"--{name.replace('_', '-')}={text}")
    return Comparisons(pbf.answer(pbf.find(program), words))


def stored(file: h5py.File) -> Comparisons:
    """What the run itself has compared (key `compare` of its scene); empty where nothing."""
    found = Comparisons()
    for name, group in file.get("pbf/compare", {}).items():
        found[name] = {number: float(d[()]) for number, d in group.items()}
        found[name] |= {key: index._text(value) for key, value in group.attrs.items()}
        found[name]["unit"] = index._text(group["rms"].attrs["units"])
    return found
