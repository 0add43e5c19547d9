"""What the numbers of a sample are: parts of a row by kind and name."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

Part = tuple[str, str, tuple[int, ...]]  # kind, name, shape


def width(columns: Sequence[Part]) -> int:
    """How many numbers a row has."""
    return sum(math.prod(shape) for _, _, shape in columns)


def split(columns: Sequence[Part], rows: np.ndarray) -> dict[str, dict[str, np.ndarray]]:
    """Rows (n, width) as kind → name → (n, …)."""
    parts: dict[str, dict[str, np.ndarray]] = {kind: {} for kind, _, _ in columns}
    first = 0
    for kind, name, shape in columns:
        numbers = math.prod(shape)
        parts[kind][name] = rows[:, first : first + numbers].reshape(len(rows), *shape)
        first += numbers
    return parts
