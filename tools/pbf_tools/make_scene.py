"""Writes a scene: a standard set-up with a given number of particles, or an image or a mesh filled
with particles.

block is a dam break. blob and stream have the geometry of the scenes of the reference
implementation (y up, box 2 x 8 x 2 m), filled at rest density. configs/reference_implementation/
has those scenes in their own formulation, with too many particles at random positions.
image turns the dark pixels of a picture into fluid; the picture stands upright in x and z. mesh
fills a closed surface (.stl, .ply, .obj, .vtp; needs PyVista). Both write the particles to
NAME_particles.h5 beside the scene.
ramps writes a folder of random scenes for learning, in which a block or a ball of water falls on
turned plates. Sample k of a seed is the same for every --number.
"""

from __future__ import annotations

import argparse
import math
from pathlib import Path

import numpy as np

from . import ramps
from .errors import BadInput, FileError
from .fill import fill_image, fill_mesh
from .table import write_text

EXAMPLE = """examples:
  python -m pbf_tools make-scene blob --count 16384 -o blob.yaml
  python -m pbf_tools make-scene block --count 50000 --size 0.4,0.4,0.8 --box 1.6,0.4,1 -o dam.yaml
  python -m pbf_tools make-scene image --file logo.png --width 1 --spacing 0.01 -o logo.yaml
  python -m pbf_tools make-scene mesh --file bunny.stl --width 0.5 --spacing 0.01 -o bunny.yaml
  python -m pbf_tools make-scene ramps --seed 1 --number 1000 --particles 2000 -o ramps"""
SHAPES = ("blob", "stream", "block", "image", "mesh", "ramps")


def numbers(text: str) -> list[float]:
    """Three numbers above 0, separated by commas."""
    values = [float(v) for v in text.split(",")]
    if len(values) != 3 or not all(0 < v < 1e12 for v in values):
        raise argparse.ArgumentTypeError(f"{text}: write three numbers above 0: 1.6,0.4,1")
    return values


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("shape", choices=SHAPES)
    parser.add_argument("-o", "--out", required=True, metavar="SCENE",
                        help="scene file to write; of ramps a folder")
    parser.add_argument("--count", type=int, metavar="N", help="particles (blob, stream, "
                        "block; default 16384); the top layer may be incomplete")
    parser.add_argument("--size", type=numbers, default=[0.4, 0.4, 0.8], metavar="X,Y,Z",
                        help="size of the block, m (default 0.4,0.4,0.8)")
    parser.add_argument("--box", type=numbers, metavar="X,Y,Z",
                        help="domain, m (block: default 1.6,0.4,1; image, mesh: default twice the "
                             "fluid along x and y, 1.5 times along z)")
    parser.add_argument("--file", metavar="FILE", help="picture or mesh")
    parser.add_argument("--width", type=float, metavar="M",
                        help="width of the picture or mesh along x, m")
    parser.add_argument("--depth", type=float, metavar="M",
                        help="depth of the fluid behind a picture, along y, m (default: "
                             "--width / 4)")
    parser.add_argument("--threshold", type=float, default=0.5, metavar="B",
                        help="pixels darker than this are fluid, 0..1 (default 0.5)")
    parser.add_argument("--invert", action="store_true", help="bright pixels are fluid")
    parser.add_argument("--spacing", type=float, metavar="M",
                        help="particle spacing, m (image, mesh)")
    parser.add_argument("--end", type=float, default=2, metavar="S",
                        help="simulated time, s (default 2)")
    ramps.add_arguments(parser)


def scene_text(name: str, box: tuple[list[float], list[float]], spacing: float, body: str,
               gravity: str, end: float) -> str:
    """A scene in YAML. The time step is 0.03 sqrt(h/g) with h = 2 d, to two digits."""
    step = 0.03 * math.sqrt(2 * spacing / 9.81)
    digits = 1 - math.floor(math.log10(step))
    step = math.floor(step * 10**digits) / 10**digits
    every = max(step, 0.02)
    low, high = (", ".join(f"{v:.9g}" for v in corner) for corner in box)
    return (f"# Made by: python -m pbf_tools make-scene\n"
            f"name: {name}\n"
            f"domain: {{min: [{low}], max: [{high}]}}\n"
            f"fluid: {{spacing: {spacing:.12g}}}\n"
            f"bodies:\n  - {body}\n"
            f"gravity: {gravity}\n"
            f"time: {{step: {step:.9g}, end: {end:.9g}}}\n"
            f"solver: {{iterations: 4}}\n"
            f"viscosity: {{xsph: 0.05}}\n"
            f"output: {{every: {every:.9g}, fields: [velocity, density]}}\n")


def run(args: argparse.Namespace) -> int:
    out = Path(args.out)
    if args.shape == "ramps":
        if args.count is not None:
            raise BadInput("--count is of blob, stream and block; give ramps --particles")
        return ramps.run(args)
    for name in ramps.OPTIONS:
        if getattr(args, name) is not None:
            raise BadInput(f"--{name} is of ramps, and {args.shape} does not take it")
    if not args.end > 0:
        raise BadInput("--end must be above 0")
    if args.shape in ("image", "mesh"):
        text, count = _filled(args, out)
    else:
        count = 16384 if args.count is None else args.count
        if count < 1:
            raise BadInput("--count must be at least 1")
        text, count = _block(args, out.stem, count)
    write_text(out, text)
    print(f"wrote {out}: {count} particles; try: pbf plan {out}")
    return 0


# Of the reference implementation's two scenes, m: the box, the fluid in it; y points up.
REFERENCE_BOX = ([-1.0, 0.0, -1.0], [1.0, 8.0, 1.0])
REFERENCE_FLUID = {"blob": ([-1.0, 1.0, -0.5], [0.0, 4.0, 0.5]),
              "stream": ([-0.1, 1.0, -0.1], [0.1, 7.0, 0.1])}


def _block(args: argparse.Namespace, name: str, count: int) -> tuple[str, int]:
    """A lattice of particles in a box-shaped body, and what is left over on top of it."""
    if args.shape == "block":
        box, low, high = args.box or [1.6, 0.4, 1.0], [0.0, 0.0, 0.0], args.size
        if any(s > b for s, b in zip(args.size, box)):
            raise BadInput("--size is larger than --box")
        domain, gravity = ([0.0, 0.0, 0.0], box), "[0, 0, -9.81]"
    else:
        low, high = REFERENCE_FLUID[args.shape]
        domain, gravity = REFERENCE_BOX, "[0, -9.81, 0]"
    up = 2 if args.shape == "block" else 1
    spacing, parts = lattice(np.subtract(high, low), count, up)
    bodies = []
    for first, last in parts:
        corners = [", ".join(f"{v:.12g}" for v in np.array(low) + spacing * np.array(cells))
                   for cells in (first, last)]
        bodies.append(f"{{shape: block, min: [{corners[0]}], max: [{corners[1]}]}}")
    return scene_text(name, domain, spacing, "\n  - ".join(bodies), gravity, args.end), count


Part = tuple[list[int], list[int]]  # first cell, and the one behind the last, along x, y, z


def lattice(size: np.ndarray, count: int, up: int) -> tuple[float, list[Part]]:
    """The largest spacing (m) whose lattice in a block of this size (3,), m, has room for `count`
    particles, and the boxes of cells that hold them: whole layers along axis `up`, whole rows of
    one more, and the rest of a row. The lattice fills the block exactly along one axis.

    >>> lattice(np.array([0.4, 0.4, 0.8]), 2000, 2)
    (0.04, [([0, 0, 0], [10, 10, 20])])
    >>> lattice(np.array([0.4, 0.4, 0.8]), 1995, 2)[1]
    [([0, 0, 0], [10, 10, 19]), ([0, 0, 19], [10, 9, 20]), ([0, 9, 19], [5, 10, 20])]
    """
    near = float(np.prod(size) / count) ** (1 / 3)

    def cells(d: float) -> np.ndarray:  # whole ones, as lib/scene/lattice.h counts them
        return np.floor(size / d + 1e-6).astype(int)

    spacing = max(d for d in (round(float(s) / k, 12) for s in size
                              for k in range(1, int(2 * s / near) + 3))
                  if np.prod(cells(d)) >= count)
    along, across = (a for a in range(3) if a != up)
    n = cells(spacing)
    layers, rest = divmod(count, int(n[along] * n[across]))
    rows, few = divmod(rest, int(n[along]))

    def part(row: tuple[int, int], length: int, layer: tuple[int, int]) -> Part:
        box: Part = ([0, 0, 0], [0, 0, 0])
        for corner in (0, 1):
            box[corner][across], box[corner][up] = row[corner], layer[corner]
        box[1][along] = length
        return box

    whole = part((0, int(n[across])), int(n[along]), (0, layers))
    top = part((0, rows), int(n[along]), (layers, layers + 1))
    last = part((rows, rows + 1), few, (layers, layers + 1))
    return spacing, [p for p, there in ((whole, layers), (top, rows), (last, few)) if there]


def _filled(args: argparse.Namespace, out: Path) -> tuple[str, int]:
    for name in ("file", "width", "spacing"):
        if getattr(args, name) is None:
            raise BadInput(f"{args.shape} needs --{name}")
    if not 0 < args.spacing < args.width < 1e12:
        raise BadInput("--spacing must be above 0 and below --width")
    if args.shape == "image":
        depth = args.width / 4 if args.depth is None else args.depth
        if not 0 < depth < 1e12:
            raise BadInput("--depth must be above 0")
        x = fill_image(args.file, args.width, depth, args.spacing, args.threshold, args.invert)
    else:
        x = fill_mesh(args.file, args.width, args.spacing)
    size = x.max(axis=0) - x.min(axis=0) + args.spacing
    box = np.array(args.box or size * [2, 2, 1.5])
    if np.any(size > box * (1 + 1e-9)):
        raise BadInput(f"the fluid is {' x '.join(f'{v:.3g}' for v in size)} m, larger than --box")
    # In the middle of the box along x and y, on its floor.
    shift = (box - size) / 2 * [1, 1, 0] + args.spacing / 2 - x.min(axis=0)
    particles = out.with_name(out.stem + "_particles.h5")
    _write_particles(particles, x + shift)
    return scene_text(out.stem, ([0, 0, 0], box.tolist()), args.spacing,
                      f"{{shape: file, path: {particles.name}}}", "[0, 0, -9.81]", args.end), len(x)


def _write_particles(path: Path, x: np.ndarray) -> None:
    import h5py

    try:
        with h5py.File(path, "w") as file:
            file.create_dataset("position", data=x).attrs["units"] = "m"
    except OSError as problem:
        raise FileError(f"{path}: cannot write the particles: {problem}") from None
