"""A lattice of links alone, as simulators have it that know springs between two points and nothing else."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from sheetbench.errors import BadInput
from sheetbench.scenes import Scene

if TYPE_CHECKING:
    from lumped import Description

Holds = dict[int, dict[int, float]]  # of a mass: its displacement [m] along each axis held
Mean = tuple[tuple[int, ...], int, float]  # masses, the axis, their mean displacement [m]


def require_links(lattice: Description, simulator: str, means: bool) -> None:
    """Raises BadInput where the lattice has springs that are not between two masses, or loads that are not
    dead; unless the simulator has `means`, also where supports do not hold one mass each."""
    if lattice.cells:
        raise BadInput(
            f"--for {simulator}: has springs between two points alone, and these springs have "
            f"{' and '.join(sorted({table.kind for table in lattice.cells}))} springs of cells; "
            "take --calibration central"
        )
    if not means and held_means(lattice):
        raise BadInput(
            f"--for {simulator}: hinged and held edges hold the mean of their layers, which has no plain "
            "form there; clamped and curved edges only"
        )
    if len(lattice.pressure) or lattice.couples:
        raise BadInput(f"--for {simulator}: pressure and edge moments follow the sheet; dead loads only")


def held_masses(lattice: Description) -> Holds:
    """Supports of one mass each, by mass."""
    found: Holds = {}
    for hold in lattice.holds:
        if len(hold.masses) == 1:
            found.setdefault(hold.masses[0], {})[hold.axis] = hold.displacement
    return found


def held_means(lattice: Description) -> list[Mean]:
    """Supports that hold the mean of several masses: hinged and held edges."""
    return [(hold.masses, hold.axis, hold.displacement) for hold in lattice.holds if len(hold.masses) > 1]


def weight_and_rest(lattice: Description, scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """Return the acceleration of gravity (3,) [m/s²], and the dead forces that are not its own (n, 3) [N]."""
    gravity = np.zeros(3) if scene.gravity is None else np.array(scene.gravity.last_acceleration)
    others = lattice.dead - lattice.mass[:, None] * gravity
    others[np.abs(others) < 1e-12 * np.abs(lattice.dead).max(initial=0.0)] = 0.0
    return gravity, others


def words(values: np.ndarray) -> str:
    """Numbers with all their digits, parted by spaces."""
    return " ".join(map(repr, np.asarray(values).tolist()))
