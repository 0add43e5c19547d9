"""Residuals of a model against measurements, and the search for the unknowns that minimise them.

Residuals are shares of the largest measurement: u_model − u_measured at every measured component, or the
distances of a cloud's points from the model's surface, along its normals
(`comparisons.identification.surface`), weighted by the inverse of standard deviations that are given. The
search is least squares in the unknowns' x by a trust region (SciPy's `least_squares`), with a pull of PULL
towards the scene's own values, x = 0, which fixes combinations of x without influence on the data. Residuals
are REFUSED at an x without an equilibrium, which shortens the step.

A motion that is out of step by half a period has a minimum of its own. So the first part of the record, short
enough for all phases to be right, is fitted first, and its x starts the fit of twice as much of the record.
If the fit from the scene's own values leaves more than noise, STARTS further starts are tried, spread over
the unknowns by Halton's sequence, and the best fit is kept. A start that reaches the x of an earlier start in
the first part of the record is dropped.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import log
from typing import Any, Self

import numpy as np
from scipy.optimize import least_squares
from scipy.stats.qmc import Halton

from comparisons.identification import surface
from comparisons.identification.measurements import (
    Displacements,
    Measured,
    Surface,
    typical_deviation,
    weights,
)
from comparisons.identification.model import Model, NoAnswer, Prediction
from comparisons.identification.unknowns import Unknown
from comparisons.models.context import context
from sheetbench.answers.table import number
from sheetbench.errors import BadInput

OPPOSITE = -0.5  # correlation with the model's displacement below which the measured one is turned round
TELLING = 0.1  # of the largest measurement: what a component must reach for its sign to say something
REFUSED = 1e3  # residual, in units of the data, where the model has no answer: the step is shortened
SMALLEST = 1e-8  # change of x, or of the sum of squares, that ends the search
PULL = 1e-6  # residual, in units of the data, that a unit of x is worth
EVALUATIONS = 60


@dataclass(frozen=True)
class Minimum:
    """End of a search: x (n,); weighted residuals (m,) there, in units of the largest measurement, and their
    slopes (m, n) by x; against_bounds: (n,), -1 or 1 for an unknown at its lower or upper bound; converged:
    whether the search ended at a minimum."""

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


@dataclass(frozen=True)
class Fit:
    """Unknowns of a model, and measurements to fit; offset [m]: distance of a cloud from the mid-surface."""

    measured: Measured
    unknowns: tuple[Unknown, ...]
    model: Model
    offset: float = 0.0

    def residuals(self, predicted: Prediction) -> tuple[np.ndarray, np.ndarray]:
        """Return weighted residuals (m,) and their slopes (m, n) by the unknowns' x."""
        measured, scale, axes = self.measured, self.measured.scale, self.model.axes
        if isinstance(measured, Displacements):
            mask = measured.measured
            slopes = [slope[mask] for slope in predicted.slopes]
            residuals = (predicted.displacement - measured.displacement)[mask]
        else:
            feet = surface.feet(axes, surface.Field(axes, predicted.displacement), measured.points)
            slopes = [
                np.einsum("nc,nc->n", feet.normals, surface.Field(axes, slope).at(feet.points))
                for slope in predicted.slopes
            ]
            residuals = self.offset - feet.distances
        factor = self.weights / scale
        return factor * residuals, factor[:, None] * np.stack(slopes, axis=1)

    @property
    def weights(self) -> np.ndarray:
        """Weights of the residuals (m,)."""
        of_rows = weights(self.measured)
        if isinstance(self.measured, Surface):
            return of_rows
        return np.broadcast_to(of_rows[:, None], self.measured.displacement.shape)[self.measured.measured]

    @property
    def deviation(self) -> float:
        """Standard deviation of weighted residuals from the measurements' deviation, 0 if unknown."""
        return typical_deviation(self.measured) / self.measured.scale

    def predict(self, x: np.ndarray) -> Prediction:
        """Return the model's displacements at measured points. Raises NoAnswer without an equilibrium."""
        measured, axes = self.measured, self.model.axes
        points = surface.plan_points(axes) if isinstance(measured, Surface) else measured.points
        return self.model.predict(self.unknowns, x, points, measured.time)

    def at(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return residuals and slopes at x. Raises NoAnswer without an equilibrium."""
        return self.residuals(self.predict(x))

    def per_point(self, residuals: np.ndarray) -> np.ndarray:
        """Return residuals [m] in the shape of the measurements, nan where nothing was measured."""
        metres = residuals * self.measured.scale / self.weights
        if isinstance(self.measured, Surface):
            return metres
        out = np.full(self.measured.displacement.shape, np.nan)
        out[self.measured.measured] = metres
        return out

    def require_same_way(self, predicted: Prediction) -> None:
        """Raise BadInput where the measured deflection points the other way than the predicted one and no
        unknown can reverse it."""
        measured, axes = self.measured, self.model.axes
        if any(unknown.turns for unknown in self.unknowns):
            return
        if isinstance(measured, Displacements):
            name, deflection, model = "uz", measured.displacement[:, 2], predicted.displacement[:, 2]
        else:
            name, deflection = "heights", measured.points[:, 2]
            model = surface.Field(axes, predicted.displacement).at(measured.points[:, :2])[:, 2]
        correlation = _correlate(model, deflection, measured.scale)
        if correlation < OPPOSITE:
            raise BadInput(
                f"{measured.source}: the measured {name} have the opposite sign of the model's (correlation "
                f"{number(correlation, '.2f')} at the scene's own values); z points up"
            )

    def search(
        self,
        start: np.ndarray,
        check: Callable[[Self, Prediction], None] | None = None,
        smallest: float = SMALLEST,
        evaluations: int = EVALUATIONS,
        pull: float = PULL,
    ) -> Minimum:
        """Return the unknowns' x with which the model comes nearest to the measurements.

        start: x to begin at; check: called with this fit and the prediction at the start, that may
        raise; smallest: change of x, or of the sum of squares, that ends the search; evaluations: their
        largest number; pull: towards the scene's own values. Raises NoAnswer if the model has no
        equilibrium at the start."""
        cache: dict[bytes, tuple[np.ndarray, np.ndarray]] = {}

        def evaluate(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            key = x.tobytes()
            if key not in cache:
                predicted = self.predict(x)
                if check and not cache:
                    check(self, predicted)
                cache[key] = self.residuals(predicted)
                rms = float(np.sqrt(np.mean(cache[key][0] ** 2)))
                terms = (f"{u.name} = {u.value(z):.6g}" for u, z in zip(self.unknowns, x, strict=True))
                context().progress(f"{', '.join(terms)}: off by {100 * rms:.3g} % of the largest measurement")
            return cache[key]

        def residuals(x: np.ndarray) -> np.ndarray:
            try:
                return np.concatenate([evaluate(x)[0], pull * x])
            except NoAnswer as error:
                context().progress(f"no answer there: {error}")
                return np.concatenate([np.full(count, REFUSED), pull * x])

        low, high = np.array([u.bounds() for u in self.unknowns]).T
        start = np.clip(start, low, high)
        count = len(evaluate(start)[0])
        limits = {"xtol": smallest, "ftol": smallest, "gtol": 1e-12, "max_nfev": evaluations}
        slopes = lambda x: np.vstack([evaluate(x)[1], pull * np.eye(len(x))])  # noqa: E731
        end = least_squares(residuals, start, slopes, bounds=(low, high), **limits)
        return Minimum(end.x, *evaluate(end.x), end.active_mask, len(cache), end.status > 0)


def _correlate(model: np.ndarray, measured: np.ndarray, scale: float) -> float:
    """Return the correlation of the model with measured numbers, 0 where they are small or nothing moves."""
    present = np.isfinite(measured)
    model, measured = model[present], measured[present]
    norms = float(np.linalg.norm(model) * np.linalg.norm(measured))
    if norms == 0.0 or np.abs(measured).max() < TELLING * scale:
        return 0.0
    return float(model @ measured) / norms


STARTS = 6
SPREAD = log(3.0)  # of x about the scene's own value
PARTS = (0.125, 0.25, 0.5)  # of a record, before the whole
FEWEST = 6  # measured numbers per unknown that a part must have
ROUGH: dict[str, Any] = {"smallest": 1e-3, "evaluations": 12, "pull": 1e-2}  # of the search over a part
ENOUGH = 1e-6  # of the search over the whole of a motion, whose slopes are differences
SAME_MINIMUM = 0.02  # of x: the same minimum
Refusal = Callable[[Fit, Prediction], None]


def best_search(
    fit: Fit, suffices: Callable[[Minimum], bool], check: Refusal = Fit.require_same_way
) -> tuple[Minimum, int]:
    """Return the best of the searches, and the number of starts made; suffices: whether a result needs no
    further start.

    check: called with the fit of the first start, or of the first part of a motion, and the
    prediction there, that may raise. Raises NoAnswer if the model has no equilibrium with the scene's own
    values, of a motion with no start."""
    earlier: list[np.ndarray] = []
    low, high = np.array([u.bounds() for u in fit.unknowns]).T
    widths = np.minimum(SPREAD, 0.5 * (high - low))
    points = 2.0 * Halton(len(low), scramble=False).random(STARTS + 1)[1:] - 1.0
    best, failure = None, NoAnswer()
    for start, point in enumerate([np.zeros(len(low)), *points], 1):
        if start > 1:
            context().progress(f"not noise yet: start {start} of {STARTS + 1}")
        try:
            x = np.clip(widths * point, low, high)
            result = _search(fit, x, earlier, check if start == 1 else None)
        except NoAnswer as error:
            if start == 1 and not earlier:
                raise
            failure = error if start == 1 else failure
            continue
        if result is not None and (best is None or result.noise < best.noise):
            best = result
            if suffices(best):
                return best, start
    if best is None:
        raise failure
    return best, STARTS + 1


def _search(fit: Fit, start: np.ndarray, earlier: list[np.ndarray], check: Refusal | None) -> Minimum | None:
    """Return the search from a start, over growing parts of a motion, or None if it reaches an earlier
    search's x. earlier: x after the first part of each search so far; this search adds its own."""
    parts = _split_record(fit)
    for index, part in enumerate((*parts, fit)):
        options = ROUGH if part is not fit else {"smallest": ENOUGH} if parts else {}
        result = part.search(start, check if index == 0 else None, **options)
        start = result.x
        if parts and index == 0:
            if any(np.abs(start - x).max() < SAME_MINIMUM for x in earlier):
                return None
            earlier.append(start)
    return result


def _split_record(fit: Fit) -> list[Fit]:
    """Return the fits of parts of a motion that precede the fit of the whole."""
    measured = fit.measured
    if not isinstance(measured, Displacements) or measured.time is None:
        return []
    parts = [measured.until(share * float(measured.time.max())) for share in PARTS]
    needed = FEWEST * len(fit.unknowns)
    return [replace(fit, measured=part) for part in parts if part.measured.sum() >= needed]
