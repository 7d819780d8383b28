"""What lies where in a run file: read once, before any particle is."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeVar

import h5py
import numpy as np

from .errors import FileError, NotThere
from .run_path import beside

FORMAT_VERSION = 1  # of /pbf; lib/io/run_layout.h
T = TypeVar("T")


@dataclass
class Place:
    """Where a field lies: the dataset, and the first row of every frame in it."""

    path: str
    unit: str
    dtype: np.dtype
    components: int
    offsets: np.ndarray


@dataclass
class Index:
    """The committed frames of a run file and the attributes of the run."""

    times: np.ndarray  # (frames,), s
    updates: np.ndarray  # (frames,)
    counts: np.ndarray  # (frames,), particles
    fields: dict[str, Place]
    info: dict[str, Any]
    units: dict[str, str] = field(default_factory=dict)


def read(path: Path, action: Callable[[h5py.File], T], what: str) -> T:
    """Opens the file, gives it to `action`, closes it.

    Opened anew every time and without locks, because the file may still grow. What a live file
    shows while its writer commits may not fit together, so a failure is final when it repeats.
    """
    options = {"locking": False}
    for attempt in (1, 2, 3):
        try:
            with h5py.File(path, "r", **options) as file:
                return action(file)
        except (OSError, KeyError, RuntimeError, ValueError, MemoryError) as problem:
            if "locking flag" in str(problem):  # this process has it open already, with locks
                options = {}
                continue
            if attempt == 3 or not os.access(path, os.R_OK):
                if not path.exists():
                    raise NotThere(f"{path}: {what}: no such file{beside(path)}") from None
                raise FileError(f"{path}: {what}: {_reason(path, problem)}") from None
        time.sleep(0.02)
    raise AssertionError("not reached")


def _reason(path: Path, problem: Exception) -> str:
    if not os.access(path, os.R_OK):
        return "permission denied"
    if path.stat().st_size == 0:
        return "the file is empty"
    text = str(problem.args[0] if problem.args else problem)
    if "signature not found" in text:
        return "not an HDF5 file"
    if "truncated" in text:
        return f"the file was cut off, copy it again ({text})"
    return text


def scan(file: h5py.File) -> Index:
    """Reads the index; FileError for an HDF5 file that is not a run file of this version."""
    name = file.filename
    _refuse_other_files(file, name)
    if "pbf" not in file or "VTKHDF/Steps" not in file:
        raise FileError(f"{name}: an HDF5 file, but not one that pbf wrote "
                        "(no /pbf or no /VTKHDF/Steps)")
    pbf, vtk, steps = file["pbf"], file["VTKHDF"], file["VTKHDF/Steps"]
    version = pbf.attrs.get("format_version")
    if version is None:
        raise FileError(f"{name}: an HDF5 file, but not one that pbf wrote "
                        "(no /pbf format_version)")
    if int(version) != FORMAT_VERSION:
        raise FileError(f"{name}: format version {int(version)}; this package reads version "
                        f"{FORMAT_VERSION}")
    # What lies beyond the NSteps committed rows may be half written: it is not looked at.
    n = min(int(steps.attrs["NSteps"]), len(steps["Values"]), len(pbf["frames/update"]),
            len(steps["PartOffsets"]))
    fields = {}
    if n > 0:
        fields["position"] = _place(vtk, "Points", "Steps/PointOffsets")
        for key in vtk["PointData"]:
            fields[key] = _place(vtk, f"PointData/{key}", f"Steps/PointDataOffsets/{key}")
        n = min([n, *(len(place.offsets) for place in fields.values())])
    if "bodies" in pbf["frames"]:
        n = min(n, len(pbf["frames/bodies"]))
    counts = vtk["NumberOfPoints"][:][steps["PartOffsets"][:n]] if n else np.zeros(0, np.int64)
    info, units = _info(pbf)
    units.update({key: place.unit for key, place in fields.items()})
    return Index(steps["Values"][:n], pbf["frames/update"][:n], counts, fields, info, units)


def _refuse_other_files(file: h5py.File, name: str) -> None:
    """FileError where a link or a dataset leads into other files: one from elsewhere could take in
    any file of this machine. All that hard links reach is looked at, so soft links need not be."""
    seen, groups = set(), [file["/"]]
    while groups:
        group = groups.pop()
        address = h5py.h5o.get_info(group.id).addr
        if address in seen:
            continue
        seen.add(address)
        for key in group:
            link = group.get(key, getlink=True)
            place = f"{name}: {group.name.rstrip('/')}/{key}"
            if isinstance(link, h5py.ExternalLink):
                raise FileError(f"{place} is a link into another file (external link)")
            if not isinstance(link, h5py.HardLink):
                continue
            item = group[key]
            if isinstance(item, h5py.Group):
                groups.append(item)
            elif isinstance(item, h5py.Dataset) and item.external:
                raise FileError(f"{place} has its values in another file (external storage)")
            elif isinstance(item, h5py.Dataset) and item.is_virtual:
                raise FileError(f"{place} is put together from others (virtual dataset)")


def _place(vtk: h5py.Group, path: str, offsets: str) -> Place:
    data = vtk[path]
    components = data.shape[1] if data.ndim == 2 else 1
    return Place(f"VTKHDF/{path}", _text(data.attrs.get("units", "1")), data.dtype, components,
                 vtk[offsets][:])


def _text(value: object) -> str:
    return value.decode() if isinstance(value, bytes) else str(value)


def _info(pbf: h5py.Group) -> tuple[dict[str, Any], dict[str, str]]:
    info: dict[str, Any] = {}
    units: dict[str, str] = {}
    for key, value in pbf.attrs.items():
        if key == "plan":  # a page of text, with a name of its own: Run.plan
            continue
        if isinstance(value, np.ndarray):
            info[key] = [_text(v) for v in value]
        elif isinstance(value, np.generic):
            info[key] = value.item()
        else:
            info[key] = _text(value)
    for key, data in pbf.items():
        if isinstance(data, h5py.Dataset):
            info[key] = data[()].item() if data.ndim == 0 else data[()]
            units[key] = _text(data.attrs.get("units", "1"))
    return info, units
