"""What an answer says of the contact with an obstacle."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import numpy as np

from sheetbench.answers.table import NUMBER
from sheetbench.scenes.meaning.distances import obstacles_by_name
from sheetbench.scenes.objects.obstacles import SLIP_SPEED, TOUCH

if TYPE_CHECKING:
    from sheetbench.scenes.scene import Scene

DEEP = 1e-3  # penetration over the thickness from which on a note says so
UNDECIDED = 1e-6  # of the thickness, or 1e-3 of the deepest: points as near as that to touching


@dataclass(frozen=True)
class ContactState:
    """area: of the points that touch [m²]; penetration: the deepest, over the thickness; points: how many
    touch; undecided: how many are so near to touching that the tangent may be that of either."""

    area: float
    penetration: Annotated[float, NUMBER(".2g", "penetration/h")]
    points: int
    undecided: int

    @classmethod
    def of(cls, depth: np.ndarray, area: np.ndarray) -> ContactState:
        """Return that of points with these depths over the thickness, δ₀ included, < 0 of one that is clear,
        and areas."""
        over, touching = depth - TOUCH, depth > 0.0
        deepest = float(over.max(initial=0.0))
        undecided = int((np.abs(over) <= min(UNDECIDED, 1e-3 * deepest)).sum())
        return cls(float(area[touching].sum()), deepest, int(touching.sum()), undecided)


def friction_notes(scene: Scene) -> list[str]:
    """Return what a model of friction cannot do, a clause an obstacle that rubs."""
    creeps = f"friction is regular below {1e3 * SLIP_SPEED:g} mm/s, so that what should stick creeps"
    return [f"{name}: {creeps}" for name, one in obstacles_by_name(scene).items() if one.friction > 0.0]


def contact_notes(contacts: Mapping[str, ContactState]) -> list[str]:
    """Return what is doubtful of contacts, a clause each."""
    deep = "the sheet is pressed in by {:.2g} of its thickness, where a point's force is spread by the grid"
    near = "{} points are about to touch or to leave: stability undecided"
    found = [(name, one.penetration > DEEP, deep.format(one.penetration)) for name, one in contacts.items()]
    found += [(name, one.undecided > 0, near.format(one.undecided)) for name, one in contacts.items()]
    return [f"{name}: {words}" for name, there, words in found if there]
