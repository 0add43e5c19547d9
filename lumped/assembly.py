"""A lattice with its springs, ready to compute: energy, internal force, tangent over a fixed block pattern.

With precision "single" the internal force is computed from displacements, rest geometry and stiffness kept
in single precision, each link in it, cells in double within themselves; the tangent stays in double.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Literal

import numpy as np

from lumped.actuators import Coupling
from lumped.calibration import Calibration
from lumped.lattice import Lattice, Weights, build
from lumped.natural import with_natural
from lumped.pattern import MassPattern, neighbours, of_grid
from lumped.springs.all_families import AllFamilies, springs_of
from sheetbench.errors import BadInput
from sheetbench.scenes import Sheet
from sheetbench.scenes.meaning.natural_state import NaturalState
from sheetbench.scenes.objects.springs import Distribution

Precision = Literal["double", "single"]


class Assembly:
    """Energy, force and tangent of a calibrated lattice. Displacements and forces are (n, 3) [m], [N].

    springs: the families (`lumped.springs.families`), the central `links` first. inertia: how masses that
    move are shared out. couple: makes the actuators bound to the lattice; their rows follow those of the
    masses in every array. precision: of the internal force. twisting: edges along which nothing holds the
    director (`Scene.twisting_edges`). natural: the state of cells
    between lines at x and at y.
    """

    def __init__(
        self,
        sheet: Sheet,
        calibration: Calibration,
        weights: Weights = "tributary",
        couple: Callable[[Lattice], Coupling] | None = None,
        precision: Precision = "double",
        twisting: frozenset[str] = frozenset(),
        natural: Callable[..., NaturalState | None] = lambda x, y: None,
    ):
        self.lattice: Lattice = build(
            sheet,
            calibration.grid,
            calibration.layer_distance,
            weights,
            twisting,
            calibration.grading,
            calibration.half,
            calibration.per_area,
        )
        # Habibi et al.'s lattice has equal masses; any other one is as inert at its edges as the sheet
        self.cells = calibration.cells
        self.inertia: Distribution = "tributary" if weights == "full" else "gregory"
        self.coupling = couple(self.lattice) if couple is not None else None
        if self.coupling is None:
            self.pattern = of_grid(self.lattice.grid, self.lattice.present)
        else:
            own = self.coupling.pairs()
            pairs = neighbours(self.lattice.columns())
            rows, columns = (np.concatenate(part) for part in zip(pairs, own, strict=True))
            self.pattern = MassPattern(self.coupling.size, rows, columns)
            self.coupling_slots = self.pattern.slots(*own)
        springs = springs_of(self.lattice, self.pattern, calibration.springs, precision == "single")
        self.natural = state = natural(*(line.at for line in self.lattice.lines))
        self.all_families = springs
        if state is not None:
            if precision == "single":
                raise BadInput("precision = 'single': of a sheet that is flat at rest; leave it out")
            self.all_families = AllFamilies(with_natural(self.lattice, springs.families, state), self.pattern)
        self.force, self.advance = self.all_families.force, self.all_families.advance
        self.tangent, self.springs = self.all_families.tangent, self.all_families.families
        self.links, self.conservative = self.all_families.links, self.all_families.conservative
        self.any_strain = self.all_families.any_strain
        self.precision = precision

    @cached_property
    def plan(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Masses by plan position, positions at rest, and areas of the cells: made once for all samples."""
        return self.lattice.columns(), self.lattice.positions, self.lattice.cell_areas

    @property
    def rounding(self) -> float:
        """Relative spacing of the numbers that the internal force is computed with."""
        return float(np.finfo(np.float32 if self.precision == "single" else float).eps)

    def grow(self, share: float = 1.0, time: float | None = None) -> None:
        """Set the springs to a share of the sheet's natural state at a time [s], if it has one."""
        if self.natural is not None:
            self.natural.grow(share, time)

    def require_energy(self) -> None:
        """Raise BadInput when the springs have no energy."""
        if not self.conservative:
            raise BadInput(
                "per-direction springs have no energy: descent and energy-based methods do not apply"
            )

    def average_force(self, start: np.ndarray, end: np.ndarray) -> np.ndarray:
        """Internal force (n, 3) [N] whose work from `start` to `end` is the elastic energy stored."""
        force = np.zeros_like(start)
        for family in self.springs:
            family.add_average_force(start, end, force)
        return force

    def energies(self, u: np.ndarray) -> dict[str, float]:
        """Return the elastic energy [J] of the springs under each name in the spring set."""
        found: dict[str, float] = {}
        for family in self.springs:
            for name, energy in family.by_name(family.energies(u)).items():
                found[name] = found.get(name, 0.0) + energy
        return found
