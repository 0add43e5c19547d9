"""The contact of a lattice with its obstacles in plain arrays, for other programs (`lumped.description`)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from lumped.contact.contact import Contact
from sheetbench.scenes import Plane
from sheetbench.scenes.objects.obstacles import TOUCH

KINDS = ("plane", "sphere", "cylinder")
POINT = ("obstacle", "corners", "weights", "area", "offset", "stiffness")


def contact_table(contacts: Sequence[Contact], layers: int) -> dict[str, np.ndarray]:
    """Return obstacles and points of contacts of a lattice of so many layers, named as in `lattice.npz`
    (`comparisons.codes.arrays`): with φ the distance of a point from its obstacle each has the energy
    ½ stiffness area ⟨offset − φ⟩²."""
    shapes = [one.obstacle for one in contacts]
    parts = [(np.empty(0, int), np.empty((0, 4, layers), int), np.empty((0, 4)), *[np.empty(0)] * 3)]
    for number, one in enumerate(contacts):
        (patches, points), corners = one.area.shape, one.nodes.reshape(len(one.nodes), -1, layers)
        weights = one.weights.reshape(points, -1, layers).sum(axis=2)
        corners = np.repeat(corners, 4 // corners.shape[1], axis=1)  # of a column of masses on a plane
        weights = np.pad(weights, ((0, 0), (0, 4 - weights.shape[1])))
        place = np.full(one.area.size, number), np.repeat(corners, points, axis=0)
        measures = one.area, (0.5 + TOUCH) * one.thickness, one.full
        parts.append((*place, np.tile(weights, (patches, 1)), *(each.ravel() for each in measures)))
    at = [shape.position + shape.displacement(1.0) for shape in shapes]  # where each is at last
    columns = map(np.concatenate, zip(*parts, strict=True))
    return {
        "obstacle_kind": np.array([KINDS.index(shape.kind) for shape in shapes], dtype=int),
        "obstacle_position": np.array(at).reshape(-1, 3),
        "obstacle_direction": np.array([shape.direction for shape in shapes]).reshape(-1, 3),
        "obstacle_radius": np.array([0.0 if isinstance(one, Plane) else one.radius for one in shapes]),
        **{f"contact_{name}": column for name, column in zip(POINT, columns, strict=True)},
    }
