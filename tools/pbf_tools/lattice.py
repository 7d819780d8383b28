"""Points of a lattice."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np


def lattice(lines: Sequence[np.ndarray]) -> np.ndarray:
    """All combinations of a value of each line, (N, lines), the last line fastest.

    >>> lattice([np.array([0, 1]), np.array([5, 6])]).tolist()
    [[0, 5], [0, 6], [1, 5], [1, 6]]
    """
    return np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1).reshape(-1, len(lines))
