"""Runs as NumPy files (.npz), for learning and for programs without HDF5.

Of one run to the file that -o names, else to a folder, NAME.npz for each run. Each file has
  position (frames, N, D)  m, of the fluid, then of the solids; D: x, y, z, in two dimensions x, z
  id, type (N,)            ids of the fluid, -1 of solids; 0 fluid, 1 solids at rest, 2 in motion
  time (frames,), dt       s, of the frames, and from one to the next
  bounds (D, 2)            m, of the domain
  periodic (D,)            axes whose faces are joined
  spacing                  m, between particles at rest
All particles are in all frames; runs in which they appear and disappear are refused.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from . import trajectory
from .errors import BadInput
from .trajectory import Trajectory
from .whole_file import whole_files

EXAMPLE = """examples:
  python -m pbf_tools to-npz out/demo -o demo.npz
  python -m pbf_tools to-npz out/batch_ramps -o ramps_npz --frames all"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    trajectory.add_arguments(parser)
    parser.add_argument("-o", "--out", required=True, metavar="OUT",
                        help="file to write (one run), or folder")


def arrays(t: Trajectory) -> dict[str, np.ndarray]:
    """What a file holds."""
    return {"position": np.concatenate(list(t.blocks())), "id": t.ids, "type": t.types,
            "time": t.times, "dt": np.float64(t.interval), "bounds": np.column_stack([t.low, t.high]),
            "periodic": t.periodic, "spacing": np.float64(t.spacing)}


def run(args: argparse.Namespace) -> int:
    several = len(args.runs) > 1 or not args.out.endswith(".npz")
    all_of_them = trajectory.trajectories(args)
    if not several and len(all_of_them) > 1:
        raise BadInput(f"{args.out}: is one file, and there are {len(all_of_them)} runs; name a "
                       "folder")
    names = [t.name for t in all_of_them]
    if several and len(set(names)) < len(names):
        twice = next(n for n in names if names.count(n) > 1)
        raise BadInput(f"{args.out}: two of the runs would be {twice}.npz; convert them one by one")
    for t in all_of_them:
        path = Path(args.out) / f"{t.name}.npz" if several else Path(args.out)
        values = arrays(t)
        with whole_files([path]) as (unfinished,), unfinished.open("wb") as file:
            np.savez(file, **values)
    print(f"wrote {len(all_of_them)} {'run' if len(all_of_them) == 1 else 'runs'} to {args.out}")
    return 0
