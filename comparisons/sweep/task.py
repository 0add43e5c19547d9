"""The one task of the table of solves: a model on a scene, at rest or in motion, and what it cost.

Time: the solve alone, after two solves of the same problem that are not counted; every sample kept. Memory:
how far the process' resident set rises, during the second solve and its set-up, above what it was with all
code loaded (Linux; elsewhere the rise of the largest resident set so far). Quick solves are repeated until
`SETTLED` seconds are spent, up to `MOST` times, so that their median means something.
"""

from __future__ import annotations

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
    run: Mapping[str, Any] = {},  # read alone
    version: str | None = None,
    digest: str | None = None,
) -> dict[str, Any]:
    """Return the row of a solve (`comparisons.sweep.solved.Ask`): its document, and under `columns` and
    `cost` what else was wanted.

    version, digest: of an external code and of a plug-in, under which the row is kept; one that has changed
    since raises RuntimeError.
    """
    if plugins.digest(model) != digest:
        raise RuntimeError(f"model = '{model}': the plug-in changed since this run was requested")
    requested = Scene.model_validate(scene)
    if duration is not None:
        assert every is not None
        return _motion(requested, model, settings, duration, every, dict(run))
    warm(model)

    def solved() -> Solution:
        with running(large=True):  # who asks has looked at the size
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
        meant = resolve(scene, spec_of(model, settings), use)
    ours = plugins.digest(model) is None
    if ours:
        small = resolve(scene, meant.spec.but(count=1), use) if isinstance(meant.spec, Elements) else meant
        simulate(small, 2.0 * every, every=every, **run)
    history, memory = with_peak_memory(lambda: simulate(meant, duration, every=every, **run))
    found = size(scene, meant.spec)
    unknowns = history.extra.get("unknowns") if found is None else found.unknowns
    return {**history.document(), "unknowns": unknowns, "cost": _cost(memory if ours else None)}


def _cost(memory: int | None) -> dict[str, Any]:
    """What a solve took of the machine, and which; another program's memory is not this process'."""
    return {"peak_memory_bytes": memory, **load.conditions()}
