"""Lattice and reference on the same branch of equilibria, where the scene has several.

Where both are at rest and far apart, the lattice is begun once more in the shell's shape, and else the shell
in the lattice's: what lies at the height z over the mid-surface is on its normal,

    u(x, y, z) = u(x, y) + z (n − e_z).

The model that stays near there has both equilibria, and that answer takes the place of the one on its own
load path. Where neither does, there is no such equilibrium on this grid, or the answers differ for another
reason (`far_apart`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from comparisons.models.resolve import Resolved
from comparisons.models.spec import Elements, Lattice
from comparisons.pictures.plan import on_sheet
from sheetbench.answers.solution import Solution, Status
from sheetbench.scenes import Scene

FAR = 0.2  # of the largest displacement, from which on another branch is looked for
SAME = 0.5  # of the difference, by which an answer begun elsewhere must come nearer
ROUNDING = 1e-9  # of the longer side
STEP = 1e-3  # of the shorter side, over which the mid-surface's slope is taken


def joined(
    lattice: Resolved[Lattice], against: Resolved[Elements], first: Solution, reference: Solution
) -> tuple[Solution, Solution, str] | None:
    """Both answers on one branch, and a sentence; None where they are near each other, where one is not a
    stable equilibrium or alone touches an obstacle, or where neither model has the other's."""
    scene = lattice.scene
    plain = not (lattice.spec.linear or scene.actuators)
    points = scene.probe_points()
    own, right = first.displacement(points), reference.displacement(points)
    if not far(own, right) or not plain or not first.status is reference.status is Status.CONVERGED:
        return None
    if first.touched != reference.touched:
        return None
    import fem_reference
    import lumped

    again = lumped.solve(scene, lattice.springs, near=shape(scene, reference.displacement, first.mesh.points))
    if _on_branch(again, points, right, own):
        return _begun(again, first, reference), reference, _converged_text(first, reference, own, right)
    if reference.model != "shell":
        return None
    begun = {"elements": against.spec.elements, **against.spec.but(branch=None).options}
    again = fem_reference.solve(
        scene, model="shell", near=lambda places: shape(scene, first.displacement, places), **begun
    )
    if _on_branch(again, points, own, right):
        return first, _begun(again, reference, first), _converged_text(reference, first, right, own)
    return None


def far(u: np.ndarray, other: np.ndarray) -> bool:
    """Return whether displacements at the probes (n, 3) [m] are so far from others that branches may
    differ."""
    return bool(np.abs(u - other).max() > FAR * np.abs(other).max())


def _on_branch(again: Solution, points: np.ndarray, there: np.ndarray, here: np.ndarray) -> bool:
    """Return whether an answer is stable, and nearer to one set of displacements at the probes than to
    another."""
    u = again.displacement(points)
    gap = np.abs(there - here).max()
    return again.status is Status.CONVERGED and bool(np.abs(u - there).max() < SAME * gap)


def _begun(again: Solution, before: Solution, other: Solution) -> Solution:
    """Return a model's answer begun in another's shape, in the place of its own."""
    settings = {**before.settings, "begun": other.model}
    return replace(again, model=before.model, settings=settings, setup_seconds=before.setup_seconds)


def _converged_text(moved: Solution, kept: Solution, own: np.ndarray, other: np.ndarray) -> str:
    own_path = f"on its own load path {moved.model} comes to {_largest(own)} mm"
    return (
        f"{moved.model} and {kept.model} came to different branches of equilibria: "
        f"{own_path} where {kept.model} comes to {_largest(other)} mm. "
        f"Begun in the shape of {kept.model}, {moved.model} has that equilibrium too, and is shown there."
    )


Field = Callable[[np.ndarray], np.ndarray]  # displacement (n, 3) [m] at plan points (n, 2) [m]


def shape(scene: Scene, displacement: Field, places: np.ndarray) -> np.ndarray:
    """Displacement (n, 3) [m] of what lies at (n, 3) [m] in the flat sheet, in a mid-surface's shape."""
    plan = on_sheet(scene, places[:, :2])
    slopes = []
    for axis in np.eye(3)[:2]:
        step = STEP * min(scene.sheet.lengths) * axis[:2]
        low, high = _beside(scene, plan, -step), _beside(scene, plan, step)
        distance = np.abs(high - low).sum(axis=1)
        change = displacement(high) - displacement(low)
        slopes.append(change / np.where(distance > 0.0, distance, 1.0)[:, None] + axis)
    normal = np.cross(*slopes)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    moved: np.ndarray = displacement(plan) + places[:, 2:] * (normal - [0.0, 0.0, 1.0])
    return moved


def _beside(scene: Scene, plan: np.ndarray, step: np.ndarray) -> np.ndarray:
    """The plan points (n, 2) [m] a step on, or themselves where that is off the sheet."""
    there = plan + step
    off = np.abs(on_sheet(scene, there) - there).max(axis=1) > ROUNDING * max(scene.sheet.lengths)
    return np.where(off[:, None], plan, there)


def _largest(u: np.ndarray) -> str:
    return f"{1e3 * float(u.flat[np.abs(u).argmax()]):.3g}"
