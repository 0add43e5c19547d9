"""Error bar of a reference at every probe of a comparison, due to its mesh.

The reference is solved on coarser meshes too (`fem_reference.uncertainty`). A model that differs from it by
less than the bar is not distinguishable from it. The time of the coarser solves is reported separately.
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
    "grid convergence index (Roache) of all pairs of meshes at the field's order, and the error in the layer "
    "along edges: that and 0.35 of the field's, 3 times that on two meshes"
)
CHEAP = ("plate", "shell")  # references with an error bar by default


@dataclass(frozen=True)
class ErrorBar:
    """The uncertainty of a reference at the probes of a scene. elements: along the shorter side, or (nx, ny),
    the finest mesh first; solve_seconds: of the coarser meshes."""

    uncertainty: Uncertainty
    names: tuple[str, ...]
    elements: tuple[Count, ...]
    solve_seconds: float

    @property
    def error(self) -> float:
        """Error bar of `error`: the largest bar over the largest displacement."""
        return self.uncertainty.error

    def at(self, probe: str) -> float:
        """Return the bar of the displacement at a probe [m]: a bar for `relative` times |u_ref|."""
        return float(np.linalg.norm(self.uncertainty.bar[self.names.index(probe)]))

    def note(self, model: str) -> str:
        """Return the bar in words."""
        result, (*finer, coarsest) = self.uncertainty, [counted(n) for n in self.elements]
        if len(self.elements) == 2:
            basis = "order 2 assumed, safety factor 3: two meshes show no order"
        elif np.isfinite(result.overall_order) and result.trusted.all():
            basis = f"observed order {result.overall_order:.1f}"
        elif result.trusted.all():
            basis = "no change but rounding"
        else:
            count = int(np.sum(~result.trusted))
            basis = (
                f"{count} of {result.trusted.size} components did not settle with the mesh: a guess for these"
            )
        meshes = f"{', '.join(finer)} and {coarsest} elements"
        return f"{model}: mesh error ± {few(100.0 * self.error)} % (from {meshes}; {basis})."

    def as_dict(self) -> dict[str, Any]:
        """Return the bar as JSON data: lengths in metres, unknown orders null."""
        result = self.uncertainty
        return {
            "error": self.error,
            "mesh": self.error,
            "order": result.overall_order,
            "elements": list(self.elements),
            "probes": dict(zip(self.names, result.bar, strict=True)),
            "orders": dict(zip(self.names, result.order, strict=True)),
            "extrapolated": dict(zip(self.names, result.extrapolated, strict=True)),
            "trusted": result.converging,
            "solve_seconds": self.solve_seconds,
            "method": METHOD,
        }


def error_bar(rows: Sequence[Solved]) -> ErrorBar | None:
    """Return the error bar from rows, the finest mesh first, None for fewer than two usable rows."""
    uncertainty = limit(rows)
    if uncertainty is None:
        return None
    specs = {row.size: row.request.spec for row in reversed(rows)}  # the first of equal sizes
    used = tuple(spec.elements for n in uncertainty.sizes if isinstance(spec := specs[n], Elements))
    seconds = sum(sum(row.samples) for row in rows[1:])
    return ErrorBar(uncertainty, tuple(rows[0].request.scene.probes), used, seconds)
