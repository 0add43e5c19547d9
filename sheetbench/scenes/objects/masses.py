"""A payload on the sheet: a mass at a point, or a body spread evenly over a part of it.

It has weight under gravity and inertia in motion, and no stiffness. A body spread over a part of the area A
turns with the director d of the sheet, at first e_z. Its kinetic energy is, with ω = d × ḋ and its moments of
inertia Ixx and Iyy beyond the contribution of its mass spread in the mid-surface,

    T = 1/2A ∫ m |φ̇|² + Iyy ḋ_x² + Ixx ḋ_y² + max(Ixx, Iyy) ḋ_z² dA

for small turns from the flat sheet, and for any turn if the body is round about its normal, Ixx = Iyy, or
turns about the axis of the larger moment alone. Its coefficients are constant in the coordinates, and so is
the mass matrix. Izz is ignored: a sheet has no couple about its normal. A mass at a point has no moment of
inertia: the turn of a plate's director under a moment at a point grows without bound as the mesh is
refined, like the logarithm of the element size (Mindlin), so that no frequency would converge. Source: the
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
    """Mass of the whole payload; it weighs under gravity and is inert in motion."""
    at: Annotated[PlanPoint, Unit("m")] | None = None
    """Plan point [x, y] of the undeformed sheet where the mass is; or `where`."""
    where: Shape | None = None
    """In place of `at`: the part of the sheet over which the mass is spread evenly, in the mid-surface."""
    inertia: Annotated[tuple[NonNegative, NonNegative, NonNegative], Unit("kg·m²")] | None = Field(
        default=None, kw_only=True
    )
    """With `where`: moments of inertia about x, y and z of a body that turns with the sheet's normal, beyond
    the contribution of its mass spread in the mid-surface; the moment about z, the normal, is ignored."""

    def _faults(self) -> Iterator[object]:
        one = "give one of at, a point [x, y], and where, a part of the sheet"
        yield (self.at is None) == (self.where is None) and one
        point = "inertia: the rotation of a point under a moment diverges as meshes get finer"
        yield self.inertia and self.at and f"{point}; give where, the part that turns with the body"

    @property
    def of_director(self) -> np.ndarray:
        """Return the director's moment of inertia by component, (3,) [kg m²]."""
        x, y, _ = self.inertia or (0.0, 0.0, 0.0)
        return np.array([y, x, max(x, y)])
