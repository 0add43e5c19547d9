"""The search for the unknowns with which a model comes nearest to what was measured.

Least squares in the unknowns' x by a trust region (SciPy's `least_squares`), with a pull of PULL towards
the scene's own values, x = 0, that holds what the data do not see at all. Where the model has no answer the
residuals are REFUSED, and the step is shortened.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from comparisons.identification.misfit import Misfit
from comparisons.identification.prediction import NotReached, Prediction, Predictor
from comparisons.identification.unknowns import Unknown

REFUSED = 1e3  # residual, in units of the data, where the model has no answer: the step is shortened
SMALLEST = 1e-8  # change of x, or of the sum of squares, that ends the search
PULL = 1e-6  # residual, in units of the data, that a unit of x is worth
EVALUATIONS = 60


@dataclass(frozen=True)
class Nearest:
    """Where a search ended: x (n,); residuals (m,) there, in units of the largest measurement, and their
    slopes (m, n) by x; against_bounds: (n,), -1 or 1 where an unknown ended at its lower or upper bound;
    converged: whether at a minimum."""

    x: np.ndarray
    residuals: np.ndarray
    slopes: np.ndarray
    against_bounds: np.ndarray
    evaluations: int
    converged: bool

    @property
    def noise(self) -> float:
        """The standard deviation of the residuals, in units of the largest measurement."""
        return float(np.sqrt(self.residuals @ self.residuals / max(len(self.residuals) - len(self.x), 1)))


def search(
    predict: Predictor,
    unknowns: Sequence[Unknown],
    misfit: Misfit,
    smallest: float = SMALLEST,
    evaluations: int = EVALUATIONS,
    first: Callable[[Prediction], None] = lambda predicted: None,
    start: np.ndarray | None = None,
    pull: float = PULL,
    progress: Callable[[str], None] = lambda what: None,
) -> Nearest:
    """Return the unknowns' x with which a predictor comes nearest to the measurements of the misfit.

    smallest: change of x, or of the sum of squares, that ends the search, as do so many evaluations; first:
    called with what is predicted at the start, to refuse it; start: x to begin at, the scene's own values
    unless given; pull: towards those. Raises NotReached where the model has no answer at the start.
    """
    kept: dict[bytes, tuple[np.ndarray, np.ndarray]] = {}

    def at(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        key = x.tobytes()
        if key not in kept:
            predicted = predict(unknowns, x, misfit.requested)
            if not kept:
                first(predicted)
            kept[key] = misfit.of(predicted)
            size = float(np.sqrt(np.mean(kept[key][0] ** 2)))
            values = ", ".join(f"{u.name} = {u.value(z):.6g}" for u, z in zip(unknowns, x, strict=True))
            progress(f"{values}: off by {100 * size:.3g} % of the largest measurement")
        return kept[key]

    def residuals(x: np.ndarray) -> np.ndarray:
        try:
            return np.concatenate([at(x)[0], pull * x])
        except NotReached as error:
            progress(f"no answer there: {error}")
            return np.concatenate([np.full(count, REFUSED), pull * x])

    low, high = np.array([u.bounds() for u in unknowns]).T
    start = np.zeros(len(unknowns)) if start is None else np.clip(start, low, high)
    count = len(at(start)[0])
    best = least_squares(
        residuals,
        start,
        jac=lambda x: np.vstack([at(x)[1], pull * np.eye(len(x))]),
        bounds=(low, high),
        xtol=smallest,
        ftol=smallest,
        gtol=1e-12,
        max_nfev=evaluations,
    )
    return Nearest(best.x, *at(best.x), best.active_mask, len(kept), best.status > 0)
