"""The path of a sheet at rest to its full load: straight, or with soft contact first where there are
obstacles."""

from __future__ import annotations

from typing import Any

import numpy as np

from fem_reference.discrete.contact import Touching
from fem_reference.discrete.elements import DiscreteElements
from fem_reference.discrete.static import Forces, Static, StaticState
from sheetbench.numerics.continuation.limits import Limits
from sheetbench.numerics.continuation.newton import Start
from sheetbench.numerics.continuation.path import Inspect, Path, Settle
from sheetbench.numerics.continuation.stiffening import Penalties, trace_stiffening
from sheetbench.numerics.continuation.trace import trace_path


def penalties(structure: Static) -> Penalties[StaticState]:
    """Return the penalties of a sheet's contacts."""
    sheet = structure.sheet
    flat = sheet.shape(np.zeros(sheet.size), 1.0)
    others = [item for item in sheet.items if not isinstance(item, Touching)]
    dead = sheet.displacement(sum((item.force(flat) for item in others), np.zeros(sheet.size)))
    flat_q = np.zeros(sheet.size)
    moved = np.abs(sheet.on_surface(sheet.placed(flat_q, 1.0)) - sheet.on_surface(flat_q)).max(axis=(0, 2))

    def passes(start: StaticState, since: float, end: StaticState, load_factor: float) -> bool:
        ends = sheet.shape(start.q, since), sheet.shape(end.q, load_factor)
        return any(one.step_share(*ends) < 1.0 for one in sheet.contacts)

    def restart(state: StaticState) -> Start[StaticState]:
        balanced = structure.potential(state, 1.0)[1]
        return Start(state, 1.0, 1.0, balanced)

    def touching(state: StaticState) -> np.ndarray:
        shape = sheet.shape(state.q, 1.0)
        return np.array([one.report(shape)[1] > 0.0 for one in sheet.contacts])

    force = float(np.abs(dead).sum())
    travel = float(max(moved[:9].max(), sheet.longest * moved[9:].max()))  # a director's turn moves the end
    return Penalties(sheet.contacts, force, travel, sheet.longest, False, passes, restart, touching)


def trace(
    sheet: DiscreteElements,
    inspect: Inspect[StaticState, Forces],
    settle: Settle[StaticState, Forces] | None,
    limits: Limits | None = None,
    **options: Any,
) -> Path[StaticState, Forces]:
    """Return the path of a sheet, as `trace_path` does with these options; with obstacles from rest, whatever
    is near."""
    structure, limits = Static(sheet), limits or Limits()
    if not sheet.contacts:
        return trace_path(structure, sheet.solver(), inspect, settle, limits=limits, **options)
    buckled, from_rest = options.pop("buckled", False), options | {"near": None}

    def soft(limits: Limits, inspect: Inspect[StaticState, Forces]) -> Path[StaticState, Forces]:
        return trace_path(structure, sheet.solver(), inspect, settle, limits=limits, **from_rest)

    path = Path(structure, sheet.solver(), structure.rest(), limits=limits, progress=options.get("progress"))
    return trace_stiffening(penalties(structure), path, soft, inspect, settle, buckled)
