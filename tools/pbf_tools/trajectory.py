"""Runs as trajectories for learning: the particles of the fluid and of the solids over equal times."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from . import frame_range
from .errors import BadInput, MissingPackage
from .logs import UNFINISHED
from .run_file import Run
from .run_path import RUN_FILE, folder_of_run, run_path
from .solids import Solid, solid_of, walls
from .sweep import SUMMARY, read_batch

# As LagrangeBench and the data sets of Sanchez-Gonzalez et al. number them.
FLUID, FIXED, MOVING = 0, 1, 2
NO_ID = -1  # of a particle that is not of the fluid
BLOCK_BYTES = 1 << 24  # of positions at a time
SLACK = 0.01  # of a spacing: positions beyond a wall by more are outside


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The arguments of commands that convert runs."""
    parser.add_argument("runs", nargs="+", metavar="RUN",
                        help="run file, run folder, or folder of a batch (all of its runs)")
    parser.add_argument("--finished", action="store_true",
                        help="leave out the runs of a batch that are not finished")
    parser.add_argument("--frames", default="all", help=frame_range.HELP + " (default %(default)s)")
    parser.add_argument("--no-solids", action="store_true",
                        help="leave out the obstacles, which are particles of type 1 or, where "
                             "they move, 2")
    parser.add_argument("--walls", action="store_true",
                        help="the walls of the domain as particles of type 1, too")


def trajectories(args: argparse.Namespace) -> list[Trajectory]:
    """Those that the arguments name."""
    runs = [run for path in args.runs for run in _runs(path, args.finished)]
    seen = set()
    for path in runs:
        file = run_path(path).resolve()
        if file in seen:
            raise BadInput(f"{path}: this run is given twice")
        seen.add(file)
    return [Trajectory.of(path, args.frames, not args.no_solids, args.walls) for path in runs]


def _runs(path: str, finished: bool) -> list[str | Path]:
    """The run of a path, or those of a batch."""
    folder = Path(path)
    if (folder / RUN_FILE).exists() or not (folder / SUMMARY).is_file():
        return [path]
    table = read_batch(path)
    bad = table.where(table["reason"] != "finished")
    if len(bad) and not finished:
        raise BadInput(f"{path}: {len(bad)} of {len(table)} runs are not finished, the first is "
                       f"{bad['name'][0]} ({bad['reason'][0]}); give the same `pbf batch` again, "
                       "or leave them out with --finished")
    good = table.where(table["reason"] == "finished")
    if not len(good):
        raise BadInput(f"{path}: no run of this batch is finished")
    return [folder / name for name in good["name"].tolist()]


@dataclass
class Trajectory:
    """A finished run. Lengths in m, times in s; D axes: x, y, z, of a run in two dimensions x, z.

    `count` particles of fluid come first, in the order of `ids`, then those of the solids. Both are
    the same in all `frames`, which are `interval` apart; otherwise `of` raises BadInput, with the
    frame.
    """

    run: Run
    name: str
    frames: list[int]
    times: np.ndarray
    interval: float
    updates: int  # from frame to frame; 0 where that differs
    axes: list[int]
    low: np.ndarray  # (D,), of the domain
    high: np.ndarray
    periodic: np.ndarray  # (D,)
    spacing: float
    ids: np.ndarray  # (N,), NO_ID for solids
    types: np.ndarray  # (N,)
    count: int
    solids: list[Solid] = field(default_factory=list)

    @classmethod
    def of(cls, path: str | Path, frames: str = "all", solids: bool = True,
           wall_particles: bool = False) -> Trajectory:
        run = Run(path)
        _require_end(run)
        numbers = frame_range.parse(frames, len(run.times))
        if len(numbers) < 2:
            raise BadInput(f"{run.path}: a trajectory needs at least 2 frames, here is 1")
        scene = scene_of(run)
        ids = _ids(run, numbers)
        times, updates = run.times[numbers], np.diff(run.updates[numbers])
        _require_equal_times(run, numbers, times)
        found = _solids(run, scene, solids, wall_particles)
        types = [np.full(len(ids), FLUID)]
        types += [np.full(len(s.points), MOVING if s.moves else FIXED) for s in found]
        others = sum(map(len, types)) - len(ids)
        axes = [0, 2] if _flat(scene) else [0, 1, 2]
        low, high = _domain(run)
        return cls(run, _name(run), numbers, times, (times[-1] - times[0]) / (len(times) - 1),
                   int(updates[0]) if np.all(updates == updates[0]) else 0, axes, low[axes],
                   high[axes], np.array(["xyz"[a] in _periodic(scene) for a in axes]),
                   float(run.info["spacing"]), np.concatenate([ids, np.full(others, NO_ID)]),
                   np.concatenate(types), len(ids), found)

    def blocks(self) -> Iterator[np.ndarray]:
        """Positions of all frames, (some frames, N, D), m, a few MB at a time. BadInput for one that
        is not finite, or that lies outside the domain."""
        most = max(1, BLOCK_BYTES // (8 * len(self.axes) * max(1, len(self.types))))
        position = self.run["position"]
        for first in range(0, len(self.frames), most):
            numbers = self.frames[first:first + most]
            fluid = position[numbers][..., self.axes]
            self._check(fluid, numbers)
            parts = [fluid]
            for solid in self.solids:
                parts.append(self._solid(solid, numbers).astype(fluid.dtype))
            yield np.concatenate(parts, axis=1) if len(parts) > 1 else fluid

    def _solid(self, solid: Solid, numbers: list[int]) -> np.ndarray:
        if not solid.moves:
            return np.broadcast_to(solid.points[:, self.axes],
                                   (len(numbers), len(solid.points), len(self.axes)))
        bodies = self.run.bodies
        if solid.name in bodies:  # its frames are exact, between rows of the log it is not known
            body = bodies[solid.name]
            poses = body.turn[numbers], body.middle[numbers]
        else:
            poses = self.run.obstacle_pose(solid.name, self.run.times[numbers])
        return np.take(solid.at(*poses), self.axes, axis=-1)

    def _check(self, x: np.ndarray, numbers: list[int]) -> None:
        slack = SLACK * self.spacing
        for what, bad, remedy in (
                ("is not finite", ~np.isfinite(x), "leave it out with --frames"),
                ("is outside the domain", (x < self.low - slack) | (x > self.high + slack),
                 "a network knows no fluid there: close the face (domain.open), or leave the frame "
                 "out with --frames")):
            if bad.any():
                k, row = (int(v) for v in np.argwhere(bad)[0][:2])
                place = ", ".join(f"{v:.4g}" for v in x[k, row])
                raise BadInput(f"{self.run.path}: frame {numbers[k]}: the position of particle "
                               f"{self.ids[row]}, ({place}), {what}; {remedy}")


def scene_of(run: Run) -> dict[str, Any]:
    """The scene of a run with every default, as a tree of dicts, lists and texts."""
    try:
        import yaml
    except ImportError:
        raise MissingPackage("PyYAML, which reads the scene of a run, is not installed: "
                             "pip install pyyaml") from None
    return yaml.load(run.scene, Loader=yaml.BaseLoader)


# Files of older versions lack some keys.
def _flat(scene: dict[str, Any]) -> bool:
    return scene.get("dimensions") == "2"


def _periodic(scene: dict[str, Any]) -> list[str]:
    return scene["domain"].get("periodic", [])


def _domain(run: Run) -> tuple[np.ndarray, np.ndarray]:
    return np.asarray(run.info["domain_min"], float), np.asarray(run.info["domain_max"], float)


def _solids(run: Run, scene: dict[str, Any], obstacles: bool, wall_particles: bool) -> list[Solid]:
    spacing, (low, high) = float(run.info["spacing"]), _domain(run)
    try:
        found = [solid_of(o, spacing, _flat(scene), low, high) for o in scene.get("obstacles", [])] \
            if obstacles else []
    except BadInput as problem:
        raise BadInput(f"{run.path}: {problem}") from None
    if wall_particles:
        missing = _periodic(scene), scene["domain"].get("open", [])
        walled = np.array([[a not in missing[0] and f"{a}_{end}" not in missing[1]
                            for end in ("min", "max")] for a in "xyz"])
        points = walls(low, high, spacing, walled, _flat(scene))
        found.append(Solid("walls", False, (low + high) / 2, points))
    return found


def _name(run: Run) -> str:
    """Of the run in a data set: its folder or, of a copy, its file."""
    folder = folder_of_run(run.path.absolute())
    return folder.name if folder else run.path.stem


def _require_end(run: Run) -> None:
    folder = folder_of_run(run.path)
    if run.status != "finished":
        raise BadInput(f"{run.path}: this run {UNFINISHED.get(run.status, run.status)}; go on with "
                       "it (pbf run --resume), or leave it out")
    if folder is not None and not (folder / "DONE").is_file():
        raise BadInput(f"{run.path}: there is no DONE beside it, so the run has not come to its end; "
                       "go on with it (pbf run --resume), or leave it out")


def _ids(run: Run, numbers: list[int]) -> np.ndarray:
    """Ids of the particles, the same in all these frames."""
    first, place = run.ids[numbers[0]], run.ids._place
    for k in numbers[1:]:
        same = run.counts[k] == len(first)
        # Frames without gaps in their ids share one list of them in the file.
        if same and place.offsets[k] != place.offsets[numbers[0]]:
            same = np.array_equal(run.ids[k], first)
        if not same:
            raise BadInput(f"{run.path}: frame {k} has other particles than frame {numbers[0]} "
                           f"({run.counts[k]} and {len(first)}): a trajectory is of the same "
                           "particles in all frames; choose such frames with --frames")
    return first


def _require_equal_times(run: Run, numbers: list[int], times: np.ndarray) -> None:
    steps = np.diff(times)
    usual = float(np.median(steps))
    off = np.abs(steps - usual) > 1e-6 * usual
    if off.any():
        k = int(np.argmax(off))
        raise BadInput(f"{run.path}: frame {numbers[k + 1]} is {steps[k]:.6g} s after the one "
                       f"before, others {usual:.6g} s: a trajectory has equal steps; choose frames "
                       "with --frames, 0:-1 say")
