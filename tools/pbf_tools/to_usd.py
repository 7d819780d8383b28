"""The particles of a run as USD points (.usdc, .usda, .usd), for Blender, Houdini and other programs
that read Universal Scene Description (needs usd-core).

A second of the run is a second of the file, a metre is a metre, and z is up. The file has
  /run/fluid       Points: points (m), velocities (m/s), widths (the spacing, m), ids, and what else
                   the frames have, such as density, as primvars
  /run/obstacles   boxes, spheres, cylinders and capsules; those that move, with a pose per frame
Numbers are float. Obstacles of other shapes (planes, meshes, beds of heights) and the walls of the
domain are left out. A frame at a time is in memory.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

from . import frame_range
from .errors import BadInput, FileError, MissingPackage, note
from .logs import RUN_HELP, read_run
from .run_file import Run
from .solids import frame_along, turn_about
from .trajectory import scene_of
from .whole_file import whole_files

EXAMPLE = """examples:
  python -m pbf_tools to-usd out/demo -o demo.usdc
  python -m pbf_tools to-usd out/demo -o half.usdc --every 2 --frames 0:200
  python -m pbf_tools to-usd out/demo -o film.usdc --fps 24   (frames of the film lie between those of
                                                              the run: readers interpolate)"""

ENDINGS = {".usdc": "usdc", ".usd": "usdc", ".usda": "usda"}
FPS = 24.0  # of a single frame, which has no interval
SAVED_BYTES = 1 << 26  # of particles in memory before they go to the file
# Fields that USD has an attribute for.
NAMED = ("position", "velocity", "id")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("run_file", metavar="RUN", help=RUN_HELP)
    parser.add_argument("-o", "--out", required=True, metavar="FILE",
                        help="file to write: .usdc or .usd (binary), .usda (text, large)")
    parser.add_argument("--frames", default="all", help=frame_range.HELP + " (default %(default)s)")
    parser.add_argument("--every", type=int, default=1, metavar="N", help="take each N-th of these")
    parser.add_argument("--fps", type=float, metavar="F",
                        help="time codes per second (default: so that every frame of the run is at a "
                             "whole number)")
    parser.add_argument("--no-obstacles", action="store_true", help="the fluid alone")


def usd() -> SimpleNamespace:
    """The modules of usd-core; MissingPackage without it."""
    try:
        from pxr import Gf, Sdf, Tf, Usd, UsdGeom, Vt
    except ImportError:
        raise MissingPackage("USD files need usd-core: pip install usd-core") from None
    return SimpleNamespace(Gf=Gf, Sdf=Sdf, Tf=Tf, Usd=Usd, UsdGeom=UsdGeom, Vt=Vt)


def codes_per_second(times: np.ndarray, fps: float | None) -> float:
    """Time codes in a second: those asked for, else one for each of these times (s).

    >>> codes_per_second(np.array([0, 0.02, 0.04]), None), codes_per_second(np.array([0.5]), None)
    (50.0, 24.0)
    """
    if fps is not None:
        return fps
    return float(f"{1 / np.median(np.diff(times)):.9g}") if len(times) > 1 else FPS


def code_of(time: float, fps: float) -> float:
    """Time code of a time (s); whole numbers are exact.

    >>> code_of(0.06, 50), code_of(1 / 3, 24), code_of(0.01, 24)
    (3.0, 8.0, 0.24)
    """
    return round(float(time) * fps, 6)


def run(args: argparse.Namespace) -> int:
    out = Path(args.out)
    if out.suffix not in ENDINGS:
        raise BadInput(f"{out}: the ending must be one of {' '.join(ENDINGS)}")
    if args.every < 1 or args.fps is not None and not 0 < args.fps <= 1e6:
        raise BadInput("--every goes from 1, --fps from above 0 to 1e6")
    modules = usd()
    r = read_run(args.run_file)
    numbers = frame_range.parse(args.frames, len(r.times))[::args.every]
    if "velocity" not in r.fields:
        note(f"{r.path}: no velocities in its frames (output.fields), so no motion blur from them")
    with whole_files([out]) as (unfinished,):
        try:
            fps = _write(modules, r, numbers, args, unfinished, ENDINGS[out.suffix])
        except modules.Tf.ErrorException as problem:
            why = " ".join(problem.args[0].commentary.split())
            raise FileError(f"{out}: cannot write it: {why}") from None
    print(f"wrote {out}: {len(numbers)} frames at {fps:g} time codes per second, "
          f"{out.stat().st_size / 1e6:.3g} MB")
    return 0


def _write(m: SimpleNamespace, r: Run, numbers: list[int], args: argparse.Namespace, path: Path,
           kind: str) -> float:
    """Writes the file; returns its time codes per second."""
    times = r.times[numbers]
    fps = codes_per_second(times, args.fps)
    codes = [code_of(t, fps) for t in times]
    layer = m.Sdf.Layer.New(m.Sdf.FileFormat.FindById(kind), str(path))
    stage = m.Usd.Stage.Open(layer)
    m.UsdGeom.SetStageUpAxis(stage, m.UsdGeom.Tokens.z)
    m.UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    stage.SetTimeCodesPerSecond(fps)
    stage.SetFramesPerSecond(fps)
    stage.SetStartTimeCode(codes[0])
    stage.SetEndTimeCode(codes[-1])
    layer.documentation = f"{r.title}; pbf {r.info['program_version']}"
    stage.SetDefaultPrim(m.UsdGeom.Xform.Define(stage, "/run").GetPrim())
    if not args.no_obstacles:
        _obstacles(m, stage, r, numbers, codes)
    fluid = Fluid(m, stage, float(r.info["spacing"]))
    held = 0
    for k, code in zip(numbers, codes):
        held += fluid.add({name: r[name][k] for name in r.fields}, code)
        if held > SAVED_BYTES and kind == "usdc":  # a text file is written as a whole
            layer.Save()
            held = 0
    layer.Save()
    return fps


class Fluid:
    """The points of the file. What readers hold until it changes, ids and widths, is written when it
    does."""

    def __init__(self, m: SimpleNamespace, stage: Any, spacing: float):
        self._m, self._spacing = m, spacing
        self._points = m.UsdGeom.Points.Define(stage, "/run/fluid")
        self._points.SetWidthsInterpolation(m.UsdGeom.Tokens.vertex)
        self._ids: np.ndarray | None = None

    def add(self, fields: dict[str, np.ndarray], code: float) -> int:
        """A frame; returns its bytes."""
        vt, points = self._m.Vt, self._points
        x = np.ascontiguousarray(fields["position"], np.float32)
        points.CreatePointsAttr().Set(vt.Vec3fArray.FromNumpy(x), code)
        reach = np.float32(self._spacing / 2)
        corners = np.stack([x.min(0) - reach, x.max(0) + reach]) if len(x) else \
            np.zeros((2, 3), np.float32)
        points.CreateExtentAttr().Set(vt.Vec3fArray.FromNumpy(corners), code)
        if "velocity" in fields:
            v = np.ascontiguousarray(fields["velocity"], np.float32)
            points.CreateVelocitiesAttr().Set(vt.Vec3fArray.FromNumpy(v), code)
        ids = np.ascontiguousarray(fields["id"], np.int64)
        if self._ids is None or len(ids) != len(self._ids):
            # One for each: readers of Houdini take no single width for all.
            widths = np.full(len(ids), self._spacing, np.float32)
            points.CreateWidthsAttr().Set(vt.FloatArray.FromNumpy(widths), code)
        if self._ids is None or not np.array_equal(ids, self._ids):
            points.CreateIdsAttr().Set(vt.Int64Array.FromNumpy(ids), code)
        self._ids = ids
        for name, values in fields.items():
            if name not in NAMED:
                self._primvar(name, np.ascontiguousarray(values, np.float32), code)
        return sum(values.nbytes for values in fields.values())

    def _primvar(self, name: str, values: np.ndarray, code: float) -> None:
        types, vt = self._m.Sdf.ValueTypeNames, self._m.Vt
        kind, array = (types.FloatArray, vt.FloatArray) if values.ndim == 1 else \
            (types.Float3Array, vt.Vec3fArray)
        primvar = self._m.UsdGeom.PrimvarsAPI(self._points).CreatePrimvar(
            self._m.Tf.MakeValidIdentifier(name), kind, self._m.UsdGeom.Tokens.vertex)
        primvar.Set(array.FromNumpy(values), code)


def _obstacles(m: SimpleNamespace, stage: Any, r: Run, numbers: list[int],
               codes: list[float]) -> None:
    """The obstacles of simple shapes, as the shapes that USD has."""
    left_out = []
    for obstacle in scene_of(r).get("obstacles", []):
        name = str(obstacle["name"])
        path = f"/run/obstacles/{m.Tf.MakeValidIdentifier(name)}"
        while stage.GetPrimAtPath(path):  # names that differ in what USD does not take
            path += "_"
        place = _shape(m, stage, path, obstacle)
        if place is None:
            left_out.append(f"{name} ({obstacle['shape']})")
            continue
        turn, middle = place
        transform = m.UsdGeom.Xformable(stage.GetPrimAtPath(path)).MakeMatrixXform()
        if "motion" in obstacle or "free" in obstacle:
            for code, (turned, moved) in zip(codes, _poses(r, name, numbers)):
                transform.Set(_matrix(m, turned @ turn, moved), code)
        else:
            transform.Set(_matrix(m, turn, middle))
    if left_out:
        note(f"{r.path}: left out {', '.join(left_out)}: of obstacles, boxes, spheres, cylinders and "
             "capsules are written")


def _shape(m: SimpleNamespace, stage: Any, path: str,
           obstacle: dict[str, Any]) -> tuple[np.ndarray, np.ndarray] | None:
    """Defines the shape about 0; returns the turn and the middle that the scene gives it, or None
    for a shape that is left out."""
    def numbers(key: str) -> np.ndarray:
        return np.asarray(obstacle[key], float)

    shape, geom = obstacle["shape"], m.UsdGeom
    if shape == "box":
        low, high = numbers("min"), numbers("max")
        turn = turn_about(np.asarray(obstacle.get("turn_axis", [0, 0, 1]), float),
                          float(obstacle.get("turn_angle", 0)))
        geom.Cube.Define(stage, path).CreateSizeAttr(1.0)
        return turn @ np.diag(high - low), (low + high) / 2
    if shape == "sphere":
        geom.Sphere.Define(stage, path).CreateRadiusAttr(float(obstacle["radius"]))
        return np.eye(3), numbers("center")
    if shape in ("cylinder", "capsule"):
        kind = geom.Cylinder if shape == "cylinder" else geom.Capsule
        start, end = numbers("from"), numbers("to")
        solid = kind.Define(stage, path)
        solid.CreateAxisAttr(geom.Tokens.z)
        solid.CreateRadiusAttr(float(obstacle["radius"]))
        solid.CreateHeightAttr(float(np.linalg.norm(end - start)))
        return frame_along(end - start).T, (start + end) / 2
    return None


def _poses(r: Run, name: str, numbers: list[int]) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """The pose of a moving obstacle in each of these frames: turn (3, 3) and middle (3,), m."""
    bodies = r.bodies
    if name in bodies:  # its frames are exact, between rows of the log it is not known
        body = bodies[name]
        return zip(body.turn[numbers], body.middle[numbers])
    return zip(*r.obstacle_pose(name, r.times[numbers]))


def _matrix(m: SimpleNamespace, turn: np.ndarray, middle: np.ndarray) -> Any:
    """p -> middle + turn p; USD multiplies rows from the left."""
    matrix = np.eye(4)
    matrix[:3, :3], matrix[3, :3] = turn.T, middle
    return m.Gf.Matrix4d(matrix.tolist())
