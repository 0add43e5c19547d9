"""One answer of a crosscheck, carried out in a process of its own: plain data in and out, SI units."""

from __future__ import annotations

from typing import Any

import numpy as np

from comparisons.models.candidate import Candidate
from comparisons.models.registry import answer as solve
from comparisons.models.registry import check
from sheetbench.scenes import Scene


def answer(
    scene: dict[str, Any],
    model: str,
    settings: dict[str, Any],
    version: str | None = None,
    digest: str | None = None,
) -> dict[str, Any]:
    """A model's answer at the probes, and the mean size [m] of its cells.

    version, digest: of an external code and of its plug-in, under which the row is kept.
    """
    parsed, candidate = Scene.model_validate(scene), Candidate(model, settings)
    check(parsed, candidate, large=True)
    solution = solve(parsed, candidate)
    counts = solution.settings.get("elements") or [n - 1 for n in solution.settings["grid"]]
    return {
        "model": solution.model,
        "label": solution.label,
        "settings": solution.settings,
        "status": str(solution.status),
        "advice": solution.status.advice,
        "message": solution.message,
        "load_factor": solution.load_factor,
        "unknowns": solution.unknowns,
        "iterations": solution.iterations,
        "solve_seconds": solution.solve_seconds,
        "setup_seconds": solution.setup_seconds,
        "displacement": solution.displacement(parsed.probe_points()),
        "reactions": solution.reactions,
        "size": float(np.sqrt(np.prod(parsed.sheet.lengths) / np.prod(counts[:2]))),
    }
