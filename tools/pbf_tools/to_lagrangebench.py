"""A data set for learning, in the layout that LagrangeBench reads: train.h5, valid.h5, test.h5 and
metadata.json.

Each run is a group 00000, 00001 ... with position (frames, N, D), m, particle_type (N,), 0 fluid,
1 solids at rest, 2 solids in motion, and particle_id (N,), -1 of solids; its attribute run is its
name. D: x, y, z, in two dimensions x, z. Which runs are for training follows from --seed.
metadata.json has the mean and the standard deviation of velocities and accelerations of the
fluid, as differences from frame to frame (m), over the runs for training.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from . import trajectory
from .errors import BadInput, note
from .moments import Moments
from .trajectory import Trajectory
from .whole_file import KeptErrors, whole_files

EXAMPLE = """examples:
  python -m pbf_tools make-scene ramps --seed 1 --number 100 -o ramps
  pbf batch ramps --out out/ramps --jobs 8
  python -m pbf_tools to-lagrangebench out/ramps -o ramps_data
      (in Python: lagrangebench.H5Dataset("train", "ramps_data", name="ramps"))"""
PARTS = ("train", "valid", "test")
MOST_RUNS = 100000  # names of groups have five digits, and are read in alphabetical order


def shares(text: str) -> list[float]:
    """Three numbers above 0, separated by commas, divided by their sum."""
    try:
        values = [float(v) for v in text.split(",")]
    except ValueError:
        values = []
    if len(values) != 3 or not all(0 < v < 1e6 for v in values):
        raise argparse.ArgumentTypeError(f"{text}: write three numbers above 0: 0.8,0.1,0.1")
    return [v / sum(values) for v in values]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    trajectory.add_arguments(parser)
    parser.add_argument("-o", "--out", required=True, metavar="DIR", help="folder of the data set")
    parser.add_argument("--overwrite", action="store_true", help="replace the data set in it")
    parser.add_argument("--split", type=shares, default=[0.8, 0.1, 0.1], metavar="A,B,C",
                        help="shares for training, validation, test (default 0.8,0.1,0.1)")
    parser.add_argument("--seed", type=int, default=0, metavar="S",
                        help="of the random split (default %(default)s)")
    parser.add_argument("--radius", type=float, metavar="M",
                        help="default_connectivity_radius, m (default: 1.5 spacings)")
    parser.add_argument("--gzip", action="store_true",
                        help="compress positions: smaller files, read more slowly")


def split(number: int, parts: list[float], seed: int) -> list[list[int]]:
    """Which of the runs 0, 1 ... are for training, validation and test, each ascending; at least
    one for each.

    >>> [len(part) for part in split(12, [0.8, 0.1, 0.1], 0)]
    [10, 1, 1]
    """
    few = [max(1, round(number * share)) for share in parts[1:]]
    while sum(few) > number - 1:
        few[few.index(max(few))] -= 1
    order = np.random.default_rng(seed).permutation(number)
    ends = np.cumsum([number - sum(few), few[0]])
    return [sorted(part.tolist()) for part in np.split(order, ends)]


def run(args: argparse.Namespace) -> int:
    if args.seed < 0:
        raise BadInput("--seed must be at least 0")
    if args.radius is not None and not 0 < args.radius < 1e12:
        raise BadInput("--radius must be above 0")
    out = Path(args.out)
    files = [*(f"{part}.h5" for part in PARTS), "metadata.json"]
    there = [name for name in files if (out / name).exists()]
    if there and not args.overwrite:
        raise BadInput(f"{out}: has a {there[0]} already; give another folder, or --overwrite")
    data = trajectory.trajectories(args)
    _require_alike(data)
    if _some_axes(data[0]) and not args.walls:
        note("some axes are periodic: the walls of the others are particles, for LagrangeBench joins "
             "the faces of all axes")
        args.walls = True
        data = trajectory.trajectories(args)
    data.sort(key=lambda t: t.name)
    parts = [[data[k] for k in part] for part in split(len(data), args.split, args.seed)]
    place = Place(data[0], args)
    moments = Moments(place.box)
    with whole_files([out / name for name in files]) as unfinished:
        for path, name, members in zip(unfinished, PARTS, parts):
            _write(path, members, place, args.gzip, moments if name == "train" else None)
        content = metadata(parts, place, moments, args)
        unfinished[-1].write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")
    sizes = ", ".join(f"{len(members)} {name}" for name, members in zip(PARTS, parts))
    print(f"wrote {out}: {sizes}; {len(data[0].frames)} frames, at most "
          f"{content['num_particles_max']} particles")
    return 0


class Place:
    """Where positions are in a data set. With a periodic axis LagrangeBench wraps positions into a
    box that begins at 0; where only some axes are periodic, that box must be so large that
    particles at opposite walls are no neighbors across it."""

    def __init__(self, t: Trajectory, args: argparse.Namespace):
        self.radius = args.radius or float(f"{1.5 * t.spacing:.9g}")
        margin = np.zeros(len(t.low))
        if args.walls:  # particles lie half a spacing outside
            margin[~t.periodic] = t.spacing + (self.radius if t.periodic.any() else 0)
        self.low, self.high = t.low - margin, t.high + margin
        self.origin = self.low if t.periodic.any() else np.zeros(len(t.low))
        # Of each axis the length over which positions repeat; inf: they do not.
        self.box = np.where(t.periodic, t.high - t.low, np.inf)
        self.bounds = np.column_stack([self.low, self.high]) - self.origin[:, None]


def _some_axes(t: Trajectory) -> bool:
    return bool(t.periodic.any() and not t.periodic.all())


def _require_alike(data: list[Trajectory]) -> None:
    """BadInput, with the names of both, for runs that do not fit into one data set."""
    if len(data) < len(PARTS):
        raise BadInput(f"a data set needs at least {len(PARTS)} runs, for training, validation and "
                       f"test; given: {len(data)}")
    if len(data) > MOST_RUNS:
        raise BadInput(f"a data set has at most {MOST_RUNS} runs; given: {len(data)}")
    first = data[0]
    same: dict[str, Callable[[Trajectory], Any]] = {
        "the number of dimensions": lambda t: len(t.axes),
        "the domain, m,": lambda t: np.column_stack([t.low, t.high]).tolist(),
        "the periodic axes": lambda t: t.periodic.tolist(),
        "the spacing, m,": lambda t: float(f"{t.spacing:.9g}"),
        "the time between frames, s,": lambda t: float(f"{t.interval:.6g}"),
        "the number of frames": lambda t: len(t.frames)}
    for t in data[1:]:
        for what, value in same.items():
            if value(t) != value(first):
                raise BadInput(f"{t.run.path}: {what} is {value(t)}, but in {first.run.path} "
                               f"{value(first)}; the runs of a data set must have the same")


def _write(path: Path, members: list[Trajectory], place: Place, gzip: bool,
           moments: Moments | None) -> None:
    """One file; a few MB of a run are in memory at a time. OSError, also on a full disk."""
    with path.open("w+b", buffering=0) as raw:
        kept = KeptErrors(raw)
        with h5py.File(kept, "w") as file:
            for k, t in enumerate(members):
                _write_run(file.create_group(f"{k:05d}"), t, place, gzip, moments, kept)
        kept.check()


def _write_run(group: h5py.Group, t: Trajectory, place: Place, gzip: bool, moments: Moments | None,
               kept: KeptErrors) -> None:
    group.attrs["run"] = t.name
    group["particle_type"] = t.types.astype(np.int64)
    group["particle_id"] = t.ids.astype(np.int64)
    shape = (len(t.frames), len(t.types), len(t.axes))
    how = {"chunks": (min(8, shape[0]), *shape[1:]), "compression": "gzip", "shuffle": True} \
        if gzip else {}
    position = group.create_dataset("position", shape, np.float32, **how)
    position.attrs["units"] = "m"
    row = 0
    for block in t.blocks():
        block = (block - place.origin).astype(np.float32)
        position[row:row + len(block)] = block
        kept.check()
        row += len(block)
        if moments:
            moments.add(block[:, :t.count].astype(np.float64))
    if moments:
        moments.end()


def metadata(parts: list[list[Trajectory]], place: Place, moments: Moments,
             args: argparse.Namespace) -> dict[str, Any]:
    """The keys that LagrangeBench reads, and those that its data sets have."""
    train, valid, test = parts
    data, first = [*train, *valid, *test], train[0]
    updates = first.updates if all(t.updates == first.updates for t in data) else 0
    # A position that a window of training ends with is its target, and is not counted.
    sequence = len(first.frames) - 1
    return {"solver": "PBF", "dim": len(first.axes), "dx": first.spacing,
            "dt": first.interval / max(1, updates), "write_every": max(1, updates),
            "t_end": float(first.times[-1] - first.times[0]),
            "sequence_length_train": sequence, "num_trajs_train": len(train),
            "sequence_length_test": sequence, "num_trajs_test": len(test),
            "num_trajs_valid": len(valid), "split_seed": args.seed,
            "num_particles_max": max(len(t.types) for t in data),
            "periodic_boundary_conditions": first.periodic.tolist(),
            "bounds": place.bounds.tolist(), "default_connectivity_radius": place.radius,
            **moments.values(float(np.abs([place.low, place.high, *place.bounds.T]).max())),
            "description": f"Made by pbf_tools of runs of pbf, of which the first is {data[0].name}."}
