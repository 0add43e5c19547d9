"""The search from several starts, and over growing parts of a motion.

A motion that is out of step by half a period has a minimum of its own. So the first part of the record is
fitted first, in which no phase has gone astray, and what is found there starts the fit of twice as much of
it. Where the fit from the scene's own values leaves more than noise, it is made from STARTS others too,
spread over the unknowns by Halton's sequence, and the best is taken. A start that leads to where another did
in the first part of the record is not followed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from math import log
from typing import Any

import numpy as np
from scipy.stats.qmc import Halton

from comparisons.identification.measurements import Displacements, Measured
from comparisons.identification.misfit import Misfit
from comparisons.identification.prediction import NotReached, Prediction, Predictor
from comparisons.identification.search import EVALUATIONS, PULL, SMALLEST, Nearest, search
from comparisons.identification.unknowns import Unknown

STARTS = 6
SPREAD = log(3.0)  # of x about the scene's own value
PARTS = (0.125, 0.25, 0.5)  # of a record, before the whole
FEWEST = 6  # measured numbers per unknown that a part must have
ROUGH, ROUGH_EVALUATIONS, ROUGH_PULL = 1e-3, 12, 1e-2  # of the search over a part
ENOUGH = 1e-6  # of the search over the whole of a motion, whose slopes are differences
ALIKE = 0.02  # of x: the same minimum


@dataclass(frozen=True)
class Fit:
    """What is fitted: unknowns of a model to measurements.

    axes: the plan grid on which the model gives its whole surface; predictor: of the model at the rows of
    some measurements; offset [m]: as of `Misfit`.
    """

    measured: Measured
    unknowns: tuple[Unknown, ...]
    axes: tuple[np.ndarray, np.ndarray]
    predictor: Callable[[Measured], Predictor]
    offset: float = 0.0
    progress: Callable[[str], None] = lambda what: None

    def misfit(self, measured: Measured | None = None) -> Misfit:
        """Of some of the measurements, all unless given."""
        return Misfit(measured or self.measured, self.axes, self.offset)

    def search(
        self,
        start: np.ndarray | None = None,
        measured: Measured | None = None,
        first: Callable[[Prediction], None] = lambda predicted: None,
        smallest: float = SMALLEST,
        evaluations: int = EVALUATIONS,
        pull: float = PULL,
    ) -> Nearest:
        """One search, as `comparisons.identification.search`."""
        predict, misfit = self.predictor(measured or self.measured), self.misfit(measured)
        return search(
            predict, self.unknowns, misfit, smallest, evaluations, first, start, pull, self.progress
        )

    def residuals(self, x: np.ndarray) -> np.ndarray:
        """Of all measurements at x, in their shape [m]."""
        misfit = self.misfit()
        values, _ = misfit.of(self.predictor(self.measured)(self.unknowns, x, misfit.requested))
        return misfit.per_point(values)


def nearest(
    fit: Fit, first: Callable[[Measured, Prediction], None], enough: Callable[[Nearest], bool]
) -> tuple[Nearest, int]:
    """Return the best of the searches, and from how many starts it was made; enough: whether one needs no
    other.

    first: called with what was measured, or the first part of it, and what is predicted there of the scene's
    own values, to refuse it. Raises NotReached where the model has no answer with them, of a motion with no
    start.
    """
    reached: list[np.ndarray] = []
    best, failure = None, NotReached()
    try:
        best = _from(fit, np.zeros(len(fit.unknowns)), reached, first)
    except NotReached as error:
        if not reached:
            raise
        failure = error
    if best is not None and enough(best):
        return best, 1
    low, high = np.array([u.bounds() for u in fit.unknowns]).T
    spread = np.minimum(SPREAD, 0.5 * (high - low))
    points = 2.0 * Halton(len(low), scramble=False).random(STARTS + 1)[1:] - 1.0
    for number, point in enumerate(points, 2):
        fit.progress(f"not noise yet: start {number} of {STARTS + 1}")
        try:
            other = _from(fit, np.clip(spread * point, low, high), reached)
        except NotReached:
            continue
        if other is not None and (best is None or other.noise < best.noise):
            best = other
            if enough(best):
                return best, number
    if best is None:
        raise failure
    return best, STARTS + 1


def _from(
    fit: Fit,
    start: np.ndarray,
    reached: list[np.ndarray],
    first: Callable[[Measured, Prediction], None] = lambda measured, predicted: None,
) -> Nearest | None:
    """Return the search from a start, over growing parts of a motion; None where it joins one that was made.
    reached: x after the first part of the searches so far, to which this one's is added."""
    parts = _parts(fit)
    for number, part in enumerate(parts):
        assert part.time is not None
        fit.progress(f"the first {part.time.max():.3g} s of the motion")
        rough: dict[str, Any] = {"smallest": ROUGH, "evaluations": ROUGH_EVALUATIONS, "pull": ROUGH_PULL}
        found = fit.search(start, part, partial(first, part) if number == 0 else _anything, **rough)
        start = found.x
        if number == 0:
            if any(np.abs(start - x).max() < ALIKE for x in reached):
                return None
            reached.append(start)
    if parts:
        return fit.search(start, smallest=ENOUGH)
    return fit.search(start, first=partial(first, fit.measured))


def _anything(predicted: Prediction) -> None:
    """Refuse nothing."""


def _parts(fit: Fit) -> list[Displacements]:
    """Return the parts of a motion that are fitted before the whole."""
    measured = fit.measured
    if not isinstance(measured, Displacements) or measured.time is None:
        return []
    parts = [measured.until(share * float(measured.time.max())) for share in PARTS]
    return [part for part in parts if part.measured.sum() >= FEWEST * len(fit.unknowns)]
