"""Lattice and reference on one branch of equilibria, for scenes with several branches.

If both models are at rest but differ by more than DIFFERENT, the lattice is solved once more from the shell's
shape, and if necessary the shell from the lattice's. Points at the height z over the mid-surface start on its
normal,

    u(x, y, z) = u(x, y) + z (n − e_z).

A model that stays near this shape has both equilibria, and the new answer replaces the one on its own load
path. If neither stays, this grid has no corresponding equilibrium, or the answers differ for another reason
(`far_apart`).
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from comparisons.models.resolve import Resolved
from comparisons.models.spec import Elements, Lattice
from comparisons.pictures.plan import on_sheet
from sheetbench.answers.solution import Solution, Status
from sheetbench.scenes import Scene

DIFFERENT = 0.2  # of the largest displacement: larger differences may mean another branch
SAME = 0.5  # of the difference: the new answer must be nearer than this
ROUNDING = 1e-9  # of the longer side
STEP = 1e-3  # of the shorter side: difference quotients of the mid-surface


def on_one_branch(
    lattice: Resolved[Lattice], elements: Resolved[Elements], first: Solution, reference: Solution
) -> tuple[Solution, Solution, str] | None:
    """Return both answers on one branch and a sentence, or None.

    The result is None for answers near each other, if one is no stable equilibrium or alone touches an
    obstacle, and for models without each other's equilibrium.
    """
    scene = lattice.scene
    supported = not (lattice.spec.linear or scene.actuators)
    points = scene.probe_points()
    first_u, reference_u = first.displacement(points), reference.displacement(points)
    converged = first.status is reference.status is Status.CONVERGED
    if not may_differ(first_u, reference_u) or not supported or not converged:
        return None
    if first.touched != reference.touched:
        return None
    import fem_reference
    import lumped

    again = lumped.solve(scene, lattice.springs, near=shape(scene, reference.displacement, first.mesh.points))
    if _on_branch(again, points, reference_u, first_u):
        text = _branch_text(first, reference, first_u, reference_u)
        return _restarted(again, first, reference), reference, text
    if reference.model != "shell":
        return None
    options = {"elements": elements.spec.elements, **elements.spec.but(branch=None).options}
    again = fem_reference.solve(
        scene, model="shell", near=lambda places: shape(scene, first.displacement, places), **options
    )
    if _on_branch(again, points, first_u, reference_u):
        text = _branch_text(reference, first, reference_u, first_u)
        return first, _restarted(again, reference, first), text
    return None


def may_differ(u: np.ndarray, other: np.ndarray) -> bool:
    """Return whether displacements at the probes (n, 3) [m] differ so much that branches may differ."""
    return bool(np.abs(u - other).max() > DIFFERENT * np.abs(other).max())


def _on_branch(again: Solution, points: np.ndarray, target: np.ndarray, previous: np.ndarray) -> bool:
    """Return whether an answer is stable, and nearer to the displacements `target` than to `previous`."""
    u = again.displacement(points)
    gap = np.abs(target - previous).max()
    return again.status is Status.CONVERGED and bool(np.abs(u - target).max() < SAME * gap)


def _restarted(again: Solution, previous: Solution, other: Solution) -> Solution:
    """Return a model's answer from another model's shape, in place of its previous answer."""
    settings = {**previous.settings, "begun": other.model}
    return replace(again, model=previous.model, settings=settings, setup_seconds=previous.setup_seconds)


def _branch_text(changed: Solution, other: Solution, previous_u: np.ndarray, other_u: np.ndarray) -> str:
    own_path = f"on its own load path {changed.model} comes to {_largest(previous_u)} mm"
    return (
        f"{changed.model} and {other.model} came to different branches of equilibria: "
        f"{own_path} where {other.model} comes to {_largest(other_u)} mm. Started in the shape of "
        f"{other.model}, {changed.model} reaches that equilibrium too; this is the one shown."
    )


Field = Callable[[np.ndarray], np.ndarray]  # displacement (n, 3) [m] at plan points (n, 2) [m]


def shape(scene: Scene, displacement: Field, places: np.ndarray) -> np.ndarray:
    """Return displacements (n, 3) [m] of points (n, 3) [m] of the flat sheet in a mid-surface's shape."""
    plan = on_sheet(scene, places[:, :2])
    slopes = []
    for axis in np.eye(3)[:2]:
        step = STEP * min(scene.sheet.lengths) * axis[:2]
        low, high = _shifted(scene, plan, -step), _shifted(scene, plan, step)
        distance = np.abs(high - low).sum(axis=1)
        change = displacement(high) - displacement(low)
        slopes.append(change / np.where(distance > 0.0, distance, 1.0)[:, None] + axis)
    normal = np.cross(*slopes)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    out: np.ndarray = displacement(plan) + places[:, 2:] * (normal - [0.0, 0.0, 1.0])
    return out


def _shifted(scene: Scene, plan: np.ndarray, step: np.ndarray) -> np.ndarray:
    """Return plan points (n, 2) [m] shifted by a step; points that would leave the sheet stay."""
    shifted = plan + step
    off = np.abs(on_sheet(scene, shifted) - shifted).max(axis=1) > ROUNDING * max(scene.sheet.lengths)
    return np.where(off[:, None], plan, shifted)


def _largest(u: np.ndarray) -> str:
    return f"{1e3 * float(u.flat[np.abs(u).argmax()]):.3g}"
