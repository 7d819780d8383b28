"""Particles on a cubic lattice inside a picture or a closed mesh."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from .errors import BadInput, FileError, MissingPackage
from .lattice import lattice


def fill_image(path: str, width: float, depth: float, spacing: float, threshold: float,
               invert: bool) -> np.ndarray:
    """Positions (N, 3), m: the picture `width` wide along x, its top up along z, `depth` along y.

    A lattice point is fluid when the pixel that it falls on is darker than `threshold` (0..1) over
    a white background; brighter with `invert`.
    """
    dark = image_brightness(path) < threshold
    if invert:
        dark = ~dark
    rows, columns = dark.shape
    height = width * rows / columns
    x = (np.arange(max(1, round(width / spacing))) + 0.5) * spacing
    z = (np.arange(max(1, round(height / spacing))) + 0.5) * spacing
    y = (np.arange(max(1, round(depth / spacing))) + 0.5) * spacing
    column = np.clip((x / width * columns).astype(int), 0, columns - 1)
    row = np.clip(((1 - z / height) * rows).astype(int), 0, rows - 1)
    inside = dark[row[:, None], column[None, :]]  # (z, x)
    iz, ix = np.nonzero(inside)
    if not len(ix):
        raise BadInput(f"{path}: no pixel is fluid; change --threshold (or --invert)")
    n = len(y)
    return np.column_stack([np.repeat(x[ix], n), np.tile(y, len(ix)), np.repeat(z[iz], n)])


def image_brightness(path: str) -> np.ndarray:
    """Brightness 0..1 of every pixel, shape (rows, columns), over white where it is transparent."""
    import matplotlib.image

    if not Path(path).is_file():
        raise FileError(f"{path}: no such picture")
    try:
        pixels = matplotlib.image.imread(path)
    except (OSError, SyntaxError, ValueError) as problem:
        raise FileError(f"{path}: cannot read the picture: {problem}") from None
    if pixels.dtype.kind in "iu":
        pixels = pixels / np.iinfo(pixels.dtype).max
    pixels = np.asarray(pixels, float)
    if pixels.ndim == 2:
        return pixels
    gray, has_alpha = pixels.shape[2] < 3, pixels.shape[2] in (2, 4)
    bright = pixels[..., 0] if gray else pixels[..., :3] @ [0.299, 0.587, 0.114]
    alpha = pixels[..., -1] if has_alpha else np.ones(bright.shape)
    return bright * alpha + (1 - alpha)


def fill_mesh(path: str, width: float, spacing: float) -> np.ndarray:
    """Positions (N, 3), m, inside a closed mesh scaled to `width` along x."""
    try:
        import pyvista
    except ImportError:
        raise MissingPackage("meshes need PyVista: pip install pyvista") from None
    if not Path(path).is_file():
        raise FileError(f"{path}: no such mesh")
    try:
        mesh = pyvista.read(path)
    except Exception as problem:  # the readers of VTK raise what they like
        raise FileError(f"{path}: cannot read the mesh: {problem}") from None
    if not isinstance(mesh, pyvista.PolyData):
        raise BadInput(f"{path}: holds {type(mesh).__name__}, not a surface")
    mesh = mesh.triangulate().clean()
    if mesh.n_points == 0 or mesh.n_open_edges > 0:
        raise BadInput(f"{path}: the mesh is empty or has holes ({mesh.n_open_edges} open edges); "
                       "inside is not defined")
    mesh.points = np.asarray(mesh.points, float)
    low, high = np.array(mesh.bounds[0::2]), np.array(mesh.bounds[1::2])
    if high[0] <= low[0]:
        raise BadInput(f"{path}: the mesh has no width along x")
    mesh.points = (mesh.points - low) * (width / (high[0] - low[0]))
    size = (high - low) * (width / (high[0] - low[0]))
    axes = [(np.arange(max(1, round(s / spacing))) + 0.5) * spacing for s in size]
    points = lattice(axes)
    # Signed distance: negative inside.
    distance = pyvista.PolyData(points).compute_implicit_distance(mesh)["implicit_distance"]
    inside = points[np.asarray(distance) < 0]
    if not len(inside):
        raise BadInput(f"{path}: no particle fits inside; make --spacing smaller")
    return inside
