"""Spring constants of a lattice, as data: the optional [springs] and [dampers] tables of a scene.

Only the lumped model reads them. Axial, diagonal, vertical, cross and cross_diagonal are link
stiffnesses [N/m] (the seed's ka, kd, kz, kdT, kddT); area and mid_area are area-spring stiffnesses
[N/m], energy ½ k (a/a0 − 1)² a0 per cell of a layer and of the mid-surface. Strain springs [N/m], energy
½ k ε² a0, make up what those cannot on cells longer than wide: shear and mid_shear against the in-plane shear
of a layer's and of the mid-surface's cells, mid_stretch against the stretching of the mid-surface along x, y.
"""

from __future__ import annotations

from sheetbench.scenes.quantities import Frozen, NonNegative, Number, Positive


class PerDirection(Frozen):
    """One value per direction: along x, y and (where it has a meaning) z."""

    x: NonNegative
    y: NonNegative
    z: NonNegative | None = None


Stiffness = NonNegative | PerDirection


class SpringSet(Frozen):
    """Stiffness of each family [N/m] and the distance of neighbouring layers [m]."""

    axial: Stiffness
    diagonal: Stiffness
    vertical: Stiffness
    cross: Stiffness
    cross_diagonal: Stiffness
    area: Number = 0.0
    mid_area: Number = 0.0
    shear: NonNegative = 0.0
    mid_shear: Number = 0.0
    mid_stretch: Stiffness = 0.0
    layer_distance: Positive


class DamperSet(Frozen):
    """Damping of each family [N·s/m]."""

    axial: Stiffness = 0.0
    diagonal: Stiffness = 0.0
    vertical: Stiffness = 0.0
    cross: Stiffness = 0.0
    cross_diagonal: Stiffness = 0.0
