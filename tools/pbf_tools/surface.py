"""The surface of the fluid as triangles, a .ply file per frame (needs pysplashsurf).

Marching cubes over the SPH colour field, then smoothing that keeps the volume (Loeschner,
Boettcher, Jeske & Bender 2023). The files open in ParaView, Blender, MeshLab, PyVista.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from . import frame_range
from .errors import BadInput, FileError, MissingPackage
from .logs import RUN_HELP, read_run

EXAMPLE = """example:
  python -m pbf_tools surface out/demo --frames 0:-1:5 --out surface"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("run_file", metavar="RUN", help=RUN_HELP)
    parser.add_argument("--frames", default="-1", help=frame_range.HELP + " (default %(default)s)")
    parser.add_argument("-o", "--out", default="surface", metavar="FOLDER",
                        help="folder of the .ply files (default %(default)s)")
    parser.add_argument("--cube", type=float, default=0.5, metavar="D",
                        help="edge of the marching cubes, in spacings (default %(default)s)")
    parser.add_argument("--smoothing", type=int, default=25, metavar="N",
                        help="rounds of smoothing; 0: none (default %(default)s)")


def reconstruct(x: np.ndarray, spacing: float, cube: float, smoothing: int
                ) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (V, 3) in m and triangles (T, 3) of the surface around particles x (N, 3), m."""
    try:
        import pysplashsurf
    except ImportError:
        raise MissingPackage("surfaces need pysplashsurf: pip install pysplashsurf") from None
    # Its smoothing length and cubes are in units of the particle radius, here half a spacing.
    mesh, _ = pysplashsurf.reconstruction_pipeline(
        np.ascontiguousarray(x), particle_radius=spacing / 2, smoothing_length=2.0,
        cube_size=2 * cube, iso_surface_threshold=0.6, mesh_smoothing_iters=smoothing or None,
        mesh_smoothing_weights=smoothing > 0, mesh_cleanup=smoothing > 0)
    return np.asarray(mesh.mesh.vertices), np.asarray(mesh.mesh.triangles)


def write_ply(path: Path, vertices: np.ndarray, triangles: np.ndarray) -> None:
    """A binary PLY file with float32 vertices."""
    header = ("ply\nformat binary_little_endian 1.0\ncomment metres\n"
              f"element vertex {len(vertices)}\n"
              "property float x\nproperty float y\nproperty float z\n"
              f"element face {len(triangles)}\n"
              "property list uchar int vertex_indices\nend_header\n")
    faces = np.empty(len(triangles), dtype=[("n", "u1"), ("v", "<i4", 3)])
    faces["n"], faces["v"] = 3, triangles
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(header.encode() + vertices.astype("<f4").tobytes() + faces.tobytes())
    except OSError as problem:
        raise FileError(f"{path}: cannot write the surface: {problem.strerror}") from None


def run(args: argparse.Namespace) -> int:
    if not 0.05 <= args.cube <= 4 or args.smoothing < 0:
        raise BadInput("--cube goes from 0.05 to 4 spacings, --smoothing from 0")
    r = read_run(args.run_file)
    for k in frame_range.parse(args.frames, len(r.frames)):
        if not r.counts[k]:
            raise BadInput(f"{r.path}: frame {k} has no particles, so no surface; choose others "
                           "with --frames")
        vertices, triangles = reconstruct(r["position"][k], float(r.info["spacing"]), args.cube,
                                          args.smoothing)
        path = Path(args.out) / f"surface_{k:05d}.ply"
        write_ply(path, vertices, triangles)
        print(f"wrote {path}: t = {r.times[k]:g} s, {len(triangles)} triangles", flush=True)
    return 0
