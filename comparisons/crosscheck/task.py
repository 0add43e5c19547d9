"""One answer of a crosscheck, carried out in a process of its own: plain data in and out, SI units."""

from __future__ import annotations

from typing import Any

import numpy as np

from comparisons.models.context import running
from comparisons.models.resolve import resolve
from comparisons.models.solve import solve
from comparisons.models.spec import spec_of
from sheetbench.scenes import Scene


def answer(
    scene: dict[str, Any],
    model: str,
    settings: dict[str, Any],
    version: str | None = None,
    digest: str | None = None,
) -> dict[str, Any]:
    """A model's answer, as `compare` has it, and the mean size [m] of its cells.

    version, digest: of an external code and of its plug-in, under which the row is kept.
    """
    parsed = Scene.model_validate(scene)
    with running(large=True):  # `crosscheck` has looked at the size
        solution = solve(resolve(parsed, spec_of(model, settings)))
    counts = solution.settings.get("elements") or [n - 1 for n in solution.settings["grid"]]
    size = float(np.sqrt(np.prod(parsed.sheet.lengths) / np.prod(counts[:2])))
    return {**solution.document(parsed), "size": size}
