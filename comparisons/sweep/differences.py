"""Errors of displacements u of a model against u_ref of a reference at equal plan points, as fractions:

    error        largest |component of (u − u_ref)| over the probes / largest |component of u_ref| over them
    field_error  the error over points of the whole sheet in place of the probes
    relative     |u − u_ref| / |u_ref| at one probe

They are None if the reference does not move or a number is not finite.
"""

from collections.abc import Iterable

import numpy as np

from comparisons.pictures.plan import plan_mesh
from sheetbench.errors import BadInput
from sheetbench.scenes import Scene

FIELD_CELLS = 16  # cells along the shorter side; the field error is measured at their corners
UNSEEN = 1.5  # ratio of field error and error above which the probes miss too much of the sheet


def field_points(scene: Scene) -> np.ndarray:
    """Return plan points (n, 2) [m] of the whole sheet."""
    return plan_mesh(scene, FIELD_CELLS).points[:, :2]


def unseen(errors: Iterable[tuple[str, float | None, float | None]], bar: float | None = None) -> list[str]:
    """Return a sentence on models whose field error is far above their error at the probes. errors: name,
    error and field error of each model; bar: of the reference, below which errors are ignored."""
    pairs = [(name, e, field) for name, e, field in errors if e is not None and field is not None]
    names = [name for name, e, field in pairs if far(e, field, bar)]
    text = f"the error over the sheet is more than {UNSEEN} times the error at the probes; add [probes] there"
    return [f"{', '.join(names)}: {text}."] if names else []


def far(error: float, field_error: float, bar: float | None = None) -> bool:
    """Return whether a field error is far above the error at the probes (`unseen`)."""
    return field_error > UNSEEN * max(error, bar or 0.0)


def error(displacement: np.ndarray, reference: np.ndarray) -> float | None:
    """Return the largest component of a difference over the largest component of the reference.

    Parameters
    ----------
    displacement : ndarray, (n, 3) [m]
        Displacements at n points.
    reference : ndarray, (n, 3) [m]
        Displacements of a reference at the n points.

    Returns
    -------
    float or None
        Largest component of the difference over the largest component of the reference, None if that is 0.

    Raises
    ------
    BadInput
        Arrays of different shapes.

    Examples
    --------
    >>> import numpy as np
    >>> error(np.array([[0.0, 0.0, 1.25]]), np.array([[0.0, 0.0, 1.0]]))
    0.25
    """
    displacement, reference = np.asarray(displacement), np.asarray(reference)
    if displacement.shape != reference.shape:
        shapes = f"{displacement.shape} against {reference.shape}"
        raise BadInput(f"error: displacements {shapes}; equal shapes are needed")
    return _ratio(float(np.max(np.abs(displacement - reference))), float(np.max(np.abs(reference))))


def relative(displacement: np.ndarray, reference: np.ndarray, least: float = 0.0) -> float | None:
    """Return the relative difference of a displacement (3,) from the reference's (3,), None if the latter is
    at most `least`."""
    size = float(np.linalg.norm(reference))
    return _ratio(float(np.linalg.norm(displacement - reference)), size) if size > least else None


def _ratio(difference: float, size: float) -> float | None:
    ratio = difference / size if size > 0 else np.nan
    return ratio if np.isfinite(ratio) else None
