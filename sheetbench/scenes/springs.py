"""Spring constants of a lattice, as data: the optional [springs] and [dampers] tables of a scene.

Only the lumped model reads them. Axial, diagonal, vertical, cross and cross_diagonal are link
stiffnesses [N/m] (the seed's ka, kd, kz, kdT, kddT); area and mid_area are area-spring stiffnesses
[N/m], energy ½ k (a/a0 − 1)² a0 per cell of a layer and of the mid-surface. Strain springs [N/m], energy
½ k ε² a0, make up what those cannot on cells longer than wide: shear and mid_shear against the in-plane shear
of a layer's and of the mid-surface's cells, mid_stretch against the stretching of the mid-surface along x, y.
"""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Discriminator, Tag

from sheetbench.scenes.quantities import Frozen, NonNegative, Number, Positive, Unit


class PerDirection(Frozen):
    """One value per direction: along x, y and (where it has a meaning) z."""

    x: NonNegative
    """For springs along x."""
    y: NonNegative
    """For springs along y."""
    z: NonNegative | None = None
    """For springs along z."""


def _form(value: Any) -> str:
    return "per direction" if isinstance(value, dict | PerDirection) else "one number"


PerFamily = Annotated[
    Annotated[NonNegative, Tag("one number")] | Annotated[PerDirection, Tag("per direction")],
    Discriminator(_form),
]
Stiffness = Annotated[PerFamily, Unit("N/m")]
Damping = Annotated[PerFamily, Unit("N·s/m")]


class SpringSet(Frozen):
    """Stiffness of each family [N/m] and the distance of neighbouring layers [m]."""

    axial: Stiffness
    """Links along x and y within a layer."""
    diagonal: Stiffness
    """Diagonals of a layer's cells."""
    vertical: Stiffness
    """Links between the layers, across the thickness."""
    cross: Stiffness
    """Links between the layers along x and y: diagonals of the upright faces."""
    cross_diagonal: Stiffness
    """Space diagonals of the cells."""
    area: Annotated[Number, Unit("N/m")] = 0.0
    """Area springs of a layer's cells, energy ½ k (a/a0 − 1)² a0; < 0 is allowed while the cell is stable."""
    mid_area: Annotated[Number, Unit("N/m")] = 0.0
    """Area springs of the mid-surface's cells."""
    shear: Annotated[NonNegative, Unit("N/m")] = 0.0
    """Strain springs against the in-plane shear of a layer's cells, energy ½ k γ² a0."""
    mid_shear: Annotated[Number, Unit("N/m")] = 0.0
    """Strain springs against the in-plane shear of the mid-surface's cells."""
    mid_stretch: Stiffness = 0.0
    """Strain springs against the stretching of the mid-surface along x and y."""
    layer_distance: Annotated[Positive, Unit("m")]
    """Distance of neighbouring layers; of two layers, about the sheet's thickness."""


class DamperSet(Frozen):
    """Damping of each family [N·s/m]."""

    axial: Damping = 0.0
    """Dampers along the links along x and y within a layer."""
    diagonal: Damping = 0.0
    """Dampers along the diagonals of a layer's cells."""
    vertical: Damping = 0.0
    """Dampers along the links between the layers."""
    cross: Damping = 0.0
    """Dampers along the diagonals of the upright faces."""
    cross_diagonal: Damping = 0.0
    """Dampers along the space diagonals."""
