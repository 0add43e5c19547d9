"""Many equilibria at once, over all cores: springs, materials or loads that vary on one grid.

Cases that are alike (`lumped.statics.batch`) go their load paths in batches, each a compiled call that holds
no lock, on a thread of its own. What the lattices have in common is found once and kept: links of the grid,
pattern, order of the unknowns, a scene's supports and loads. Everything else, and what a batch leaves short
of the full load, is solved as `lumped.solve` does it, a case at a time.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from lumped.calibration import Calibration, default
from lumped.lattice import Weights
from lumped.statics.answer import Outcome, solution
from lumped.statics.batch import alike, batch, paths
from lumped.statics.equilibrium import State
from lumped.statics.fused import Posed
from lumped.statics.problem import Problem
from lumped.statics.solver import compile_kernels, doubtful, judged, pose, solve
from sheetbench.clock import now
from sheetbench.numerics.reduced import BandedFactor
from sheetbench.numerics.threads import one_blas_thread
from sheetbench.scenes import AnyScene, Iteration, Scene, Solution, require_static, scene_of
from sheetbench.scenes.errors import BadInput

AT_ONCE = 16  # cases of a batch: more gain nothing, and each one's factors take memory
BATCHED = {"weights"}  # the options that batches know

Case = tuple[Scene, Calibration | None]


class Answers(list[Solution]):
    """Solutions in order. alone: the numbers of those that were solved one at a time, because no batch takes
    such cases or it left them short of the full load."""

    def __init__(self, solutions: Iterable[Solution], alone: Iterable[int]):
        super().__init__(solutions)
        self.alone = tuple(alone)


def solve_many(
    scenes: AnyScene | Sequence[AnyScene],
    calibrations: Calibration | Sequence[Calibration | None] | None = None,
    *,
    workers: int | None = None,
    **options: Any,
) -> Answers:
    """The static equilibria of one scene with each of many springs, of many scenes with one kind of springs,
    or of as many scenes as springs, in pairs and in order.

    scenes, calibrations: one, or a sequence; without calibrations each scene has its own, as in `solve`.
    workers: threads, as many as there are cores unless given. options: of `solve`. Every answer has its own
    status and its own balance: a case that diverges costs no other.

    Raises BadInput for sequences of unequal lengths, and what `solve` raises for a scene or an option.
    """
    asked = [scenes] if isinstance(scenes, Scene | str | Path) else list(scenes)
    given = [calibrations] if isinstance(calibrations, Calibration | None) else list(calibrations)
    count = max(len(asked), len(given)) if asked and given else 0
    if {len(asked), len(given)} - {1, count}:
        raise BadInput(f"{len(asked)} scenes and {len(given)} calibrations: give one, or as many")
    posed = [scene_of(scene) for scene in asked]
    pairs = zip(posed * (count // len(posed)), given * (count // len(given)), strict=True) if count else ()
    cases: list[Case] = list(pairs)
    compile_kernels()
    threads = workers or os.cpu_count() or 1
    size = max(1, min(AT_ONCE, -(-count // threads))) if options.keys() <= BATCHED else 1
    parts = [cases[first : first + size] for first in range(0, count, size)]
    each = _together if options.keys() <= BATCHED else _alone
    with one_blas_thread(), ThreadPoolExecutor(threads) as pool:
        done = [answer for part in pool.map(lambda part: each(part, **options), parts) for answer in part]
    return Answers((found for found, _ in done), (at for at, (_, alone) in enumerate(done) if alone))


def _alone(cases: Sequence[Case], **options: Any) -> list[tuple[Solution, bool]]:
    return [(solve(*case, **options), True) for case in cases]


def _together(cases: Sequence[Case], weights: Weights = "tributary") -> list[tuple[Solution, bool]]:
    """Solutions, and whether each had to be solved alone."""
    began = now()
    ready: list[tuple[Scene, Calibration, Problem]] = []
    before: Problem | None = None
    for scene, given in cases:
        require_static(scene)
        springs = given or default(scene)
        same = before if ready and scene is ready[-1][0] else None
        before = pose(scene, springs, weights, same=same)
        ready.append((scene, springs, before))
    setup = (now() - began) / len(cases)
    batches: list[list[int]] = []
    first: Posed | None = None  # of the last batch
    for at, (_, _, problem) in enumerate(ready):
        posed = problem.posed
        if posed is not None and first is not None and alike(first, posed):
            batches[-1].append(at)
        elif posed is not None:
            batches.append([at])
            first = posed
    found: dict[int, Solution] = {}
    for members in batches:
        found |= _solutions({at: ready[at] for at in members}, setup, weights)
    return [
        (found[at], False) if at in found else (solve(*case, weights=weights), True)
        for at, case in enumerate(cases)
    ]


def _solutions(
    cases: dict[int, tuple[Scene, Calibration, Problem]], setup: float, weights: Weights
) -> dict[int, Solution]:
    """The solutions of cases that are alike, without those that their paths left short of the full load."""
    began = now()
    done = paths(batch([problem.posed for _, _, problem in cases.values() if problem.posed is not None]))
    share = (now() - began) / len(cases)
    asked = {} if weights == "tributary" else {"weights": weights}
    found = {}
    for place, (at, (scene, springs, problem)) in enumerate(cases.items()):
        if done.load_factor[place] != 1.0 or problem.system.band is None:
            continue
        began = now()
        u = done.u[place]
        factor = BandedFactor(problem.system.band, done.matrix[place], done.factors[place])
        state = State(u, 1.0, problem.assembly.stresses(u), done.blocks[place], factor, factor.negative)
        problem.factorisations = int(done.factorisations[place])
        problem.history = [Iteration(*line) for line in done.history[place, : done.lines[place]].tolist()]
        if doubtful(problem, state):
            continue
        outcome: Outcome = judged(scene, problem, state)
        seconds = setup, share + now() - began
        found[at] = solution(scene, springs, problem, outcome, seconds, asked)
    return found
