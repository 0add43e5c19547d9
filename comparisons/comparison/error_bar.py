"""The error bar that a reference's mesh leaves at every probe of a comparison.

The reference is solved on coarser meshes too (`fem_reference.uncertainty`); a model that differs from it by
less than its bar is not distinguishable from it. The time that takes is reported apart.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from comparisons.models.grids import Elements
from comparisons.models.spec import counted
from sheetbench.scenes import Scene, Solution
from sheetbench.scenes.summary import few

if TYPE_CHECKING:
    from fem_reference.uncertainty import Uncertainty

METHOD = (
    "grid convergence index (Roache) of all pairs of meshes at the field's order, and what they miss of the "
    "layer along edges: that and 0.35 of the field's, 3 times that on two meshes"
)
CHEAP = ("plate", "shell")  # references whose error bar is found by default


@dataclass(frozen=True)
class ErrorBar:
    """The uncertainty of a reference at the probes of a scene.

    elements: along the shorter side, or (nx, ny), the finest mesh first; solve_seconds: of the coarser ones.
    """

    uncertainty: Uncertainty
    names: tuple[str, ...]
    elements: tuple[Elements, ...]
    solve_seconds: float

    @property
    def error(self) -> float:
        """The largest bar over the largest displacement: a bar for `error`."""
        return self.uncertainty.error

    def at(self, probe: str) -> float:
        """Length of the bar [m] of the displacement at a probe: a bar for `relative`, times |u_ref|."""
        return float(np.linalg.norm(self.uncertainty.bar[self.names.index(probe)]))

    def note(self, model: str) -> str:
        """Return the bar in words."""
        found, (*finer, coarsest) = self.uncertainty, [counted(n) for n in self.elements]
        if len(self.elements) == 2:
            why = "order 2 assumed, safety factor 3: two meshes show no order"
        elif np.isfinite(found.overall_order) and found.trusted.all():
            why = f"observed order {found.overall_order:.1f}"
        elif found.trusted.all():
            why = "no change but rounding"
        else:
            swing = int(np.sum(~found.trusted))
            why = f"{swing} of {found.trusted.size} components did not converge monotonically"
        meshes = f"{', '.join(finer)} and {coarsest} elements"
        return f"{model}: mesh error ± {few(100.0 * self.error)} % (from {meshes}; {why})."

    def as_dict(self) -> dict[str, Any]:
        """For JSON: lengths in metres, orders null where there is none."""
        found = self.uncertainty
        return {
            "error": self.error,
            "mesh": self.error,
            "order": found.overall_order,
            "elements": list(self.elements),
            "probes": dict(zip(self.names, found.bar, strict=True)),
            "orders": dict(zip(self.names, found.order, strict=True)),
            "extrapolated": dict(zip(self.names, found.extrapolated, strict=True)),
            "trusted": found.converging,
            "solve_seconds": self.solve_seconds,
            "method": METHOD,
        }


def error_bar(
    scene: Scene, finest: Solution, elements: Elements, solve: Callable[[Elements], Solution]
) -> ErrorBar | None:
    """Return the bar of a reference's solution on `elements`; `solve` answers on other numbers of elements.

    None where fewer than two meshes have an answer.
    """
    from fem_reference.uncertainty import coarser, mesh_size, of_solutions

    meshes = coarser(elements)
    solutions = [finest, *(solve(n) for n in meshes[1:])]
    sizes = [mesh_size(scene, n) for n in meshes]
    found = of_solutions(scene, solutions, sizes, scene.probe_points())
    if found is None:
        return None
    used = tuple(meshes[sizes.index(size)] for size in found.sizes)
    return ErrorBar(found, tuple(scene.probes), used, sum(s.solve_seconds for s in solutions[1:]))
