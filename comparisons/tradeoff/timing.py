"""What a solve costs: time on warm code, memory, set-up; the answer at the probes and over the sheet.

Time: the solve alone, after two solves of the same problem that are not counted; every sample kept. Memory:
how far the process' resident set rises, during the second solve and its set-up, above what it was with all
code loaded (Linux; elsewhere the rise of the largest resident set so far). Quick solves are repeated until
`SETTLED` seconds are spent, up to `MOST` times, so that their median means something.
"""

from __future__ import annotations

import statistics
from typing import Any

import numpy as np

from comparisons.comparison.comparison import error
from comparisons.external import plugins
from comparisons.models.context import running
from comparisons.models.resolve import resolve
from comparisons.models.solve import solve, warm
from comparisons.models.spec import Spec, spec_of
from comparisons.report.plan import inside
from comparisons.runs import load
from comparisons.runs.campaign import Run
from comparisons.runs.peak_memory import with_peak_memory
from comparisons.sweep.model_error import model_error
from sheetbench.scenes import Scene, Solution, Status

SETTLED, MOST = 0.1, 25
GAUSS_POINTS = 24  # along each side, for norms over the sheet


def run(scene: Scene, spec: Spec, repeats: int = 5, timed: bool = True) -> Run:
    """The run of a campaign that solves a scene with a model; repeats = 1 where time does not matter."""
    arguments = {
        "scene": scene.document(),
        "model": spec.model,
        "settings": spec.settings,
        "repeats": repeats if timed else 0,
    }
    if (digest := plugins.digest(spec.model)) is not None:
        arguments["digest"] = digest
    return Run("timing", arguments, spec.label, timed)


def measure(
    scene: dict[str, Any], model: str, settings: dict[str, Any], repeats: int, digest: str | None = None
) -> dict[str, Any]:
    """The row of a run, as plain data in SI units: see the module and `comparisons.tradeoff.statics`.

    repeats: timed solves at least, after two that are not; with 0 there is one solve, and no memory is
    measured. digest: of a plug-in, under which the row is kept; one that has changed since raises
    RuntimeError.
    """
    if plugins.digest(model) != digest:
        raise RuntimeError(f"model = '{model}': the plug-in changed since this run was requested")
    requested = Scene.model_validate(scene)
    warm(model)

    def solved() -> Solution:
        with running(large=True):  # `tradeoff` has looked at the size
            return solve(resolve(requested, spec_of(model, settings)))

    solution = solved()
    memory, samples = None, list[float]()
    if solution.status is Status.FAILED:
        repeats = 0
    if repeats:
        solution, memory = with_peak_memory(solved)
    if plugins.is_program(model):  # whose memory is not this process'
        memory = None
    while len(samples) < repeats or (samples and sum(samples) < SETTLED and len(samples) < MOST):
        samples.append(solved().solve_seconds)
    if not samples:
        samples = [solution.solve_seconds]
    points = requested.probe_points()
    probes = solution.displacement(points)
    return {
        "model": plugins.shown_name(model),
        "label": solution.label,
        "settings": settings,
        "status": str(solution.status),
        "message": solution.message,
        "load_factor": solution.load_factor,
        "unknowns": solution.unknowns,
        "iterations": solution.iterations,
        "solve_seconds": {"median": statistics.median(samples), "samples": samples},
        "setup_seconds": solution.setup_seconds,
        "peak_memory_bytes": memory,
        "model_error": None if (left_out := model_error(requested, solution)) is None else left_out.value,
        "bar": None if solution.bar is None else error(probes + solution.bar(points), probes),
        "probes": dict(zip(requested.probes, probes, strict=True)),
        "field": solution.displacement(field_points(requested)[0]),
        **load.conditions(),
    }


def field_points(scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """Gauss points (n, 2) [m] of the rectangle that lie on the sheet, and their shares (n,) of its area."""
    at, weight = np.polynomial.legendre.leggauss(GAUSS_POINTS)
    x, y = np.meshgrid(*(0.5 * (1.0 + at) * length for length in scene.sheet.lengths), indexing="ij")
    points, weights = np.column_stack([x.ravel(), y.ravel()]), np.outer(weight, weight).ravel()
    there = inside(scene, points)
    return points[there], weights[there] / weights[there].sum()
