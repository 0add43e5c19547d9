"""A payload on the sheet: a mass at a point, or a body spread evenly over a part of it.

It has weight under gravity and inertia in motion, and no stiffness. A body spread over a part of the area A
turns there with the director d of the sheet, at first e_z: with the moments of inertia I about x and y that
it has beside those of its mass in the mid-surface, ω = d × ḋ,

    T = 1/2A ∫ m |φ̇|² + Iyy ḋ_x² + Ixx ḋ_y² + max(Ixx, Iyy) ḋ_z² dA

of small turns from the flat sheet, and of any turn of a body that is round about its normal, Ixx = Iyy, or
that turns about the axis of the larger one alone. Being of constant coefficients in the coordinates it leaves
the mass matrix constant. Of Izz nothing is taken: a sheet has no couple about its normal. At a point there is
no moment of inertia: the turn of a plate's director under a moment there grows without bound as the mesh is
refined, like the logarithm of its elements (Mindlin), so that no frequency would converge. Source: the
kinetic energy of a rigid body; e.g. Wittenburg, Dynamics of Multibody Systems, 2008, 3.3.
"""

from collections.abc import Iterator
from typing import Annotated

import numpy as np
from pydantic import Field

from sheetbench.scenes.objects.quantities import Frozen, NonNegative, PlanPoint, Positive, Unit
from sheetbench.scenes.objects.shapes import Shape


class Mass(Frozen):
    """A payload: a mass at a point of the mid-surface, or a body spread evenly over a part of it."""

    mass: Annotated[Positive, Unit("kg")]
    """Of the whole payload; it weighs under gravity and is inert in motion."""
    at: Annotated[PlanPoint, Unit("m")] | None = None
    """Plan point [x, y] of the undeformed sheet where it is; or `where`."""
    where: Shape | None = None
    """In place of `at`: the part of the sheet over which it is spread evenly, in the mid-surface."""
    inertia: Annotated[tuple[NonNegative, NonNegative, NonNegative], Unit("kg·m²")] | None = Field(
        default=None, kw_only=True
    )
    """With `where`: moments of inertia about x, y and z beside those of its mass in the mid-surface, spread
    evenly as it is, of a body that turns with the sheet's normal; that about z, the normal, takes no part."""

    def _faults(self) -> Iterator[object]:
        one = "give one of at, a point [x, y], and where, a part of the sheet"
        yield (self.at is None) == (self.where is None) and one
        point = (
            "inertia: at a point the sheet gives way to a moment without bound, and no frequency converges"
        )
        yield self.inertia and self.at and f"{point}; give where, the part that turns with the body"

    @property
    def of_director(self) -> np.ndarray:
        """What resists the components of ḋ, (3,) [kg m²]."""
        x, y, _ = self.inertia or (0.0, 0.0, 0.0)
        return np.array([y, x, max(x, y)])
