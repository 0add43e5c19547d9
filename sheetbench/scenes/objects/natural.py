"""Natural strains and curvatures and temperatures, by which a sheet is not flat and free of stress at rest.

A free part of the sheet has the stretch U = 1 + e0 − z k0 (2 × 2, symmetric) at the height z over the
mid-surface, so that k0 > 0 curls it towards +z. Strain and curvature of a rise of temperature ΔT + z ΔT′
follow from zero forces and moments of the layers, with C, α of each:

    ∫ C (e0 − z k0 − α (ΔT + z ΔT′)) (1, z) dz = 0;    of one layer e0 = α ΔT,   k0 = −α ΔT′.

Source: Timoshenko, J. Opt. Soc. Am. 11 (1925) 233, whose formula follows for two isotropic layers.
"""

from collections.abc import Iterator
from typing import Annotated

from pydantic import Field

from sheetbench.scenes.objects.quantities import Number, Unit, Vector3
from sheetbench.scenes.objects.tables import Loading

LARGEST_STRAIN = 0.5
NOTHING = (0.0, 0.0, 0.0)


class Natural(Loading):
    """Strain and curvature of the free sheet, or of a free patch of it."""

    strain: Annotated[Vector3, Unit("")] = NOTHING
    """[exx, eyy, exy] of the mid-surface; > 0 is longer than drawn."""
    curvature: Annotated[Vector3, Unit("1/m")] = NOTHING
    """[kxx, kyy, kxy]; > 0 curls the sheet towards +z."""
    pretension: Annotated[tuple[Number, Number], Unit("N/m")] | None = Field(default=None, kw_only=True)
    """In place of strain: forces per length [Nx, Ny] of the sheet held at its drawn size."""

    @property
    def nonzero(self) -> bool:
        """Return whether a component is not zero."""
        return any((*self.strain, *self.curvature, *(self.pretension or ())))

    def _faults(self) -> Iterator[object]:
        yield self.pretension and any(self.strain) and "strain and pretension: give one of them"
        xx, yy, xy = (self.last_factor * component for component in self.strain)
        most = f"strain = [{xx:g}, {yy:g}, {xy:g}]: at most {LARGEST_STRAIN:g} either way"
        yield max(abs(xx), abs(yy), abs(xy)) > LARGEST_STRAIN and most


class Temperature(Loading):
    """Temperature above the one at which the sheet is flat and free of stress (`expansion`)."""

    change: Annotated[Number, Unit("K")] = 0.0
    """Difference in the middle of the thickness; > 0 is warmer."""
    gradient: Annotated[Number, Unit("K/m")] = 0.0
    """Gradient along z; > 0 is warmer on the upper face."""

    @property
    def nonzero(self) -> bool:
        """Return whether it differs from zero."""
        return bool(self.change or self.gradient)
