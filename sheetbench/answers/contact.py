"""State of the contact with an obstacle, as an answer contains it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from sheetbench.answers.table import NUMBER
from sheetbench.scenes.objects.obstacles import TOUCH

DEEP = 1e-3  # penetration over the thickness from which on a note says so
UNDECIDED = 1e-6  # of the thickness, or 1e-3 of the deepest: points as near as that to touching


@dataclass(frozen=True)
class ContactState:
    """area: that touches [m²]; penetration: the deepest, over the thickness; points: how many, or parts of
    cells, touch; undecided: how many are so near to touching that the tangent may belong to either state."""

    area: float
    penetration: Annotated[float, NUMBER(".2g", "penetration/h")]
    points: int
    undecided: int

    @classmethod
    def of(cls, depth: np.ndarray, area: np.ndarray) -> ContactState:
        """Return the state of points or parts of cells: depths over the thickness, δ₀ included, < 0 of a
        clear one, and areas that touch."""
        over, touching = depth - TOUCH, depth > 0.0
        deepest = float(over.max(initial=0.0))
        near = np.abs(over) <= min(UNDECIDED, 1e-3 * deepest)
        return cls(float(area[touching].sum()), deepest, int(touching.sum()), int(near.sum()))

    @property
    def notes(self) -> list[str]:
        """What is doubtful, a clause each."""
        deep = f"the sheet is pressed in by {self.penetration:.2g} of its thickness"
        near = f"{self.undecided} points are about to touch or to leave: stability undecided"
        return [deep] * (self.penetration > DEEP) + [near] * (self.undecided > 0)
