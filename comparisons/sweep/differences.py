"""The error and the relative difference of displacements, defined in `comparisons.comparison.errors`."""

from __future__ import annotations

import numpy as np

from sheetbench.errors import BadInput


def error(displacement: np.ndarray, reference: np.ndarray) -> float | None:
    """Return the error of displacements (n, 3) against a reference's (n, 3), as the module defines it."""
    displacement, reference = np.asarray(displacement), np.asarray(reference)
    if displacement.shape != reference.shape:
        shapes = f"{displacement.shape} against {reference.shape}"
        raise BadInput(f"error: displacements {shapes}; equal shapes are needed")
    return _ratio(float(np.max(np.abs(displacement - reference))), float(np.max(np.abs(reference))))


def relative(displacement: np.ndarray, reference: np.ndarray, least: float = 0.0) -> float | None:
    """Return the relative difference of a displacement (3,) from the reference's (3,), if that exceeds
    `least`."""
    size = float(np.linalg.norm(reference))
    return _ratio(float(np.linalg.norm(displacement - reference)), size) if size > least else None


def _ratio(difference: float, size: float) -> float | None:
    ratio = difference / size if size > 0 else np.nan
    return ratio if np.isfinite(ratio) else None
