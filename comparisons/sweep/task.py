"""The task of the table of solves: a solve of a model on a scene, at rest or in motion, with its cost.

Times are of the solve alone, after two untimed solves of the problem; every sample is stored. Memory is the
growth of the process (`comparisons.sweep.peak_memory`) during the second solve and its set-up. Quick solves
are repeated until `SETTLED` seconds are spent, at most `MOST` times, for a meaningful median.
"""

from collections.abc import Mapping, Sequence
from typing import Any

from comparisons.external import plugins
from comparisons.models.context import running
from comparisons.models.resolve import Use, resolve
from comparisons.models.sizes import size
from comparisons.models.solve import simulate, warm
from comparisons.models.solve import solve as answer
from comparisons.models.spec import Elements, spec_of
from comparisons.sweep import load
from comparisons.sweep.columns import COLUMNS
from comparisons.sweep.peak_memory import with_peak_memory
from sheetbench.answers.solution import Solution, Status
from sheetbench.scenes import Scene

SETTLED, MOST = 0.1, 25


def solve(
    scene: dict[str, Any],
    model: str,
    settings: dict[str, Any],
    repeats: int = 0,
    columns: Sequence[str] = (),
    duration: float | None = None,
    every: float | None = None,
    run: Mapping[str, Any] = {},  # never changed
    version: str | None = None,
    digest: str | None = None,
) -> dict[str, Any]:
    """Return the row of a requested solve (`comparisons.sweep.solved.Request`): the answer's document, with
    its additional `columns` and `cost`.

    version, digest: of an external code and of a plug-in, parts of the row's key. Raises RuntimeError for a
    plug-in that has changed since the request.
    """
    if plugins.digest(model) != digest:
        raise RuntimeError(f"model = '{model}': the plug-in changed since this run was requested")
    requested = Scene.model_validate(scene)
    if duration is not None:
        assert every is not None
        return _motion(requested, model, settings, duration, every, dict(run))
    warm(model)

    def solved() -> Solution:
        with running(large=True):  # the size was checked with the request
            return answer(resolve(requested, spec_of(model, settings)))

    solution = solved()
    samples, memory = [solution.solve_seconds], None
    if repeats and solution.status is not Status.FAILED:
        solution, memory = with_peak_memory(solved)
        samples = [solved().solve_seconds for _ in range(repeats)]
        while sum(samples) < SETTLED and len(samples) < MOST:
            samples.append(solved().solve_seconds)
    return {
        **solution.document(requested),
        "columns": {name: COLUMNS[name](requested, solution) for name in columns},
        "cost": {"samples": samples, **_cost(None if plugins.is_program(model) else memory)},
    }


def _motion(
    scene: Scene, model: str, settings: dict[str, Any], duration: float, every: float, run: dict[str, Any]
) -> dict[str, Any]:
    use: Use = "motion"
    with running(large=True):
        resolved = resolve(scene, spec_of(model, settings), use)
    internal = plugins.digest(model) is None
    if internal:  # warm-up
        spec = resolved.spec
        small = resolve(scene, spec.but(count=1), use) if isinstance(spec, Elements) else resolved
        simulate(small, 2.0 * every, every=every, **run)
    history, memory = with_peak_memory(lambda: simulate(resolved, duration, every=every, **run))
    estimate = size(scene, resolved.spec)
    unknowns = history.extra.get("unknowns") if estimate is None else estimate.unknowns
    return {**history.document(), "unknowns": unknowns, "cost": _cost(memory if internal else None)}


def _cost(memory: int | None) -> dict[str, Any]:
    """Return memory, load and machine of a solve; memory: of this process, None for other programs."""
    return {"peak_memory_bytes": memory, **load.conditions()}
