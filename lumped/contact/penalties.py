"""How soft the contact of a lattice begins (`sheetbench.numerics.continuation.stiffening`)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from lumped.contact.contact import Contact

if TYPE_CHECKING:
    from lumped.statics.problem import Problem


class ContactPenalties:
    """The penalties of a problem's contacts. A scene with an obstacle thinner than a cell begins stiff: a
    soft one would be walked through."""

    def __init__(self, problem: Problem):
        self._contacts = [item for item in problem.items if isinstance(item, Contact)]
        self._thin = any(one.surface.radius < one.cell for one in self._contacts)
        force = problem.external(np.zeros_like(problem.loads.dead), 1.0)
        self._force, self._size = float(np.abs(force).sum()), problem.size
        self._travel = float(np.abs(problem.prescribed(1.0)).max())

    @property
    def soft(self) -> float | None:
        """The share of the stiffness to begin with, for the load of the scene."""
        if self._thin or not self._contacts:
            return None
        return min(
            one.soft_share(self._force / one.area.sum(), self._travel, self._size) for one in self._contacts
        )

    def soften(self, share: float) -> None:
        """Give the contacts a share of their stiffness."""
        for one in self._contacts:
            one.share = share
