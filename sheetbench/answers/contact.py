"""What an answer says of the contact with an obstacle."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Annotated, Any

from sheetbench.answers.table import NUMBER
from sheetbench.scenes.meaning.distances import obstacles_by_name
from sheetbench.scenes.objects.obstacles import SLIP_SPEED

if TYPE_CHECKING:
    from sheetbench.scenes.scene import Scene

DEEP = 1e-3  # penetration over the thickness from which on a note says so


@dataclass(frozen=True)
class ContactState:
    """area: of the points that touch [m²]; penetration: the deepest, over the thickness; points: how many
    touch; undecided: how many are so near to touching that the tangent may be that of either."""

    area: float
    penetration: Annotated[float, NUMBER(".2g", "penetration/h")]
    points: int
    undecided: int

    def document(self) -> dict[str, Any]:
        """Return the JSON object."""
        return asdict(self)


def friction_notes(scene: Scene) -> list[str]:
    """Return what a model of friction cannot do, a clause an obstacle that rubs."""
    return [
        f"{name}: friction is regular below {1e3 * SLIP_SPEED:g} mm/s, so that what should stick creeps"
        for name, obstacle in obstacles_by_name(scene).items()
        if obstacle.friction > 0.0
    ]


def contact_notes(contacts: Mapping[str, ContactState]) -> list[str]:
    """Return what is doubtful of contacts, a clause each."""
    notes = []
    for name, contact in contacts.items():
        if contact.penetration > DEEP:
            notes.append(
                f"{name}: the sheet is pressed in by {contact.penetration:.2g} of its thickness, where a "
                "point's force is spread by the grid alone"
            )
        if contact.undecided:
            notes.append(
                f"{name}: {contact.undecided} points are about to touch or to leave: stability undecided"
            )
    return notes
