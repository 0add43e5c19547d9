"""The search from several starts, and over growing parts of a motion.

A motion that is out of step by half a period has a minimum of its own. So the first part of the record is
fitted first, in which no phase has gone astray, and what is found there starts the fit of twice as much of
it. Where the fit from the scene's own values leaves more than noise, it is made from STARTS others too,
spread over the unknowns by Halton's sequence, and the best is taken. A start that leads to where another did
in the first part of the record is not followed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import log
from typing import Any

import numpy as np
from scipy.stats.qmc import Halton

from comparisons.identification.fit import Fit, Nearest
from comparisons.identification.measurements import Displacements
from comparisons.identification.model import NotReached, Prediction
from comparisons.models.context import context

STARTS = 6
SPREAD = log(3.0)  # of x about the scene's own value
PARTS = (0.125, 0.25, 0.5)  # of a record, before the whole
FEWEST = 6  # measured numbers per unknown that a part must have
ROUGH: dict[str, Any] = {"smallest": 1e-3, "evaluations": 12, "pull": 1e-2}  # of the search over a part
ENOUGH = 1e-6  # of the search over the whole of a motion, whose slopes are differences
ALIKE = 0.02  # of x: the same minimum
Refusal = Callable[[Fit, Prediction], None]


def nearest(
    fit: Fit, enough: Callable[[Nearest], bool], first: Refusal = Fit.require_same_way
) -> tuple[Nearest, int]:
    """Return the best of the searches, and from how many starts it was made; enough: whether one needs no
    other.

    first: called with the fit, or that of the first part, and what is predicted of the scene's own values,
    to refuse it. Raises NotReached where the model has no answer with them, of a motion with no start.
    """
    reached: list[np.ndarray] = []
    low, high = np.array([u.bounds() for u in fit.unknowns]).T
    spread = np.minimum(SPREAD, 0.5 * (high - low))
    points = 2.0 * Halton(len(low), scramble=False).random(STARTS + 1)[1:] - 1.0
    best, failure = None, NotReached()
    for made, point in enumerate([np.zeros(len(low)), *points], 1):
        if made > 1:
            context().progress(f"not noise yet: start {made} of {STARTS + 1}")
        try:
            found = _from(fit, np.clip(spread * point, low, high), reached, first if made == 1 else None)
        except NotReached as error:
            if made == 1 and not reached:
                raise
            failure = error if made == 1 else failure
            continue
        if found is not None and (best is None or found.noise < best.noise):
            best = found
            if enough(best):
                return best, made
    if best is None:
        raise failure
    return best, STARTS + 1


def _from(fit: Fit, start: np.ndarray, reached: list[np.ndarray], first: Refusal | None) -> Nearest | None:
    """Return the search from a start, over growing parts of a motion; None where it joins one that was made.
    reached: x after the first part of the searches so far, to which this one's is added."""
    parts = _parts(fit)
    for number, part in enumerate((*parts, fit)):
        rough = ROUGH if part is not fit else {"smallest": ENOUGH} if parts else {}
        found = part.search(start, first if number == 0 else None, **rough)
        start = found.x
        if parts and number == 0:
            if any(np.abs(start - x).max() < ALIKE for x in reached):
                return None
            reached.append(start)
    return found


def _parts(fit: Fit) -> list[Fit]:
    """Return the fits of parts of a motion that are made before the whole."""
    measured = fit.measured
    if not isinstance(measured, Displacements) or measured.time is None:
        return []
    parts = [measured.until(share * float(measured.time.max())) for share in PARTS]
    enough = FEWEST * len(fit.unknowns)
    return [replace(fit, measured=part) for part in parts if part.measured.sum() >= enough]
