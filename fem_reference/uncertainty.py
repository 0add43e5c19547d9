"""What a reference's mesh leaves uncertain: Richardson extrapolation and the grid convergence index.

Answers f₁, f₂, f₃ on meshes of size h₁ < h₂ < h₃, refinement ratios r₂₁ = h₂/h₁ and r₃₂:

    order           p ln r₂₁ = |ln |(f₃ − f₂)/(f₂ − f₁)| + q(p)|,    q = ln((r₂₁ᵖ − s)/(r₃₂ᵖ − s)), s = ±1
    extrapolated    f = f₁ + (f₁ − f₂)/(r₂₁ᵖ − 1)
    by a pair       e_ij = |f_i − f_j| h₁ᵖ/(h_jᵖ − h_iᵖ)
    bar             U = F max(e₁₂, e₁₃, e₂₃) + ¹⁄₁₀ η |f₁|,   F = 1.25 (the index), 2½ where no order shows

Observed orders of 6 to 13 are two differences that happen to be small. In the bar p is no more than
3 − 2 s: the element's own order where the mesh resolves the layer along edges that let twist go, first order
where it misses all of it, a share s of 1; and every pair of meshes has its say, though one of the differences
be small. η is by how much a sheet that only twists is too stiff for the missed layer, on all three meshes
alike (`edge_layer`). Where it is no order at all (answers swing, or p < ½) nothing is extrapolated and p is
3 − 2 s. With two meshes p = 2 is assumed and F = 3. Changes that are rounding are no evidence of anything:
the bar is their size.

The slope 2, the tenth of η and the F of answers that swing were set on scenes drawn at random; how often the
bars hold is measured on others: `sheetbench verify --coverage`. Meshes of n, ¾ n and ½ n elements: a quarter
as many is too coarse for an order to show.

Sources: Roache, J. Fluids Eng. 116 (1994) 405–413; Celik et al., J. Fluids Eng. 130 (2008) 078001 (order);
ASME V&V 20-2009; Eça & Hoekstra, J. Comput. Phys. 262 (2014) 104–130 (all pairs). Lengths in metres.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations, pairwise
from typing import Any

import numpy as np

from fem_reference import solve
from fem_reference.edge_layer import NOTHING, Missed, missed_by
from fem_reference.surface.mesh import Elements, divisions
from sheetbench.scenes import Scene, Solution
from sheetbench.scenes.errors import BadInput

SAFETY, SWING, CAUTION = 1.25, 2.5, 3.0  # factors F: where an order shows, where none does, on two meshes
LEAST_ORDER, OWN_ORDER, ASSUMED_ORDER = 0.5, 3.0, 2.0
BY_LAYER = 2.0  # by which a layer missed altogether lowers the element's order
TWIST = 0.1  # of η in the bar
MESHES = (1.0, 0.75, 0.5)  # elements, of those asked for
ROUNDING = 1e-9  # of the largest answer


@dataclass(frozen=True)
class Uncertainty:
    """Answers f₁ (n, k) with their bars; sizes: mesh sizes, the finest first.

    order: observed, nan where there is none; bar: U; trusted: the order made sense, or nothing changed.
    """

    sizes: tuple[float, ...]
    answer: np.ndarray
    extrapolated: np.ndarray
    order: np.ndarray
    bar: np.ndarray
    trusted: np.ndarray

    @property
    def error(self) -> float:
        """The largest bar over the largest answer: the design's measure of error."""
        size = float(np.max(np.abs(self.answer), initial=0.0))
        return float(np.max(self.bar, initial=0.0)) / size if size > 0.0 else 0.0

    @property
    def overall_order(self) -> float:
        """The order of the component with the largest bar among those that have one, else nan."""
        known = np.isfinite(self.order)
        return float(self.order[known][np.argmax(self.bar[known])]) if known.any() else float("nan")


def coarser(elements: Elements) -> list[Elements]:
    """The meshes to solve on, the one asked for first: elements along the shorter side, or along x and y."""

    def smaller(share: float) -> Elements:
        if isinstance(elements, int):
            return max(1, round(elements * share))
        along_x, along_y = elements
        return max(1, round(along_x * share)), max(1, round(along_y * share))

    return list(dict.fromkeys(smaller(share) for share in MESHES))


def mesh_size(scene: Scene, elements: Elements) -> float:
    """Mean size of an element [m]."""
    along_x, along_y = divisions(scene.sheet, elements)
    return float(np.sqrt(np.prod(scene.sheet.lengths) / (along_x * along_y)))


def solve_with_bar(
    scene: Scene, points: np.ndarray, model: str = "shell", elements: Elements = 16, **options: Any
) -> tuple[Solution, Uncertainty | None]:
    """A reference's answer and the uncertainty of its displacement (n, 3) [m] at plan points (n, 2) [m].

    Solves on `coarser(elements)`; None where fewer than two of the meshes have an equilibrium.
    """
    solutions = [solve(scene, model, elements=n, **options) for n in coarser(elements)]
    sizes = [mesh_size(scene, n) for n in coarser(elements)]
    return solutions[0], of_solutions(scene, solutions, sizes, points)


def of_solutions(
    scene: Scene, solutions: Sequence[Solution], sizes: Sequence[float], points: np.ndarray
) -> Uncertainty | None:
    """The same from solutions of a scene on meshes of the given sizes, the finest first."""
    usable = [
        (solution.displacement(points), size)
        for solution, size in zip(solutions, sizes, strict=True)
        if solution.comparable
    ]
    if len(usable) < 2 or usable[0][1] != sizes[0]:
        return None
    layer = missed_by(scene, solutions[0].settings)
    return estimate([answer for answer, _ in usable], [size for _, size in usable], layer)


def estimate(
    answers: Sequence[np.ndarray],
    sizes: Sequence[float],
    layer: Missed = NOTHING,
    own_order: float = OWN_ORDER,
) -> Uncertainty:
    """Bars of answers (n, k) on two or three meshes of rising size.

    layer: what the finest of them misses of it; own_order: the elements'. Raises BadInput for other numbers.
    """
    if len(answers) not in (2, 3) or len(answers) != len(sizes):
        raise BadInput(f"{len(answers)} answers on {len(sizes)} meshes: two or three of both are needed")
    if any(later <= earlier for earlier, later in pairwise(sizes)):
        raise BadInput(f"mesh sizes {list(sizes)} must rise: the finest mesh comes first")
    fine, step = answers[0], answers[0] - answers[1]
    ratio = sizes[1] / sizes[0]
    spread = np.max(answers, axis=0) - np.min(answers, axis=0)
    rounding = spread <= ROUNDING * np.max(np.abs(fine), initial=0.0)
    largest = own_order - BY_LAYER * layer.share
    safety: float | np.ndarray
    if len(answers) == 2:
        order, trusted = np.full(fine.shape, np.nan), rounding
        used, safety = np.full(fine.shape, min(ASSUMED_ORDER, largest)), CAUTION
    else:
        order = _observed(step, answers[1] - answers[2], ratio, sizes[2] / sizes[1])
        order[rounding] = np.nan
        trusted = rounding | (order >= LEAST_ORDER)
        used = np.where(trusted, np.nan_to_num(order, nan=largest), largest)
        safety = np.where(trusted, SAFETY, SWING)
    bar = safety * _by_pairs(answers, sizes, np.minimum(used, largest))
    change = step / (ratio**used - 1.0)
    if len(answers) == 3:
        change = np.where(trusted, change, 0.0)
    return Uncertainty(
        sizes=tuple(sizes),
        answer=fine,
        extrapolated=np.where(rounding, fine, fine + change),
        order=order,
        bar=np.where(rounding, spread, bar) + TWIST * layer.stiffening * np.abs(fine),
        trusted=trusted,
    )


def _by_pairs(answers: Sequence[np.ndarray], sizes: Sequence[float], order: np.ndarray) -> np.ndarray:
    """The largest error of the finest answer that a pair of meshes tells of, at orders (n, k)."""
    pairs = combinations(zip(answers, sizes, strict=True), 2)
    found = [np.abs(f - g) * sizes[0] ** order / (k**order - h**order) for (f, h), (g, k) in pairs]
    return np.asarray(np.max(found, axis=0))


def _observed(fine: np.ndarray, coarse: np.ndarray, ratio: float, next_ratio: float) -> np.ndarray:
    """p of the steps f₁ − f₂ and f₂ − f₃; nan where they swing, 0 or less where they do not shrink."""
    with np.errstate(divide="ignore", invalid="ignore"):
        quotient = coarse / fine
        logarithm = np.log(np.where(quotient > 0.0, quotient, np.nan))
        order = logarithm / np.log(ratio)
        for _ in range(50):  # a fixed point; one step where the ratios are equal
            order = (logarithm + np.log((ratio**order - 1.0) / (next_ratio**order - 1.0))) / np.log(ratio)
    return order
