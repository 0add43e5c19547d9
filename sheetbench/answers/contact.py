"""Contact with an obstacle in an answer."""

from dataclasses import dataclass
from typing import Annotated, Self

import numpy as np

from sheetbench.answers.table import NUMBER
from sheetbench.scenes.objects.obstacles import TOUCH

DEEP = 1e-3  # penetration over the thickness above which there is a note
UNDECIDED = 1e-6  # of the thickness, or 1e-3 of the deepest: distance of undecided points from touching


@dataclass(frozen=True)
class ContactState:
    """Contact of a sheet with an obstacle. area: in contact [m²]; pressure: its mean there [Pa].
    penetration: the deepest, over the thickness. points: number of points, or parts of cells, in contact.
    undecided: number of points so close to touching that either state may determine the tangent."""

    area: float
    pressure: float
    penetration: Annotated[float, NUMBER(".2g", "penetration/h")]
    points: int
    undecided: int

    @classmethod
    def of(cls, depth: np.ndarray, area: np.ndarray, load: np.ndarray) -> Self:
        """Return the state of contact from the depths of points or parts of cells. depth: over the thickness,
        with δ₀, < 0 without contact. area: of each in contact [m²]; load: on them [N]."""
        over, touching = depth - TOUCH, depth > 0.0
        deepest = float(over.max(initial=0.0))
        near = np.abs(over) <= min(UNDECIDED, 1e-3 * deepest)
        covered = float(area[touching].sum())
        pressure = float(load.sum()) / covered if covered > 0.0 else 0.0
        return cls(covered, pressure, deepest, int(touching.sum()), int(near.sum()))

    @property
    def notes(self) -> list[str]:
        """Return clauses on deep penetration and on points that barely touch."""
        deep = f"the penetration is {self.penetration:.2g} of the thickness"
        near = f"{self.undecided} points barely touch or barely do not: stability undecided"
        return [deep] * (self.penetration > DEEP) + [near] * (self.undecided > 0)
