"""What a reference's mesh leaves uncertain: Richardson extrapolation and the grid convergence index.

Answers f₁, f₂, f₃ on meshes of size h₁ < h₂ < h₃, refinement ratios r₂₁ = h₂/h₁ and r₃₂:

    order           p ln r₂₁ = ln((f₃ − f₂)/(f₂ − f₁)) + q(p),    q = ln((r₂₁ᵖ − 1)/(r₃₂ᵖ − 1))
    extrapolated    f = f₁ + (f₁ − f₂)/(r₂₁ᵖ − 1)
    by a pair       e_ij = |f_i − f_j| h₁ᵖ/(h_jᵖ − h_iᵖ),   p of the field
    by the layer    e_η = min(|f₁ − f₃| η₁/(η₃ − η₁), 0.3 η₁ |f₁|)
    bar             U = e + c ē |f₁|,   e = max(e₁₂, e₁₃, e₂₃) + e_η,   c = 0.35

Celik et al. take magnitudes and ± 1 in q, and so give an order to answers that swing, f₃ − f₂ and f₂ − f₁ of
unlike signs: here those have none. Changes that grow give an order below 0.

Observed orders of single components are chance more often than not: differences that happen to be small, or
of either sign, give 0.6, 9 or none for elements of order 3. In the bar p is the field's, the median over the
components (those that show none, p < ½ or answers that swing, count as high), and no more than 3 − 2 s: the
elements' own where the mesh resolves the layer along edges that let twist go, first order where it misses a
share s of 1 of it. Every pair has its say, so that one small difference shrinks no bar. ē is the root mean
square of e over that of f₁, of the components in the same direction at all points: where a component's own
differences are all small by chance, its neighbours know. If all components tell of the same relative error
by one power of h, as textbooks have it, U is 1.35 times that error (Roache's index: 1.25).

Meshes that are fitted to rims of any shape do not refine one another: errors of single components vary from
mesh to mesh as if by chance, and fall with order 1.0 to 3.3, 1.8 in the median at round holes and patches.
There p is no more than 2, and c = 1: the neighbours count in full.

η is by how much a sheet that only twists is too stiff for what a mesh misses of the layer (`edge_layer`): the
meshes' answers differ by what they miss more or less of it, and where all of them miss it alike, three tenths
of η bound it. With two meshes p = 2 is assumed and U = 3 e. Changes that are rounding are no evidence of
anything: the bar is their size.

The numbers 0.3, 0.35 and 1 were set on scenes drawn at random; how often the bars hold is measured on
others: `sheetbench study promises`. Meshes of n, ¾ n and ½ n elements: a quarter as many is too coarse for
an order to show.

Sources: Roache, J. Fluids Eng. 116 (1994) 405–413; Celik et al., J. Fluids Eng. 130 (2008) 078001 (order);
ASME V&V 20-2009; Eça & Hoekstra, J. Comput. Phys. 262 (2014) 104–130 (all pairs). Lengths in metres.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations, pairwise
from typing import Any, NamedTuple

import numpy as np

from fem_reference import solve
from fem_reference.edge_layer import NOTHING, Missed, missed_by
from fem_reference.surface.borders import has_lines
from fem_reference.surface.mesh import Elements, divisions
from sheetbench.answers.solution import Solution
from sheetbench.errors import BadInput
from sheetbench.scenes import Scene

CAUTION = 3.0  # of e in the bar by two meshes
LEAST_ORDER, ASSUMED_ORDER = 0.5, 2.0
BY_LAYER = 2.0  # by which a layer missed altogether lowers the element's order
TWIST = 0.3  # the most of η that counts
MESHES = (1.0, 0.75, 0.5)  # elements, of those requested
ROUNDING = 1e-9  # of the largest answer


class MeshFamily(NamedTuple):
    """What is known of a family of meshes: the most that p may be, and c."""

    order: float
    neighbours: float


IN_ROWS, FITTED, SECOND_ORDER = MeshFamily(3.0, 0.35), MeshFamily(2.0, 1.0), MeshFamily(2.0, 0.35)


def family_of(scene: Scene) -> MeshFamily:
    """Return that of a scene's meshes of quadratic elements."""
    return IN_ROWS if has_lines(scene) else FITTED


@dataclass(frozen=True)
class Uncertainty:
    """Answers f₁ (n, k) with their bars; sizes: mesh sizes, the finest first.

    order: observed, nan where there is none; bar: U; trusted: the order made sense, or nothing changed;
    converging: whether the field, in root mean square, changes less between the two finer meshes than
    between the two coarser, or not at all, whatever single components do.
    """

    sizes: tuple[float, ...]
    answer: np.ndarray
    extrapolated: np.ndarray
    order: np.ndarray
    bar: np.ndarray
    trusted: np.ndarray
    converging: bool

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
    """The meshes to solve on, the one requested first: elements along the shorter side, or along x and y."""

    counts = (elements,) if isinstance(elements, int) else elements
    meshes: Any = dict.fromkeys(tuple(max(1, round(n * share)) for n in counts) for share in MESHES)
    return [mesh[0] for mesh in meshes] if isinstance(elements, int) else list(meshes)


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
    """Return the uncertainty that solutions on meshes of these sizes show, finest first; None as above."""
    found = [(one, size) for one, size in zip(solutions, sizes, strict=True) if one.comparable]
    usable = [(one.displacement(points), size, missed_by(scene, one.settings)) for one, size in found]
    if len({size for _, size, _ in usable}) < 2 or usable[0][1] != sizes[0]:
        return None
    answers, of_sizes, layers = zip(*usable, strict=True)
    return estimate(answers, of_sizes, layers, family_of(scene))


def of_answers(scene: Scene, answers: Sequence[np.ndarray], meshes: Sequence[Elements]) -> Uncertainty:
    """Return the bars of any answers (n, k) on these numbers of elements, finest first, but for the layer."""
    return estimate(answers, [mesh_size(scene, n) for n in meshes], family=family_of(scene))


def estimate(
    answers: Sequence[np.ndarray],
    sizes: Sequence[float],
    layers: Sequence[Missed] = (),
    family: MeshFamily = IN_ROWS,
) -> Uncertainty:
    """Bars of answers (n, k) on two or three meshes of rising size.

    layers: what each of the meshes misses of it, nothing unless given. Of meshes of one size, as ¾ and ½ of
    few elements are, the first counts. Raises BadInput for other numbers.
    """
    if len(answers) not in (2, 3) or len(answers) != len(sizes):
        raise BadInput(f"{len(answers)} answers on {len(sizes)} meshes: two or three of both are needed")
    layers = layers or [NOTHING] * len(sizes)
    first = [i for i, size in enumerate(sizes) if size not in sizes[:i]]
    answers, sizes = [answers[i] for i in first], [sizes[i] for i in first]
    layers = [layers[i] for i in first]
    if len(sizes) < 2 or any(later <= earlier for earlier, later in pairwise(sizes)):
        raise BadInput(f"mesh sizes {list(sizes)} must rise: the finest mesh comes first")
    fine, step = answers[0], answers[0] - answers[1]
    ratio = sizes[1] / sizes[0]
    spread = np.max(answers, axis=0) - np.min(answers, axis=0)
    rounding = spread <= ROUNDING * np.max(np.abs(fine), initial=0.0)
    largest = min(family.order, IN_ROWS.order - BY_LAYER * layers[0].share)
    if len(answers) == 2:
        order, trusted, converging = np.full(fine.shape, np.nan), rounding, bool(rounding.all())
        of_field, own, neighbours = min(ASSUMED_ORDER, largest), CAUTION, 0.0
        change = step / (ratio**of_field - 1.0)
    else:
        before = answers[1] - answers[2]
        converging = bool(np.linalg.norm(step) < np.linalg.norm(before) or rounding.all())
        order = _observed(step, before, ratio, sizes[2] / sizes[1])
        order[rounding] = np.nan
        trusted = rounding | (order >= LEAST_ORDER)
        steep = np.where(order >= LEAST_ORDER, order, np.inf)[~rounding]  # those that are none count as high
        of_field, own, neighbours = largest, 1.0, family.neighbours
        if len(steep):
            of_field = min(float(np.median(steep)), largest)
        change = np.where(trusted, step / (ratio ** np.where(trusted, order, 1.0) - 1.0), 0.0)
    error = _by_pairs(answers, sizes, of_field) + _by_layer(answers, layers)
    bar = own * error + neighbours * _relative(error, fine) * np.abs(fine)
    return Uncertainty(
        sizes=tuple(sizes),
        answer=fine,
        extrapolated=np.where(rounding, fine, fine + change),
        order=order,
        bar=np.where(rounding, spread, bar),
        trusted=trusted,
        converging=converging,
    )


def _by_pairs(answers: Sequence[np.ndarray], sizes: Sequence[float], order: float) -> np.ndarray:
    """The largest error (n, k) of the finest answer that a pair of meshes tells of."""
    pairs = combinations(zip(answers, sizes, strict=True), 2)
    found = [np.abs(f - g) * sizes[0] ** order / (k**order - h**order) for (f, h), (g, k) in pairs]
    return np.asarray(np.max(found, axis=0))


def _by_layer(answers: Sequence[np.ndarray], layers: Sequence[Missed]) -> np.ndarray:
    """The error (n, k) of the finest answer by what it misses of the layer."""
    least, most = layers[0].stiffening, layers[-1].stiffening
    at_most = TWIST * least * np.abs(answers[0])
    if most <= least:
        return at_most
    return np.asarray(np.minimum(at_most, np.abs(answers[0] - answers[-1]) * least / (most - least)))


def _relative(error: np.ndarray, answer: np.ndarray) -> np.ndarray:
    """ē (k,): of all points, in each direction."""
    size = np.sqrt(np.sum(answer**2, axis=0))
    return np.divide(np.sqrt(np.sum(error**2, axis=0)), size, out=np.zeros_like(size), where=size > 0.0)


def _observed(fine: np.ndarray, coarse: np.ndarray, ratio: float, next_ratio: float) -> np.ndarray:
    """p of the steps f₁ − f₂ and f₂ − f₃; nan where they swing, 0 or less where they do not shrink."""
    with np.errstate(divide="ignore", invalid="ignore"):
        quotient = coarse / fine
        logarithm = np.log(np.where(quotient > 0.0, quotient, np.nan))
        order = logarithm / np.log(ratio)
        for _ in range(50):  # a fixed point; one step where the ratios are equal
            order = (logarithm + np.log((ratio**order - 1.0) / (next_ratio**order - 1.0))) / np.log(ratio)
    return order
