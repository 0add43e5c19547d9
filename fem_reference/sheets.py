"""The discrete sheet of a scene by model: what modes, buckling and motions divide a sheet into."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from fem_reference.discrete.answer import equilibrium
from fem_reference.discrete.elements import DiscreteElements
from fem_reference.plate.statics import plate
from fem_reference.shell.statics import shell
from fem_reference.solid.statics import solid
from sheetbench.errors import NoEquilibrium
from sheetbench.numerics.continuation.stability import require_stable
from sheetbench.scenes.meaning.motion import NO_START, at_start, starts_flat

SHEETS: dict[str, Callable[..., DiscreteElements]] = {"plate": plate, "shell": shell, "solid": solid}


def start(sheet: DiscreteElements) -> np.ndarray:
    """Return q (N,) of a sheet in motion at t = 0: flat, or the equilibrium to start from
    (`scenes.meaning.motion`). Raises NoEquilibrium where there is no stable one."""
    if starts_flat(sheet.scene):
        return sheet.placed(np.zeros(sheet.size), 0.0)
    kind: Any = type(sheet)
    of_sheet = {name: sheet.settings[name] for name in ("layers", "law", "clamp") if name in sheet.settings}
    q, status, notes = equilibrium(kind(sheet.plan.mesh, at_start(sheet.scene), **of_sheet))
    try:
        require_stable(sheet.model, status, notes)
    except NoEquilibrium as error:
        raise NoEquilibrium(f"{NO_START}: {error}") from None
    return sheet.placed(q, 0.0)
