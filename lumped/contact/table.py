"""The contact of a lattice with its obstacles in plain arrays, for other programs (`lumped.description`)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lumped.contact.contact import TOUCH, Contact

KINDS = ("plane", "sphere", "cylinder")
PRESSED = 0.1  # of the thickness, how deep


@dataclass(frozen=True)
class ContactTable:
    """Obstacles: kind (o,), numbers of `KINDS`; position (o, 3) [m], where each is at last; direction (o, 3),
    a plane's normal or a cylinder's axis, of unit length, 0 of a sphere; radius (o,) [m], 0 of a plane.

    Points: obstacle (p,), corners (p, 4, layers), the masses whose mean each corner is, weights (p, 4) of the
    corners, area (p,) [m²], offset (p,) [m] and stiffness (p,) [N/m³]. With φ the distance of a point from
    its obstacle each has the energy ½ stiffness area ⟨offset − φ⟩².
    """

    kind: np.ndarray
    position: np.ndarray
    direction: np.ndarray
    radius: np.ndarray
    obstacle: np.ndarray
    corners: np.ndarray
    weights: np.ndarray
    area: np.ndarray
    offset: np.ndarray
    stiffness: np.ndarray


def contact_table(contacts: Sequence[Contact], layers: int) -> ContactTable:
    """Return the table of contacts of a lattice of so many layers."""
    shapes = [one.obstacle for one in contacts]
    places = [np.array(shape.position) + shape.displacement(1.0) for shape in shapes]
    parts = [(np.empty(0, int), np.empty((0, 4, layers), int), np.empty((0, 4)), *[np.empty(0)] * 3)]
    for number, one in enumerate(contacts):
        (patches, points), corners = one.area.shape, one.nodes.reshape(len(one.nodes), -1, layers)
        weights = one.weights.reshape(points, -1, layers).sum(axis=2)
        missing = 4 - corners.shape[1]  # of a column of masses on a plane
        corners = np.concatenate([corners, *[corners] * missing], axis=1)
        weights = np.pad(weights, ((0, 0), (0, missing)))
        parts.append(
            (
                np.full(one.area.size, number),
                np.repeat(corners, points, axis=0),
                np.tile(weights, (patches, 1)),
                *(v.ravel() for v in (one.area, (0.5 + TOUCH) * one.thickness, one.full)),
            )
        )
    return ContactTable(
        np.array([KINDS.index(shape.kind) for shape in shapes], dtype=int),
        np.array(places).reshape(-1, 3),
        np.array([shape.direction for shape in shapes]).reshape(-1, 3),
        np.array([getattr(shape, "radius", 0.0) for shape in shapes]),
        *(np.concatenate(part) for part in zip(*parts, strict=True)),
    )


def pressed(displacement: np.ndarray, positions: np.ndarray, contact: Contact) -> np.ndarray:
    """Return the displacement moved as a whole until the point nearest to the obstacle is `PRESSED`
    thicknesses deep."""
    origin = np.array(contact.obstacle.position) + contact.obstacle.displacement(1.0)
    at = contact.surface.at(contact.weights @ (positions + displacement - origin)[contact.nodes])
    height = at.distance - (0.5 - PRESSED) * contact.thickness
    lowest = np.unravel_index(height.argmin(), height.shape)
    moved: np.ndarray = displacement - height[lowest] * at.normal[lowest]
    return moved
