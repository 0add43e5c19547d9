"""The error bar that a reference's mesh leaves at every probe of a comparison.

The reference is solved on coarser meshes too (`fem_reference.uncertainty`); a model that differs from it by
less than its bar is not distinguishable from it. Its time is reported separately.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from comparisons.models.grids import Elements as Count
from comparisons.models.spec import Elements, counted
from comparisons.sweep.limits import limit
from comparisons.sweep.solved import Solved
from sheetbench.scenes.language.summary import few

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
    elements: tuple[Count, ...]
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
            why = f"{swing} of {found.trusted.size} displacements did not settle: a guess"
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


def error_bar(rows: Sequence[Solved]) -> ErrorBar | None:
    """Return the bar of a reference's rows, the finest mesh first; None where fewer than two can be used."""
    found = limit(rows)
    if found is None:
        return None
    specs = {row.size: row.ask.spec for row in reversed(rows)}  # the first of one size
    used = tuple(spec.elements for n in found.sizes if isinstance(spec := specs[n], Elements))
    seconds = sum(sum(row.samples) for row in rows[1:])
    return ErrorBar(found, tuple(rows[0].ask.scene.probes), used, seconds)
