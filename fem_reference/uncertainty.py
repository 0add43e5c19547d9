"""Discretisation uncertainty of a reference: Richardson extrapolation and the grid convergence index.

Answers f₁, f₂, f₃ on meshes of size h₁ < h₂ < h₃, refinement ratios r₂₁ = h₂/h₁ and r₃₂:

    order           p ln r₂₁ = ln((f₃ − f₂)/(f₂ − f₁)) + q(p),    q = ln((r₂₁ᵖ − 1)/(r₃₂ᵖ − 1))
    extrapolated    f = f₁ + (f₁ − f₂)/(r₂₁ᵖ − 1)
    by a pair       e_ij = |f_i − f_j| h₁ᵖ/(h_jᵖ − h_iᵖ),   p of the field
    by the layer    e_η = min(|f₁ − f₃| η₁/(η₃ − η₁), 0.3 η₁ |f₁|)
    bar             U = e + c ē |f₁|,   e = max(e₁₂, e₁₃, e₂₃) + e_η,   c = 0.35

Celik et al. take magnitudes and ± 1 in q, and so give an order to oscillating answers, f₃ − f₂ and f₂ − f₁ of
unlike signs: here oscillating answers have no order. Changes that grow give an order below 0.

Observed orders of single components are chance more often than not: differences that happen to be small, or
of either sign, give 0.6, 9 or none for elements of order 3. The bar uses the field's p, the median over the
components (components without an order, p < ½ or oscillating, count as high), and no more than 3 − 2 s: the
elements' own order where the mesh resolves the layer along edges without twisting moment, first order where
it misses all of it (s = 1). Every pair counts, so that one small difference shrinks no bar. ē is the root
mean square of e over the root mean square of f₁, of one direction's components at all points: it bounds a
component whose own differences are all small by chance. If all components have one relative error that falls
with one power of h, the textbook case, U is 1.35 times that error (Roache's index: 1.25).

Meshes that are fitted to rims of any shape do not refine one another: errors of single components vary from
mesh to mesh as if by chance, and fall with order 1.0 to 3.3, 1.8 in the median at round holes and patches.
There p is no more than 2. Rims have sides in proportion to the number of elements from 8 on (`outlined`):
meshes that divide a rim alike err alike, and agree.

Nor is p larger than the smoothness of the solution gives: 1.5 over planes, balls and boxes, where nodes touch
and the border of contact lies between them, on points, and with re-entrant corners of the sheet or around a
patch; 1 with re-entrant corners around a held part; 2 over cylinders; 2.5 with fibres, whose corners are
more singular. Points that hold each other in the sheet's plane sink into it by the logarithm of the element's
size, without a limit: p = 0.7 there bounds the distance from meshes of up to four times as many elements.

η is the relative excess stiffness of a sheet that only twists, by the unresolved part of the layer
(`edge_layer`): the meshes' answers differ as their unresolved parts do, and where all meshes miss it alike,
three tenths of η bound the error. Two meshes give no order: p = 2 is assumed and U = 3 e. Changes of the size
of rounding are no evidence: the bar is their size. Three times the largest change where changes swing in sign
(Eça and Hoekstra) is not taken: bars that are right grow to 2.6 times in the mean, and over planes 88 % hold.

The numbers 0.3 and 0.35 were set on scenes drawn at random; how often the bars hold is measured on others:
`sheetbench study promises`. Meshes have n, ¾ n and ½ n elements: a quarter as many is too coarse to show an
order.

Sources: Roache, J. Fluids Eng. 116 (1994) 405–413; Celik et al., J. Fluids Eng. 130 (2008) 078001 (order);
ASME V&V 20-2009; Eça & Hoekstra, J. Comput. Phys. 262 (2014) 104–130 (all pairs). Lengths in metres.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations, pairwise
from typing import Any

import numpy as np

from fem_reference import solve
from fem_reference.edge_layer import NOTHING, UnresolvedLayers, unresolved
from fem_reference.surface.borders import has_corners, has_lines
from fem_reference.surface.mesh import Elements, divisions
from sheetbench.answers.solution import Solution
from sheetbench.errors import BadInput
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.composition import own_patches
from sheetbench.scenes.objects.obstacles import Cylinder
from sheetbench.scenes.objects.supports import Point, place, points_overconstrain

TWO_MESH_FACTOR = 3.0  # factor of e in the bar by two meshes
LEAST_ORDER, ASSUMED_ORDER = 0.5, 2.0
BY_LAYER = 2.0  # loss of order where none of the layer is resolved
TWIST = 0.3  # the largest share of η that counts
MESHES = (1.0, 0.75, 0.5)  # elements, relative to the requested number
ROUNDING = 1e-9  # relative to the largest answer
IN_ROWS, FITTED = 3.0, 2.0  # largest order p on meshes of rows, and on others or over a cylinder
FIBRES, ROUGH, HELD_CORNER, PINNED = 2.5, 1.5, 1.0, 0.7  # where the solution is less smooth
NEIGHBOURS = 0.35  # c


def largest_order(scene: Scene) -> float:
    """Return the largest order p of a scene's meshes of quadratic elements."""
    points = [support for support in scene.supports if isinstance(support, Point)]
    others = [support for support in scene.supports if not isinstance(support, Point)]
    parts = [shape for support in others if (shape := place(support)) is not None]
    touched = any(not isinstance(obstacle, Cylinder) for obstacle in scene.obstacles)
    applies = {
        FITTED: not has_lines(scene) or scene.obstacles,
        FIBRES: scene.material.kind == "orthotropic",
        ROUGH: touched or points or has_corners(scene, [patch.shape for patch in own_patches(scene)]),
        HELD_CORNER: parts and has_corners(scene, parts),
        PINNED: points_overconstrain(scene.supports, bool(scene.actuators)),
    }
    return min([IN_ROWS, *(order for order, at_most in applies.items() if at_most)])


@dataclass(frozen=True)
class Uncertainty:
    """Answers f₁ (n, k) with their error bars; sizes: mesh sizes, the finest first. order: observed, nan
    where there is none; bar: U; trusted: the order is at least ½, or nothing changed; converging: whether the
    field, in root mean square, changes less between the two finer meshes than between the two coarser, or not
    at all, whatever single components do."""

    sizes: tuple[float, ...]
    answer: np.ndarray
    extrapolated: np.ndarray
    order: np.ndarray
    bar: np.ndarray
    trusted: np.ndarray
    converging: bool

    @property
    def error(self) -> float:
        """Largest bar over the largest answer, the measure of error of the whole field."""
        size = float(np.max(np.abs(self.answer), initial=0.0))
        return float(np.max(self.bar, initial=0.0)) / size if size > 0.0 else 0.0

    @property
    def overall_order(self) -> float:
        """Observed order of the component with the largest bar among components with an order, else nan."""
        valid = np.isfinite(self.order)
        return float(self.order[valid][np.argmax(self.bar[valid])]) if valid.any() else float("nan")


def coarser(elements: Elements) -> list[Elements]:
    """Return the meshes to solve on, the requested one first, as numbers along the shorter side or pairs."""

    counts = (elements,) if isinstance(elements, int) else elements
    meshes: Any = dict.fromkeys(tuple(max(1, round(n * share)) for n in counts) for share in MESHES)
    return [mesh[0] for mesh in meshes] if isinstance(elements, int) else list(meshes)


def mesh_size(scene: Scene, elements: Elements) -> float:
    """Return the mean size of an element [m]."""
    along_x, along_y = divisions(scene.sheet, elements)
    return float(np.sqrt(np.prod(scene.sheet.lengths) / (along_x * along_y)))


def solve_with_bar(
    scene: Scene, points: np.ndarray, model: str = "shell", elements: Elements = 16, **options: Any
) -> tuple[Solution, Uncertainty | None]:
    """Return a reference's answer and the uncertainty of its displacement (n, 3) [m] at plan points (n, 2)
    [m]. Solves on `coarser(elements)`; the uncertainty is None where fewer than two of the meshes have an
    equilibrium."""
    solutions = [solve(scene, model, elements=n, **options) for n in coarser(elements)]
    sizes = [mesh_size(scene, n) for n in coarser(elements)]
    return solutions[0], of_solutions(scene, solutions, sizes, points)


def of_solutions(
    scene: Scene, solutions: Sequence[Solution], sizes: Sequence[float], points: np.ndarray
) -> Uncertainty | None:
    """Return the uncertainty of solutions by mesh size, finest first, or None (see `solve_with_bar`)."""
    comparable = [(one, size) for one, size in zip(solutions, sizes, strict=True) if one.comparable]
    usable = [(one.displacement(points), size, unresolved(scene, one.settings)) for one, size in comparable]
    if len({size for _, size, _ in usable}) < 2 or usable[0][1] != sizes[0]:
        return None
    answers, of_sizes, layers = zip(*usable, strict=True)
    return estimate(answers, of_sizes, layers, largest_order(scene))


def of_answers(scene: Scene, answers: Sequence[np.ndarray], meshes: Sequence[Elements]) -> Uncertainty:
    """Return the bars of answers (n, k) on given numbers of elements, finest first, without the layer's
    part."""
    return estimate(answers, [mesh_size(scene, n) for n in meshes], largest=largest_order(scene))


def estimate(
    answers: Sequence[np.ndarray],
    sizes: Sequence[float],
    layers: Sequence[UnresolvedLayers] = (),
    largest: float = IN_ROWS,
) -> Uncertainty:
    """Return the bars of answers (n, k) on two or three meshes of rising size. layers: the unresolved layer
    of each mesh, none by default; largest: bound of the order p. The first of several meshes of one size
    counts (¾ and ½ of few elements). Raises BadInput for other numbers of answers."""
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
    largest = min(largest, IN_ROWS - BY_LAYER * layers[0].share)
    if len(answers) == 2:
        order, trusted, converging = np.full(fine.shape, np.nan), rounding, bool(rounding.all())
        field_order, weight, neighbours = min(ASSUMED_ORDER, largest), TWO_MESH_FACTOR, 0.0
        change = step / (ratio**field_order - 1.0)
    else:
        coarse_step = answers[1] - answers[2]
        converging = bool(np.linalg.norm(step) < np.linalg.norm(coarse_step) or rounding.all())
        order = _observed_order(step, coarse_step, ratio, sizes[2] / sizes[1])
        order[rounding] = np.nan
        trusted = rounding | (order >= LEAST_ORDER)
        orders = np.where(order >= LEAST_ORDER, order, np.inf)[~rounding]  # no order counts as high
        field_order, weight, neighbours = largest, 1.0, NEIGHBOURS
        if len(orders):
            field_order = min(float(np.median(orders)), largest)
        change = np.where(trusted, step / (ratio ** np.where(trusted, order, 1.0) - 1.0), 0.0)
    error = _by_pairs(answers, sizes, field_order) + _by_layer(answers, layers)
    bar = weight * error + neighbours * _relative_error(error, fine) * np.abs(fine)
    bar, extrapolated = np.where(rounding, spread, bar), np.where(rounding, fine, fine + change)
    return Uncertainty(tuple(sizes), fine, extrapolated, order, bar, trusted, converging)


def _by_pairs(answers: Sequence[np.ndarray], sizes: Sequence[float], order: float) -> np.ndarray:
    """Return the largest error (n, k) of the finest answer that any pair of meshes indicates."""
    pairs = combinations(zip(answers, sizes, strict=True), 2)
    errors = [np.abs(f - g) * sizes[0] ** order / (k**order - h**order) for (f, h), (g, k) in pairs]
    return np.asarray(np.max(errors, axis=0))


def _by_layer(answers: Sequence[np.ndarray], layers: Sequence[UnresolvedLayers]) -> np.ndarray:
    """Return the error (n, k) of the finest answer by its unresolved part of the layer."""
    least, most = layers[0].stiffening, layers[-1].stiffening
    at_most = TWIST * least * np.abs(answers[0])
    if most <= least:
        return at_most
    return np.asarray(np.minimum(at_most, np.abs(answers[0] - answers[-1]) * least / (most - least)))


def _relative_error(error: np.ndarray, answer: np.ndarray) -> np.ndarray:
    """Return ē (k,), the relative error of each direction over all points."""
    size = np.sqrt(np.sum(answer**2, axis=0))
    return np.divide(np.sqrt(np.sum(error**2, axis=0)), size, out=np.zeros_like(size), where=size > 0.0)


def _observed_order(fine: np.ndarray, coarse: np.ndarray, ratio: float, next_ratio: float) -> np.ndarray:
    """Return p of steps f₁ − f₂ and f₂ − f₃; nan where they oscillate, at most 0 where they do not shrink."""
    with np.errstate(divide="ignore", invalid="ignore"):
        quotient = coarse / fine
        logarithm = np.log(np.where(quotient > 0.0, quotient, np.nan))
        order = logarithm / np.log(ratio)
        for _ in range(50):  # a fixed point; one step where the ratios are equal
            order = (logarithm + np.log((ratio**order - 1.0) / (next_ratio**order - 1.0))) / np.log(ratio)
    return order
