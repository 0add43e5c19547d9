"""The options of a lattice and of a sheet, declared once for every verb that has them.

A command whose parameter is of the type `LatticeOptions` has --grid, --calibration, --k, --layer-distance and
--grading; with `SpringOptions` the last three, beside lists of grids and calibrations of its own.
`SheetOptions` are --young, --poisson, --thickness, --density and --side.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from comparisons.cli import options
from comparisons.cli.verb import Group

if TYPE_CHECKING:
    from comparisons.models.spec import Lattice


class LatticeGroup(Group):
    """Options by the names of a lattice's settings."""

    @property
    def spec(self) -> Lattice:
        """The lattice that is asked for."""
        from comparisons.models.spec import Lattice  # help does not wait for models

        return Lattice(**vars(self))

    def given(self) -> dict[str, Any]:
        """Return the values by the options' names."""
        return {"--lumped" if k == "grid" else f"--{k.replace('_', '-')}": v for k, v in vars(self).items()}


@dataclass(frozen=True)
class SpringOptions(LatticeGroup):
    """Settings that all lattices of a list have in common."""

    k: options.K = None
    layer_distance: options.LayerDistance = None
    grading: options.Grading = None


@dataclass(frozen=True)
class LatticeOptions(LatticeGroup):
    """The lattice of a verb."""

    grid: options.Grid = None
    calibration: options.Calibration = None
    k: options.K = None
    layer_distance: options.LayerDistance = None
    grading: options.Grading = None


@dataclass(frozen=True)
class SheetOptions(Group):
    """A sheet and its material."""

    young: options.Young = None
    poisson: options.Poisson = None
    thickness: options.Thickness = None
    density: options.Density = None
    side: options.Side = None

    @property
    def values(self) -> dict[str, Any]:
        """Values by the keys of a scene's sheet and material, None where they are not given."""
        from comparisons.models.quantities import sides

        return {key: value for key, value in vars(self).items() if key != "side"} | sides(self.side)
