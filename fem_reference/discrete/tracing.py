"""The path of a sheet at rest to its full load: straight, or with soft contact first where there are
obstacles."""

from __future__ import annotations

from typing import Any

import numpy as np

from fem_reference.discrete.contact import Touching
from fem_reference.discrete.elements import DiscreteElements
from fem_reference.discrete.static import Forces, State, Static
from sheetbench.answers.solution import Status
from sheetbench.numerics.continuation.limits import Limits
from sheetbench.numerics.continuation.newton import Start
from sheetbench.numerics.continuation.path import Fault, Inspect, Path, Settle
from sheetbench.numerics.continuation.stiffening import trace_stiffening
from sheetbench.numerics.continuation.trace import trace_path


class Softness:
    """The penalties of a sheet's contacts (`sheetbench.numerics.continuation.stiffening`)."""

    def __init__(self, sheet: DiscreteElements):
        self._sheet = sheet
        flat = sheet.shape(np.zeros(sheet.size), 1.0)
        others = [item for item in sheet.items if not isinstance(item, Touching)]
        dead = sum((item.force(flat) for item in others), np.zeros(sheet.size))
        self._force = float(np.abs(sheet.displacement(dead)).sum())
        placed = sheet.displacement(sheet.placed(np.zeros(sheet.size), 1.0))
        self._travel = float(np.abs(placed).max())

    @property
    def soft(self) -> float | None:
        """The share of the stiffness to begin with."""
        each = self._sheet.contacts
        loads = [self._force / float(one.area.sum()) for one in each]
        size = self._sheet.longest
        return min(one.soft_share(load, self._travel, size) for one, load in zip(each, loads, strict=True))

    def soften(self, share: float) -> None:
        """Give the contacts a share of their stiffness."""
        for one in self._sheet.contacts:
            one.share = share


def trace(
    sheet: DiscreteElements,
    inspect: Inspect[State, Forces],
    settle: Settle[State, Forces] | None,
    limits: Limits | None = None,
    **options: Any,
) -> Path[State, Forces]:
    """Return the path of a sheet, as `trace_path` does with these options; with obstacles from rest, whatever
    is near."""
    structure, limits = Static(sheet), limits or Limits()
    if not sheet.contacts:
        return trace_path(structure, sheet.solver(), inspect, settle, limits=limits, **options)
    progress, slenderness = options.get("progress"), options.get("slenderness", 0.0)
    before = structure.rest(), 0.0

    def kept_out(path: Path[State, Forces]) -> Fault | None:
        nonlocal before
        start = before[0] if 0.0 < before[1] <= path.load_factor else structure.rest()
        before = path.state, path.load_factor
        ends = (sheet.on_surface(state.q) for state in (start, path.state))
        from_, to = ends
        if any(one.leads_through(from_, to, path.load_factor) for one in sheet.contacts):
            return Fault(Status.STEP_LIMIT, "a step led through an obstacle")
        return inspect(path)

    def soft() -> Path[State, Forces]:
        direct = limits.direct
        return trace_path(
            structure, sheet.solver(), kept_out, settle, progress, slenderness=slenderness, limits=direct
        )

    path = Path(structure, sheet.solver(), structure.rest(), limits=limits, progress=progress)

    def restart(state: State) -> Start[State]:
        balanced = structure.potential(state, 1.0)[1]
        return Start(structure.unextrapolated(state), 1.0, 1.0, balanced)

    return trace_stiffening(
        Softness(sheet), path, soft, kept_out, settle, restart, options.get("buckled", False)
    )
