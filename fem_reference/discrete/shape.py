"""A discrete sheet in one shape: strains, stresses and moduli, computed once and used by forces, tangent and
loads."""

from functools import cached_property
from typing import Any

import numpy as np

from fem_reference.discrete import tangent_planes
from fem_reference.shell.element import weighed
from sheetbench.scenes.objects.relaxation import BranchStep


class SheetShape:
    """Coordinates q and rates v (N,), zero where None, of a sheet (`discrete.sheet`) at `at`, a load factor
    or time [s]. branches: the step of its Maxwell branches that ends there."""

    def __init__(
        self,
        sheet: Any,
        q: np.ndarray,
        at: float,
        v: np.ndarray | None = None,
        branches: BranchStep | None = None,
    ):
        self.sheet, self.q, self.at, self.v, self.branches = sheet, q, at, v, branches

    @cached_property
    def vectors(self) -> Any:
        """Position φ and director d at the nodes of the plan's elements, (m, 18, 3)."""
        return self.sheet.on_surface(self.q)

    @cached_property
    def rates(self) -> Any:
        """Rates (m, 18, 3) of `vectors`."""
        return self.sheet.surface_change(np.zeros_like(self.q) if self.v is None else self.v)

    def displacement_rate(self, points: np.ndarray, change: np.ndarray) -> np.ndarray:
        """Return the change (p, 3) [m] of the mid-surface, as obstacles touch it, at plan points (p, 2), by a
        change (N,) of coordinates."""
        sheet = self.sheet
        moved: np.ndarray = sheet.sample(sheet.displacement(change), points)
        if not sheet.touched_without_kinks(self):
            return moved
        on, _, by = tangent_planes.change_at(sheet.plan.mesh, self.vectors, points)
        return moved + np.einsum("pijc,pjc->pi", by, sheet.surface_change(change)[on])

    @cached_property
    def frame(self) -> Any:
        """Data of the matrix Z, δq = Z x."""
        return self.sheet.frame(self.q, self.at)

    @cached_property
    def stretch(self) -> Any:
        """Measure of the strain for the sheet's `beyond`."""
        return self.sheet.stretch(self)

    # of a sheet of elements whose strains are quadratic in the coordinates

    @cached_property
    def change(self) -> Any:
        """Change of the elements' vectors (m, a, 3)."""
        return self.sheet.gather(self.q)

    @cached_property
    def operator(self) -> Any:
        """Data of the elements' B."""
        return self.sheet.element.operator(self.change)

    @cached_property
    def strain(self) -> Any:
        """Strain (m, k) from the sheet's natural state."""
        return self.sheet.strain(self.change, self.at)

    @cached_property
    def elastic(self) -> Any:
        """Elastic stress (m, k)."""
        stress, element = self.sheet.element.stress(self.strain), self.sheet.element
        if self.sheet.creep is None:
            return stress
        drag, past = self.sheet.creep
        return stress + drag * weighed(element.stiffness, self.strain - past)

    @cached_property
    def moduli(self) -> Any:
        """Derivative (m, k, k) of the elastic stress by the strain."""
        moduli, element = self.sheet.element.moduli(self.strain), self.sheet.element
        return moduli if self.sheet.creep is None else moduli + self.sheet.creep[0] * element.stiffness

    @cached_property
    def rate(self) -> Any:
        """Rate of the strain (m, k)."""
        if self.v is None:
            return np.zeros_like(self.strain)
        return self.sheet.element.step(self.operator, self.sheet.gather(self.v))
