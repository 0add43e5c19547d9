"""How a motion starts, where not from the sheet that supports alone shape."""

from __future__ import annotations

from typing import Literal

from sheetbench.scenes.objects.quantities import Frozen


class Initial(Frozen):
    """Where a motion starts; statics do not depend on it."""

    shape: Literal["static"]
    """"static": at rest in the equilibrium under all that acts at t = 0, loads with hold = true among it,
    which are let go then; unstable ones are refused. Without this table the sheet starts flat, or as bent and
    tilted supports alone shape it."""
