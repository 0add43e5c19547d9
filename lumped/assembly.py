"""A lattice with its springs, ready to compute: energy, internal force, tangent over a fixed pattern."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from copy import copy
from typing import cast

import numpy as np

from lumped.actuators import Coupling
from lumped.calibration import Calibration
from lumped.lattice import Lattice, Weights, build
from lumped.natural import with_natural
from lumped.pattern import MassPattern, neighbours, of_grid
from lumped.springs.all_families import AllFamilies, Survey, springs_of
from lumped.springs.families import Family
from sheetbench.errors import BadInput
from sheetbench.scenes import Sheet
from sheetbench.scenes.meaning.natural_state import NaturalState
from sheetbench.scenes.objects.springs import Distribution


class Assembly:
    """Energy, force and tangent of a calibrated lattice. Displacements and forces are (n, 3) [m], [N].

    springs: the families (`lumped.springs.families`), the central `links` first. inertia: distribution of the
    mass in motion. couple: creates the actuators bound to the lattice; their rows follow the masses' rows in
    every array. rounding: relative spacing of the internal force's numbers. twisting: edges along which
    nothing holds the director (`Scene.twisting_edges`). plan: a lattice with an equal plan, if known.
    """

    natural: NaturalState | None = None
    rounding = float(np.finfo(float).eps)

    def __init__(
        self,
        sheet: Sheet,
        calibration: Calibration,
        weights: Weights = "tributary",
        couple: Callable[[Lattice], Coupling] | None = None,
        twisting: frozenset[str] = frozenset(),
        plan: Lattice | None = None,
    ):
        grid, distance, per_area = calibration.grid, calibration.layer_distance, calibration.per_area
        if plan is None:
            self.lattice = build(sheet, grid, distance, weights, twisting, calibration.grading, per_area)
        else:
            self.lattice = plan.at_distance(distance, per_area)
        self.calibration = calibration
        # Habibi et al.'s lattice has equal masses; any other has the sheet's inertia at its edges
        self.cells = calibration.cells
        self.inertia: Distribution = "tributary" if weights == "full" else "gregory"
        self.coupling = couple(self.lattice) if couple is not None else None
        if self.coupling is None:
            self.pattern = of_grid(self.lattice.grid, self.lattice.present)
        else:
            of_actuators = self.coupling.pairs()
            pairs = neighbours(self.lattice.columns())
            rows, columns = (np.concatenate(part) for part in zip(pairs, of_actuators, strict=True))
            self.pattern = MassPattern(self.coupling.size, rows, columns)
            self.coupling_slots = self.pattern.slots(*of_actuators)
        self._take(springs_of(self.lattice, self.pattern, calibration.springs))

    def grow(self, state: NaturalState) -> None:
        """Set a natural state of the cells; `at` returns the lattice at a share of it."""
        make = with_natural(self.lattice, self.springs, state)
        self._take(AllFamilies(make(*state.at()), self.pattern))
        self.natural = state.made(lambda *forms: self._with_families(make(*forms)))

    def _take(self, springs: AllFamilies) -> None:
        self.all_families = springs
        self.force, self.tangent, self.average_force = springs.force, springs.tangent, springs.average_force
        self.springs, self.links = springs.families, springs.links
        self.conservative, self.any_strain = springs.conservative, springs.any_strain

    def _with_families(self, families: Sequence[Family]) -> Assembly:
        other = copy(self)
        other._take(AllFamilies(families, self.pattern))
        return other

    def at(self, share: float = 1.0, time: float | None = None) -> Assembly:
        """Return the lattice with its springs at a share of the sheet's natural state, if any, and at a time
        [s], by default the last."""
        return self if self.natural is None else cast(Assembly, self.natural.at(share, time))

    def require_energy(self) -> None:
        """Raise BadInput when the springs have no energy."""
        if not self.conservative:
            raise BadInput(
                "per-direction springs have no energy: descent and energy-based methods do not apply"
            )

    def survey(self, u: np.ndarray) -> Survey:
        """Return the springs' energies and largest strains at a displacement u (n, 3) [m]."""
        return self.all_families.survey(u, self.lattice.grid[2])
