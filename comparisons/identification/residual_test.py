"""The runs test of residuals for noise, along time or between neighbouring points.

Independent noise gives two neighbouring residuals the same sign as often as not. Neighbours are consecutive
samples of a motion at one point, and points joined by the minimal spanning tree of the plan at rest. A tree
has no cycles, so that the pairs' signs are independent and the number of equal ones is binomial, m pairs with
probability 1/2, whatever the noise's distribution, if its median is 0.
Sources: Wald and Wolfowitz, Ann. Math. Statist. 11 (1940) 147; Friedman and Rafsky, Ann. Statist. 7 (1979)
697.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import minimum_spanning_tree
from scipy.spatial import KDTree
from scipy.special import bdtrc

from comparisons.identification.measurements import Displacements, Measured

UNLIKELY = 1e-3  # probability below which as many equal signs are not noise
SMALL = 2e-3  # standard deviation of residuals, of the largest measurement, below which no test is made
POOR = 0.05  # and one that is more than noise usually is
NEIGHBOURS = 12  # of a point, among which the spanning tree is looked for


@dataclass(frozen=True)
class Runs:
    """Of `pairs` neighbouring residuals `equal` have the same sign; along: "time" or "space"."""

    equal: int
    pairs: int
    along: str

    @property
    def probability(self) -> float:
        """That independent noise gives so many pairs the same sign, or more."""
        return float(bdtrc(self.equal - 1, self.pairs, 0.5)) if self.equal else 1.0

    def __str__(self) -> str:
        where = "consecutive samples" if self.along == "time" else "neighbouring points"
        return (
            f"{100 * self.equal / self.pairs:.0f} % of {self.pairs} pairs of {where} have residuals of one "
            "sign, of noise half would have"
        )


def runs(measured: Measured, residuals: np.ndarray) -> Runs:
    """Return the runs test of residuals in the shape of the measurements, nan where nothing was measured."""
    pairs, along = _pairs(measured)
    signs = np.nan_to_num(np.sign(residuals)).reshape(len(residuals), -1)
    products = signs[pairs[:, 0]] * signs[pairs[:, 1]]
    return Runs(int((products > 0.0).sum()), int((products != 0.0).sum()), along)


def explained(noise: float, found: Runs) -> bool:
    """Return whether residuals of this standard deviation, in units of the largest measurement, are small or
    noise."""
    return noise < SMALL or (noise < POOR and found.probability > UNLIKELY)


def _pairs(measured: Measured) -> tuple[np.ndarray, str]:
    """Numbers of neighbouring rows (m, 2), and along what they are neighbours."""
    if isinstance(measured, Displacements) and measured.time is not None:
        _, place = np.unique(measured.points, axis=0, return_inverse=True)
        order = np.lexsort((measured.time, place.ravel()))
        pairs = np.column_stack([order[:-1], order[1:]])
        return pairs[place.ravel()[pairs[:, 0]] == place.ravel()[pairs[:, 1]]], "time"
    points = measured.points[:, :2]
    near = min(NEIGHBOURS + 1, len(points))
    distance, neighbour = KDTree(points).query(points, k=range(1, near + 1))
    distance = distance + 1e-12 * distance.max()  # the graph has no edges of length 0
    rows = np.repeat(np.arange(len(points)), near)
    graph = csr_array((distance.ravel(), (rows, neighbour.ravel())), shape=(len(points),) * 2)
    tree = minimum_spanning_tree(graph).tocoo()
    return np.column_stack([tree.row, tree.col]), "space"
