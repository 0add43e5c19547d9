"""Residuals: the runs test for noise, rows that do not fit, and warnings about a fit.

Independent noise gives two neighbouring residuals equal signs with probability 1/2. Neighbours are
consecutive samples of a motion at one point, and points joined by the minimal spanning tree of the plan at
rest. A tree has no cycles, so that the pairs' signs are independent and the number of equal ones is binomial,
m pairs with probability 1/2, whatever the noise's distribution, if its median is 0. Sources: Wald and
Wolfowitz, Ann. Math. Statist. 11 (1940) 147; Friedman and Rafsky, Ann. Statist. 7 (1979) 697.

Rows of a table may not fit while the others do: typing slips, lost markers. The row farthest off is left out
and the fit made again from where it was; it is named if it is then FAR times the others' standard deviation
off. Up to MOST rows are tried in turn, one in FEWEST at most.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import log

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import minimum_spanning_tree
from scipy.spatial import KDTree
from scipy.special import bdtrc

from comparisons.identification.fit import Fit, Minimum
from comparisons.identification.measurements import MOVED, Displacements, Measured
from comparisons.identification.model import NoAnswer
from comparisons.identification.unknowns import Estimate
from sheetbench.answers.table import quantity
from sheetbench.scenes.language.summary import few

UNLIKELY = 1e-3  # probability below which as many equal signs are not noise
SMALL = 2e-3  # standard deviation of residuals, of the largest measurement, below which no test is made
FACTOR = 3.0  # between a value and the scene's own: one of them is wrong
POOR = 0.05  # and one that is more than noise usually is
NEIGHBOURS = 12  # of a point, among which the spanning tree is looked for


@dataclass(frozen=True)
class Runs:
    """The runs test of residuals: `equal` of `pairs` neighbouring residuals have one sign; along: "time" or
    "space"."""

    equal: int
    pairs: int
    along: str

    @property
    def probability(self) -> float:
        """Probability that independent noise gives one sign to `equal` pairs or more."""
        return float(bdtrc(self.equal - 1, self.pairs, 0.5)) if self.equal else 1.0

    def __str__(self) -> str:
        where = "consecutive samples" if self.along == "time" else "neighbouring points"
        return (
            f"{100 * self.equal / self.pairs:.0f} % of {self.pairs} pairs of {where} have residuals of one "
            "sign, of noise half would have"
        )


def runs(measured: Measured, residuals: np.ndarray) -> Runs:
    """Return the runs test of residuals in the shape of the measurements, nan where nothing was measured."""
    pairs, direction = _pair_neighbours(measured)
    signs = np.nan_to_num(np.sign(residuals)).reshape(len(residuals), -1)
    products = signs[pairs[:, 0]] * signs[pairs[:, 1]]
    return Runs(int((products > 0.0).sum()), int((products != 0.0).sum()), direction)


def explained(noise: float, signs: Runs, deviation: float = 0.0) -> bool:
    """Return whether residuals with a standard deviation `noise`, in units of the largest measurement, are
    small, not larger than the measurements' `deviation`, or noise by the runs test."""
    return noise < max(SMALL, deviation) or (noise < POOR and signs.probability > UNLIKELY)


def _pair_neighbours(measured: Measured) -> tuple[np.ndarray, str]:
    """Return pairs of neighbouring rows (m, 2), and whether they are neighbours along "time" or "space"."""
    if measured.time is not None:
        _, place = np.unique(measured.points, axis=0, return_inverse=True)
        sequence = np.lexsort((measured.time, place.ravel()))
        pairs = np.column_stack([sequence[:-1], sequence[1:]])
        return pairs[place.ravel()[pairs[:, 0]] == place.ravel()[pairs[:, 1]]], "time"
    points = measured.points[:, :2]
    count = min(NEIGHBOURS + 1, len(points))
    distance, neighbour = KDTree(points).query(points, k=range(1, count + 1))
    distance = distance + 1e-12 * distance.max()  # the graph has no edges of length 0
    rows = np.repeat(np.arange(len(points)), count)
    graph = csr_array((distance.ravel(), (rows, neighbour.ravel())), shape=(len(points),) * 2)
    tree = minimum_spanning_tree(graph).tocoo()
    return np.column_stack([tree.row, tree.col]), "space"


SUSPECT = 5.0  # times the residuals' standard deviation, judged by their median: a row that is looked at
FAR = 8.0  # times the others' standard deviation
MOST = 3  # rows
FEWEST = 8  # rows for each that may be left out: fewer do not tell what is usual
NORMAL = 1.4826  # standard deviation over the median of |noise|, of normal noise


@dataclass(frozen=True)
class Outlier:
    """A row that does not fit: its number, its name, its component with the largest residual, and that
    component [m], measured and by the fit of all other rows."""

    row: int
    name: str
    component: str
    measured: float
    fitted: float

    def __str__(self) -> str:
        return (
            f"{self.name}: {self.component} = {self.measured:g} m, but {self.fitted:.4g} m by the fit of the "
            "other rows"
        )


def outliers(fit: Fit, best: Minimum) -> tuple[Outlier, ...]:
    """Return the rows that do not fit; best: the search over all rows. A surface has none."""
    measured = fit.measured
    if not isinstance(measured, Displacements):
        return ()
    residuals, x = fit.per_point(best.residuals), best.x
    rows: list[int] = []
    outlying: tuple[Outlier, ...] = ()
    while len(rows) < min(MOST, len(residuals) // FEWEST):
        others = np.abs(np.delete(residuals, rows, axis=0))
        others = others[np.isfinite(others)]
        if others.max() <= SUSPECT * NORMAL * np.median(others):
            break
        size = np.nan_to_num(np.abs(residuals)).max(axis=1)
        size[rows] = 0.0
        rows.append(int(np.argmax(size)))
        x = replace(fit, measured=measured.without(rows)).search(x).x
        residuals = fit.per_point(fit.at(x)[0])
        deviation = float(np.nanstd(np.delete(residuals, rows, axis=0)))
        if np.nan_to_num(np.abs(residuals[rows])).max(axis=1).min() > FAR * deviation:
            outlying = tuple(_describe_outlier(measured, residuals, row) for row in rows)
    return outlying


def _describe_outlier(measured: Displacements, residuals: np.ndarray, row: int) -> Outlier:
    worst = int(np.argmax(np.nan_to_num(np.abs(residuals[row]))))
    value = float(measured.displacement[row, worst])
    return Outlier(row, measured.name_of(row), MOVED[worst], value, value + float(residuals[row, worst]))


CELLS = "cells half as large"


def residual_notes(fit: Fit, best: Minimum, signs: Runs, starts: int) -> list[str]:
    """Return a warning of residuals that are more than noise, with a remedy."""
    names = ", ".join(u.name for u in fit.unknowns)
    effort = f"the best of {starts} starts" if starts > 1 else "the search"
    deviation = quantity(fit.measured.scale * best.noise, "m", ".3g")
    size = f"{effort} leaves residuals of {deviation}, {few(100 * best.noise)} % of the largest measurement"
    if best.noise > POOR:
        return [
            f"a poor fit: {size}: no value of {names} explains these data; look at frame, supports and model"
        ]
    if explained(best.noise, signs, fit.deviation):
        return []
    return [
        f"not explained: {size}, and are not noise: {signs}. Something is missing in the model (supports, "
        "loads, an unknown, finer cells), and the interval, which assumes noise, is too narrow"
    ]


def start_notes(fit: Fit, best: Minimum, estimates: Mapping[str, Estimate]) -> list[str]:
    """Return a warning of values more than FACTOR times the scene's, or less than a FACTOR-th of it, with the
    largest measurement beside the model's displacement with the scene's own values."""
    changed = [
        f"{u.name} = {quantity(u.value(x), u.unit, '.3g')} is {few(u.value(x) / u.start, 3)} times the "
        f"scene's {quantity(u.start, u.unit, '.3g')}"
        for u, x in zip(fit.unknowns, best.x, strict=True)
        if u.step is None and u.given and estimates[u.name].determined and abs(x) > log(FACTOR)
    ]
    question = "Is a value, a dimension, a support or a unit of the scene wrong?"
    return [f"{'; '.join(changed)}{_compare_largest(fit)}. {question}"] if changed else []


def _compare_largest(fit: Fit) -> str:
    """Return the largest measured displacement at rest beside the model's with the scene's own values."""
    measured = fit.measured
    if not isinstance(measured, Displacements) or measured.time is not None:
        return ""
    row, axis = np.unravel_index(np.nanargmax(np.abs(measured.displacement)), measured.displacement.shape)
    try:
        predicted = fit.predict(np.zeros(len(fit.unknowns))).displacement[row, axis]
    except NoAnswer:
        return ""
    values = (quantity(float(value), "m", ".3g") for value in (predicted, measured.displacement[row, axis]))
    return ", with which {} = {} where {} were measured".format(MOVED[int(axis)], *values)


def ties_notes(fit: Fit, best: Minimum) -> list[str]:
    """Return a warning of rounded numbers, with a scatter below the rounding error: half of the numbers are
    equal to another one, and the residuals are below the rounding error of the smallest difference."""
    measured = fit.measured
    if not isinstance(measured, Displacements) or measured.deviation is not None:
        return []
    values = measured.displacement[measured.measured]
    distinct = np.unique(values)
    gap = float(np.diff(distinct).min(initial=np.inf))
    if 2 * len(distinct) > len(values) or measured.scale * best.noise > gap / 12**0.5:
        return []
    return [
        f"the {len(values)} measured numbers are equal, or equal in pairs: they are rounded, and the "
        "interval, of their scatter, is too narrow; give --uncertainty (rounding to 1 mm has a standard "
        "deviation of 0.29 mm)"
    ]


def bounds_notes(fit: Fit, best: Minimum) -> list[str]:
    """Return warnings of unknowns that ended at a bound of the search."""
    return [
        f"{u.name} hit its search bound {quantity(u.value(x), u.unit)}: the data do not constrain it"
        for u, x, active in zip(fit.unknowns, best.x, best.against_bounds, strict=True)
        if active
    ]


def grid_notes(
    estimates: Mapping[str, Estimate], model: str, estimated: bool, fitted_grid: Sequence[int] | None = None
) -> list[str]:
    """Return warnings of intervals that consist mostly of the error of the grid or mesh, or that lack it;
    estimated: whether it was sought; fitted_grid: the last grid, if the fit chose it."""
    lattice = model == "lumped"
    variant, error = (CELLS, "grid's") if lattice else ("elements twice as large", "mesh's")
    with_interval = [u for u in estimates.values() if u.determined and u.interval is not None]
    if estimated and with_interval and all(u.interval == u.noise_interval for u in with_interval):
        return [f"{variant} could not be solved: the {error} error is not known, nor in the interval"]
    remedy = "masses (--lumped), or leave the grid to the fit" if lattice else "--elements"
    if fitted_grid is not None:
        remedy = f"masses than the fit did, --lumped {2 * fitted_grid[0] - 1}x{2 * fitted_grid[1] - 1}"
    wide_intervals = {
        name: "" if u.refined is None else f" would be {quantity(u.refined, u.unit)} on {CELLS}"
        for name, u in estimates.items()
        if u.determined and _is_widened(u)
    }
    advice = f"most of its interval is the {error} error; take more {remedy}"
    return [f"{name}{value}: {advice}" for name, value in wide_intervals.items()]


def _is_widened(estimate: Estimate) -> bool:
    """Return whether the grid widens an interval to more than twice the noise's."""
    if estimate.interval is None or estimate.noise_interval is None:
        return False
    total, noise = np.ptp(estimate.interval), np.ptp(estimate.noise_interval)
    return bool(total > 2.0 * noise and total > 1e-2 * abs(estimate.value))
