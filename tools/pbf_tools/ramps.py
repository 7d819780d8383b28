"""Sets of random scenes for learning: water that falls on turned plates, as `make-scene ramps` writes
them."""

from __future__ import annotations

import argparse
import itertools
from pathlib import Path

from .errors import BadInput
from .ramp_scene import Ramp, Settings
from .table import write_text

MARK = "# Made by: python -m pbf_tools make-scene ramps"
# By the number of dimensions: with fewer particles, plates two spacings thick are too large for the
# box.
FEWEST = {2: 200, 3: 1000}
MOST_SCENES = 100000  # names have five digits
OPTIONS = ("seed", "number", "dimensions", "particles", "frames", "every")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("ramps")
    group.add_argument("--seed", type=int, metavar="S", help="of the random numbers (default 0)")
    group.add_argument("--number", type=int, metavar="N", help="of scenes (default 10)")
    group.add_argument("--dimensions", type=int, choices=(2, 3), help="default 2")
    group.add_argument("--particles", type=int, metavar="N",
                       help="on average; a scene has 0.8 to 1.2 times as many (default 2000)")
    group.add_argument("--frames", type=int, metavar="N",
                       help="in a run, with that at time 0 (default 400)")
    group.add_argument("--every", type=float, metavar="S",
                       help="time between frames, s (default: 0.06 sqrt(h/g), rounded down)")


def run(args: argparse.Namespace) -> int:
    given = {name: getattr(args, name) for name in OPTIONS
             if name != "number" and getattr(args, name) is not None}
    number = 10 if args.number is None else args.number
    settings = _checked(Settings(**given), number)
    folder = Path(args.out)
    words = " ".join(f"--{name} {value:g}" if name == "every" else f"--{name} {value}"
                     for name, value in given.items())
    texts = {}
    for k in range(number):
        name = f"ramp_{k:05d}"
        head = f"{MARK}{' ' + words if words else ''}; sample {k}"
        texts[folder / f"{name}.yaml"] = Ramp(settings, k).text(name, head)
    _refuse_others(folder, texts)
    for path, text in texts.items():
        if not path.exists():  # else it is the same
            write_text(path, text, parents=True)
    print(f"wrote {number} scenes in {folder}: spacing {settings.spacing:g} m, {settings.frames} "
          f"frames, {settings.interval:g} s apart; try: pbf batch {folder}")
    return 0


def _checked(s: Settings, number: int) -> Settings:
    if not 1 <= number <= MOST_SCENES:
        raise BadInput(f"--number must be from 1 to {MOST_SCENES}")
    if s.seed < 0:
        raise BadInput("--seed must be at least 0")
    if s.particles < FEWEST[s.dimensions]:
        raise BadInput(f"--particles must be at least {FEWEST[s.dimensions]} with --dimensions "
                       f"{s.dimensions}: fewer and larger ones leave no room for plates")
    if s.frames < 2:
        raise BadInput("--frames must be at least 2")
    if s.every is not None and not 0 < s.every < 1e6:
        raise BadInput("--every must be above 0")
    return s


def _refuse_others(folder: Path, texts: dict[Path, str]) -> None:
    """`pbf batch FOLDER` runs all scenes of a folder: BadInput where others are there, or some of
    these with other settings."""
    there = itertools.chain(folder.glob("*.yaml"), folder.glob("*.yml")) if folder.is_dir() else ()
    for path in sorted(there):
        if path not in texts or path.read_text(encoding="utf-8", errors="replace") != texts[path]:
            raise BadInput(f"{path}: the folder holds a scene that is not of this set; give "
                           "another folder, or remove it")
