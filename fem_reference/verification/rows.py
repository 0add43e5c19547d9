"""What a verification case yields: rows of a published value beside the computed one.

relative is |computed − published| / |published|, or over the case's length scale where the published value
is 0, and None where neither has a meaning (orders, residuals, manufactured errors): there the
difference itself is held to the tolerance.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Row:
    """One published value: the mesh it was computed on, and the tolerance it is held to."""

    case: str
    quantity: str
    mesh: str
    published: float
    computed: float
    relative: float | None
    tolerance: float
    passed: bool


@dataclass(frozen=True)
class Case:
    """A benchmark: where it is published, and its rows, computed when they are asked for.

    quick: seconds, not tens of seconds.
    """

    title: str
    source: str
    rows: Callable[[str], Iterator[Row]]
    quick: bool = True


def relatively(
    case: str,
    quantity: str,
    mesh: str,
    published: float,
    computed: float,
    tolerance: float,
    scale: float | None = None,
) -> Row:
    """A row held to a relative difference, of `scale` where it is given and else of the published value."""
    relative = abs(computed - published) / abs(published if scale is None else scale)
    passed = bool(relative <= tolerance)
    return Row(case, quantity, mesh, float(published), float(computed), float(relative), tolerance, passed)


def absolutely(
    case: str, quantity: str, mesh: str, published: float, computed: float, tolerance: float
) -> Row:
    """A row held to a difference of its own kind."""
    passed = bool(abs(computed - published) <= tolerance)
    return Row(case, quantity, mesh, float(published), float(computed), None, tolerance, passed)


def mesh_change(case: str, mesh: str, coarse: np.ndarray, fine: np.ndarray, tolerance: float) -> Row:
    """The largest relative change of the answers from half the mesh: the case's own convergence."""
    change = np.max(np.abs(np.asarray(fine) - coarse)) / np.max(np.abs(fine))
    return absolutely(case, "change from half the mesh", mesh, 0.0, change, tolerance)
