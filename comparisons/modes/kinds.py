"""The kind of a mode of a flat sheet: bending, twist, bending across, in plane.

In plane: most of the mass-weighted square of the displacement is along the sheet. Of the others the
deflection w(x, y) is split by its singular values, w ≈ σ f(along) g(across); g without a change of sign is
bending, one change is twist, more is bending across (chordwise). The axis runs from the supports to the free
edge, along the longer side of a free sheet, and between two supported edges; a sheet held at adjacent edges
has none, and its modes out of plane are all bending.
"""

from __future__ import annotations

from collections import Counter

import numpy as np

from sheetbench.scenes import Scene
from sheetbench.scenes.objects.grid import near_square
from sheetbench.scenes.objects.supports import place

BENDING, TWIST, ACROSS, IN_PLANE = "bending", "twist", "bending across", "in plane"
STILL = 0.05  # of the largest |g|: a change of sign below it is the discretisation's


def kinds(scene: Scene, shapes: np.ndarray, cells: int) -> list[str]:
    """Return the kind of every shape (m, n, 3), sampled at `pairing.cell_centres` of `cells`: bending
    numbered from 1, the others from their second on."""
    axis, named = _axis(scene), list[str]()
    counted = Counter[str]()
    for shape in shapes:
        kind = _kind(shape.reshape(*near_square(scene.sheet, cells), 3), axis)
        counted[kind] += 1
        named.append(kind if kind != BENDING and counted[kind] == 1 else f"{kind} {counted[kind]}")
    return named


def _kind(shape: np.ndarray, axis: int | None) -> str:
    """Return the kind of a shape (nx, ny, 3); axis: 0 for x, 1 for y, None."""
    along, deflection = np.sum(shape[..., :2] ** 2), shape[..., 2]
    if along > np.sum(deflection**2):
        return IN_PLANE
    if axis is None:
        return BENDING
    _, _, across = np.linalg.svd(deflection if axis == 0 else deflection.T, full_matrices=False)
    moving = across[0][np.abs(across[0]) > STILL * np.abs(across[0]).max()]
    changes = int(np.count_nonzero(np.diff(np.sign(moving))))
    return (BENDING, TWIST, ACROSS)[min(changes, 2)]


def _axis(scene: Scene) -> int | None:
    held = {"xy".index(support.edge[0]) for support in scene.supports if place(support) is None}
    if len(held) == 1:
        return held.pop()
    return None if held else int(np.argmax(scene.sheet.lengths))
