"""What a reference's mesh leaves uncertain: Richardson extrapolation and the grid convergence index.

Answers f₁, f₂, f₃ on meshes of size h₁ < h₂ < h₃, refinement ratios r₂₁ = h₂/h₁ and r₃₂:

    order           p ln r₂₁ = |ln |(f₃ − f₂)/(f₂ − f₁)| + q(p)|,    q = ln((r₂₁ᵖ − s)/(r₃₂ᵖ − s)), s = ±1
    extrapolated    f = f₁ + (f₁ − f₂)/(r₂₁ᵖ − 1)
    bar             U = F |f₁ − f₂|/(r₂₁ᵖ − 1),   F = 1.25 (the index: about 95 % of errors lie within)

In the bar p counts up to 2, what the corners where a clamp meets a free edge leave, though more may be
observed. Where it is no order at all (answers swing, or p < ½) nothing is extrapolated and U = 3 × the range
of the answers. With two meshes p = 2 is assumed and F = 3. Changes that are rounding are no evidence of
anything: the bar is their size.

Meshes of n, ¾ n and ½ n elements: a quarter as many is too coarse for an order to show.

Sources: Roache, J. Fluids Eng. 116 (1994) 405–413; Celik et al., J. Fluids Eng. 130 (2008) 078001 (order);
ASME V&V 20-2009; Eça & Hoekstra, J. Comput. Phys. 262 (2014) 104–130 (range). Lengths in metres.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from fem_reference import solve
from fem_reference.surface.mesh import Elements, divisions
from sheetbench.scenes import Scene, Solution
from sheetbench.scenes.errors import BadInput

SAFETY, CAUTION = 1.25, 3.0  # factors F of safety
LEAST_ORDER, LARGEST_ORDER = 0.5, 2.0
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
    return solutions[0], of_solutions(solutions, sizes, points)


def of_solutions(
    solutions: Sequence[Solution], sizes: Sequence[float], points: np.ndarray
) -> Uncertainty | None:
    """The same from solutions on meshes of the given sizes, the finest first."""
    usable = [
        (solution.displacement(points), size)
        for solution, size in zip(solutions, sizes, strict=True)
        if solution.comparable
    ]
    if len(usable) < 2 or usable[0][1] != sizes[0]:
        return None
    return estimate([answer for answer, _ in usable], [size for _, size in usable])


def estimate(answers: Sequence[np.ndarray], sizes: Sequence[float]) -> Uncertainty:
    """Bars of answers (n, k) on two or three meshes of rising size. Raises BadInput for other numbers."""
    if len(answers) not in (2, 3) or len(answers) != len(sizes):
        raise BadInput(f"{len(answers)} answers on {len(sizes)} meshes: two or three of both are needed")
    if any(later <= earlier for earlier, later in pairwise(sizes)):
        raise BadInput(f"mesh sizes {list(sizes)} must rise: the finest mesh comes first")
    fine, step = answers[0], answers[0] - answers[1]
    ratio = sizes[1] / sizes[0]
    spread = np.max(answers, axis=0) - np.min(answers, axis=0)
    rounding = spread <= ROUNDING * np.max(np.abs(fine), initial=0.0)
    if len(answers) == 2:
        order, trusted, safety = np.full(fine.shape, np.nan), rounding, CAUTION
    else:
        order = _observed(step, answers[1] - answers[2], ratio, sizes[2] / sizes[1])
        order[rounding] = np.nan
        trusted, safety = rounding | (order >= LEAST_ORDER), SAFETY
    used = np.maximum(np.nan_to_num(order, nan=LARGEST_ORDER), LEAST_ORDER)
    bar = safety * np.abs(step) / (ratio ** np.minimum(used, LARGEST_ORDER) - 1.0)
    change = step / (ratio**used - 1.0)
    if len(answers) == 3:
        bar, change = np.where(trusted, bar, CAUTION * spread), np.where(trusted, change, 0.0)
    return Uncertainty(
        sizes=tuple(sizes),
        answer=fine,
        extrapolated=np.where(rounding, fine, fine + change),
        order=order,
        bar=np.where(rounding, spread, bar),
        trusted=trusted,
    )


def _observed(fine: np.ndarray, coarse: np.ndarray, ratio: float, next_ratio: float) -> np.ndarray:
    """p of the steps f₁ − f₂ and f₂ − f₃; nan where they swing, 0 or less where they do not shrink."""
    with np.errstate(divide="ignore", invalid="ignore"):
        quotient = coarse / fine
        logarithm = np.log(np.where(quotient > 0.0, quotient, np.nan))
        order = logarithm / np.log(ratio)
        for _ in range(50):  # a fixed point; one step where the ratios are equal
            order = (logarithm + np.log((ratio**order - 1.0) / (next_ratio**order - 1.0))) / np.log(ratio)
    return order
