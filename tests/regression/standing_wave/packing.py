#!/usr/bin/env python3
"""Computes how the density sum depends on the packing of particles: volume and stiffness.

Every packing is scaled to density 1 with the program's calibration. The columns are its volume per
particle over that of the rest lattice, its stiffness chi = -d rho/d ln V, and the factor 1 + b/chi
on the square of a standing wave's frequency. b is the increase of rho by b e^2 under the pure shear
diag(e, -e) at constant volume (mean, minimum and maximum over directions; 40 random ones in three
dimensions). README.md explains the theory.

    tests/regression/standing_wave/packing.py > packing.csv
"""

import numpy as np

RATIOS = [1, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.7, 1.8, 1.9, 2, 2.1, 2.2, 2.3, 2.4, 2.5, 2.6, 2.7, 2.8,
          2.9, 3, 3.1, 3.2, 3.3, 3.4, 3.5, 3.6, 3.7, 3.8, 3.9, 4, 5]


def kernel(kernels, dimensions):
    """W of kernels/README.md (1) to (3), from its definition; q = r/h."""
    if kernels == "paper":
        norm = 4 / np.pi if dimensions == 2 else 315 / (64 * np.pi)
        return lambda q: norm * np.maximum(1 - q * q, 0) ** 3
    norm = (10 if dimensions == 2 else 15) / np.pi
    return lambda q: norm * np.maximum(1 - q, 0) ** 3


def lattice(cell, places, reach=7):
    """Points around a particle at 0, one per unit of volume. places: in units of the cell."""
    cell = np.array(cell, float)
    n = len(cell)
    steps = np.stack(np.meshgrid(*[np.arange(-reach, reach + 1)] * n, indexing="ij"), -1)
    points = np.concatenate([steps.reshape(-1, n) @ cell + np.array(p) @ cell for p in places])
    return points / (abs(np.linalg.det(cell)) / len(places)) ** (1 / n)


def rest_lattice(dimensions):
    return lattice(np.eye(dimensions), [[0] * dimensions])


def packings(dimensions):
    root = np.sqrt(3)
    if dimensions == 2:
        return {"square": rest_lattice(2),
                "triangular": lattice([[1, 0], [0.5, root / 2]], [[0, 0]])}
    cube = np.eye(3)
    hexagonal = [[1, 0, 0], [0.5, root / 2, 0], [0, 0, np.sqrt(8 / 3)]]
    return {"cubic": rest_lattice(3),
            "bcc": lattice(cube, [[0, 0, 0], [0.5, 0.5, 0.5]]),
            "fcc": lattice(cube, [[0, 0, 0], [0.5, 0.5, 0], [0.5, 0, 0.5], [0, 0.5, 0.5]]),
            "hcp": lattice(hexagonal, [[0, 0, 0], [1 / 3, 1 / 3, 0.5]])}


def weight(kernels, dimensions, ratio):
    """Weight of one particle: the rest lattice has density 1."""
    w = kernel(kernels, dimensions)
    return 1 / w(np.linalg.norm(rest_lattice(dimensions), axis=1) / ratio).sum()


def frames(dimensions, number=40):
    """Orthogonal directions, spread evenly (2-D) or at random."""
    if dimensions == 2:
        for a in np.pi * np.arange(16) / 16:
            yield np.array([[np.cos(a), -np.sin(a)], [np.sin(a), np.cos(a)]])
        return
    random = np.random.default_rng(1)
    for _ in range(number):
        yield np.linalg.qr(random.normal(size=(3, 3)))[0]


def measure(points, kernels, dimensions, ratio):
    """Volume per particle, chi, and the factor on the frequency squared: mean, least, most."""
    w, vol = kernel(kernels, dimensions), weight(kernels, dimensions, ratio)

    def density(scale, strain=None):
        x = points * scale if strain is None else points * scale @ strain.T
        return vol * w(np.linalg.norm(x, axis=1) / ratio).sum()

    low, high = 0.5, 1.6
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if density(middle) > 1 else (low, middle)
    e = 1e-4
    chi = (density(low * (1 - e) ** (1 / dimensions)) -
           density(low * (1 + e) ** (1 / dimensions))) / (2 * e)
    e, b = 3e-3, []
    for q in frames(dimensions):
        strain = [q @ np.diag([np.exp(s), np.exp(-s)] + [1] * (dimensions - 2)) @ q.T
                  for s in (e, -e)]
        b.append((sum(density(low, s) for s in strain) - 2 * density(low)) / (2 * e * e))
    return low ** dimensions, chi, *(1 + f(b) / chi if chi > 1e-3 else np.nan
                                     for f in (np.mean, np.min, np.max))


def main():
    print("dimensions,kernels,smoothing_ratio,packing,volume,chi,factor,factor_min,factor_max")
    for dimensions in (2, 3):
        for kernels in ("consistent", "paper"):
            for ratio in RATIOS:
                for name, points in packings(dimensions).items():
                    row = measure(points, kernels, dimensions, ratio)
                    print(f"{dimensions},{kernels},{ratio},{name}," +
                          ",".join(f"{x:.4f}" for x in row))


if __name__ == "__main__":
    main()
