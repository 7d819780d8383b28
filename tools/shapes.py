#!/usr/bin/env python3
"""Writes the files of obstacles in configs/ again.

wigley_hull.stl (m, binary): Wigley's hull, half breadth B/2 (1 - (2x/L)^2) (1 - (z/T)^2) below the
water line z = 0 (W. C. S. Wigley, "Calculated and measured wave resistance of a series of forms
defined algebraically", Trans. INA 84, 1942), with vertical sides above it, and a deck. L = 1.2 m,
B = 0.3 m, T = 0.12 m, 0.1 m of freeboard.
bay.csv (x,y,z in m): a shore that rises, with an island before it.
stiff/cup.obj (m): a cup, 0.45 m wide and 0.4 m high, walls and floor 0.025 m thick.
extreme/slivers.obj: a cube of edge 1 whose faces are needles, a thousandth wide and less.
extreme/rough.csv: a bed of stones, up to 0.06 m high.
Example: tools/shapes.py configs
"""
import struct
import sys
from pathlib import Path

import numpy as np

LENGTH, BREADTH, DRAFT, FREEBOARD = 1.2, 0.3, 0.12, 0.1


def half_breadth(x, z):
    below = 1 - (np.minimum(z, 0) / DRAFT) ** 2
    return BREADTH / 2 * (1 - (2 * x / LENGTH) ** 2) * below


def hull_triangles(stations=40, lines=8):
    x = LENGTH / 2 * np.sin(np.linspace(-np.pi / 2, np.pi / 2, stations + 1))
    x[0], x[-1] = -LENGTH / 2, LENGTH / 2
    z = np.concatenate([DRAFT * (np.linspace(0, 1, lines + 1) ** 0.7 - 1), [FREEBOARD]])
    z[lines] = 0
    y = half_breadth(x[:, None], z[None, :])
    y[0] = y[-1] = 0
    y[:, 0] = 0

    def place(side, i, k):
        return (x[i], side * y[i, k], z[k])

    corners = []
    for i in range(stations):
        for k in range(len(z) - 1):
            for side in (-1, 1):
                a, b, c, d = (place(side, i, k), place(side, i + 1, k), place(side, i + 1, k + 1),
                              place(side, i, k + 1))
                corners += [(a, b, c), (a, c, d)] if side < 0 else [(a, c, b), (a, d, c)]
        top = len(z) - 1  # the deck
        a, b, c, d = place(-1, i, top), place(-1, i + 1, top), place(1, i + 1, top), place(1, i, top)
        corners += [(a, b, c), (a, c, d)]
    triangles = np.array(corners, dtype="<f4")
    # Where both sides meet, their triangles would lie on each other.
    whole = [len({tuple(p) for p in t}) == 3 and any(p[1] for p in t) for t in triangles.tolist()]
    return triangles[whole]


def write_stl(path, triangles):
    with open(path, "wb") as file:
        file.write(b"Wigley's hull, m".ljust(80) + struct.pack("<I", len(triangles)))
        for t in triangles:
            n = np.cross(t[1] - t[0], t[2] - t[0])
            n = n / max(np.linalg.norm(n), 1e-30)
            file.write(struct.pack("<12fH", *n, *t.reshape(-1), 0))


def write_bay(path, nx=61, ny=31):
    with open(path, "w", encoding="utf-8") as file:
        file.write("x,y,z\n")
        for v in np.linspace(0, 1.5, ny):
            for u in np.linspace(0, 3, nx):
                shore = 0.24 * max(0.0, u - 1.2) / 1.8 * (1 + 0.25 * np.cos(np.pi * v / 1.5))
                island = 0.3 * np.exp(-((u - 1.5) ** 2 + (v - 0.65) ** 2) / 0.2**2)
                file.write(f"{u:.3f},{v:.3f},{0.02 + shore + island:.4f}\n")


def write_obj(path, corners):
    """corners: of triangles, (N, 3, 3)."""
    known, faces = {}, []
    for t in corners:
        faces.append([known.setdefault(tuple(p), len(known) + 1) for p in t])
    with open(path, "w", encoding="utf-8") as file:
        for p in known:
            file.write("v {:.6g} {:.6g} {:.6g}\n".format(*p))
        for f in faces:
            file.write("f {} {} {}\n".format(*f))


def turned_profile(profile, around):
    """The surface of a profile of (radius, height) about z, from the axis to the axis."""
    angle = 2 * np.pi * np.arange(around) / around

    def place(ring, k):
        k %= around
        return (round(ring[0] * np.cos(angle[k]), 9), round(ring[0] * np.sin(angle[k]), 9), ring[1])

    corners = []
    for low, high in zip(profile[:-1], profile[1:]):
        for k in range(around):
            a, b, c, d = place(low, k), place(low, k + 1), place(high, k + 1), place(high, k)
            if low[0] > 0:
                corners.append((a, b, c))
            if high[0] > 0:
                corners.append((a, c, d))
    return corners


def needles(cuts=12):
    """A cube of edge 1: each side is a fan of needles from one of its corners."""
    parts = [1 - 2.0**-k for k in range(cuts)] + [1]
    corners = []
    for axis in range(3):
        for side in (0, 1):

            def place(u, v, axis=axis, side=side):
                p = [0, 0, 0]
                p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3] = side, u, v
                return tuple(p)

            # All edges are divided alike, so that neighbors fit.
            edge = ([(u, 0) for u in parts[:-1]] + [(1, v) for v in parts[:-1]]
                    + [(u, 1) for u in parts[:0:-1]] + [(0, v) for v in parts[:0:-1]])
            for k, from_ in enumerate(edge):
                to = edge[(k + 1) % len(edge)]
                t = (place(0.999, 0.999), place(*from_), place(*to))
                corners.append(t if side else (t[0], t[2], t[1]))
    return corners


def write_stones(path, n=41):
    random = np.random.default_rng(1)
    x = np.linspace(0, 1.2, n)
    y = np.linspace(0, 0.4, n // 3 + 1)
    z = np.zeros((len(y), n))
    for _ in range(40):
        u, v, size = random.uniform(0, 1.2), random.uniform(0, 0.4), random.uniform(0.03, 0.06)
        far = (x[None, :] - u) ** 2 + (y[:, None] - v) ** 2
        z = np.maximum(z, np.sqrt(np.maximum(size**2 - far, 0)))
    with open(path, "w", encoding="utf-8") as file:
        file.write("x,y,z\n")
        for j, v in enumerate(y):
            for i, u in enumerate(x):
                file.write(f"{u:.4g},{v:.4g},{z[j, i]:.4f}\n")


if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1] in ("-h", "--help"):
        print(__doc__)
        sys.exit(0 if len(sys.argv) == 2 else 2)
    folder = Path(sys.argv[1])
    write_stl(folder / "wigley_hull.stl", hull_triangles())
    write_bay(folder / "bay.csv")
    cup = [(0, 0), (0.225, 0), (0.225, 0.4), (0.2, 0.4), (0.2, 0.025), (0, 0.025)]
    write_obj(folder / "stiff/cup.obj", turned_profile(cup, 64))
    write_obj(folder / "extreme/slivers.obj", needles())
    write_stones(folder / "extreme/rough.csv")
