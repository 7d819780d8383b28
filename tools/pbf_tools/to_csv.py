"""Frames, the log, gauges, loads or one particle's track as CSV; frames also as extended XYZ for OVITO.

Goes to stdout, or to a file. Units are those of the run file, SI (see run.units in the package).
Tables of gauges and loads have them in the names of their columns, time_s, H_m, U_x_m_s, P_peak_Pa,
load_post_x_N: plot-gauges --experiment compares other runs with them. Gauges are read every
output.gauges_every, loads with the log: both go into one table where the times are the same, which
they are without that key; else give two commands.
"""

from __future__ import annotations

import argparse
import sys

import numpy as np

from . import frame_range, readings
from .errors import BadInput
from .fields import Frame
from .logs import RUN_HELP, read_run
from .run_file import Run
from .table import Table, write_text

EXAMPLE = """examples:
  python -m pbf_tools to-csv out/demo --log -o log.csv
  python -m pbf_tools to-csv out/demo --loads -o loads.csv
  python -m pbf_tools to-csv out/demo --frames -1 -o last.csv
  python -m pbf_tools to-csv out/demo --frames -1 --particles -o start.csv
      (x,y,z,vx,vy,vz: a body of shape `file` in another scene starts from there; with
       solver.prestabilize: false its compression stays as it is)
  python -m pbf_tools to-csv out/demo --frames all --xyz -o run.xyz"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("run_file", metavar="RUN", help=RUN_HELP)
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--log", action="store_true", help="measures and seconds per stage")
    what.add_argument("--gauges", action="store_true",
                      help="readings of the gauges, at their times; with --loads those too")
    what.add_argument("--track", type=int, metavar="ID", help="one particle over all frames")
    what.add_argument("--particles", action="store_true",
                      help="one frame as a particle file that scenes can read")
    what.add_argument("--xyz", action="store_true", help="frames as extended XYZ")
    parser.add_argument("--loads", action="store_true",
                        help="loads on walls and obstacles, at the times of the log; alone or with "
                             "--gauges")
    parser.add_argument("--frames", default="-1", help=frame_range.HELP + " (default %(default)s)")
    parser.add_argument("--fields", metavar="NAMES",
                        help="fields, separated by commas (default: all)")
    parser.add_argument("-o", "--out", metavar="FILE", help="file to write (default: stdout)")


def frame_table(frame: Frame, fields: list[str], units: dict[str, str]) -> Table:
    """One row per particle: time (s) and the fields."""
    columns = {"time": np.full(frame.count, frame.time)}
    columns.update((name, frame[name]) for name in fields)
    return Table(columns, {"time": "s", **units})


def extended_xyz(frame: Frame, fields: list[str]) -> str:
    """One frame in the extended XYZ format: species F (fluid), positions, then the fields."""
    names = ["position"] + [n for n in fields if n != "position"]
    values = [np.atleast_2d(frame[n].T).T for n in names]
    kinds = ["I" if v.dtype.kind == "i" else "R" for v in values]
    spec = ":".join(f"{'pos' if n == 'position' else n}:{k}:{v.shape[1]}"
                    for n, k, v in zip(names, kinds, values))
    lines = [str(frame.count), f'Properties=species:S:1:{spec} Time={frame.time!r}']
    texts = [[" ".join(map(str, row)) for row in v] for v in values]
    lines += ["F " + " ".join(parts) for parts in zip(*texts)]
    return "\n".join(lines) + "\n"


def run(args: argparse.Namespace) -> int:
    text = _text(read_run(args.run_file), args)
    if args.out:
        write_text(args.out, text)
    else:
        sys.stdout.write(text)
    return 0


def _text(r: Run, args: argparse.Namespace) -> str:
    fields = args.fields.split(",") if args.fields else r.fields
    if args.loads and (args.log or args.track is not None or args.particles or args.xyz):
        raise BadInput("--loads goes alone or with --gauges")
    if args.gauges or args.loads:
        table = readings.table(r, args.gauges, args.loads)
        return readings.head(r, table) + table.csv()
    if args.log:
        return r.log.csv()
    if args.track is not None:
        return r.track(args.track, *(args.fields.split(",") if args.fields else ())).csv()
    frames = [r.frames[k] for k in frame_range.parse(args.frames, len(r.frames))]
    if args.xyz:
        return "".join(extended_xyz(frame, fields) for frame in frames)
    if args.particles:
        if len(frames) != 1:
            raise BadInput("--particles takes one frame: --frames K")
        columns = {n: frames[0]["position"][:, c] for c, n in enumerate("xyz")}
        if "velocity" in r.fields:
            columns |= {f"v{n}": frames[0]["velocity"][:, c] for c, n in enumerate("xyz")}
        return Table(columns).csv()
    first, *rest = (frame_table(frame, fields, r.units).csv() for frame in frames)
    return first + "".join(text.split("\n", 1)[1] for text in rest)
