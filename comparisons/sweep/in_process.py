"""Rows of the table of solves computed in this process, with their answers in memory."""

from dataclasses import dataclass
from functools import cached_property
from statistics import median
from typing import Any

import numpy as np

from comparisons.models.context import running
from comparisons.models.resolve import Resolved, resolve
from comparisons.models.sizes import has_room
from comparisons.models.solve import solve
from comparisons.models.spec import Lattice, Spec
from comparisons.pictures.work import silent
from comparisons.sweep import load
from comparisons.sweep.differences import field_points
from comparisons.sweep.solved import Request, Solved
from sheetbench.answers.history import History
from sheetbench.answers.solution import Solution
from sheetbench.scenes import Scene

REPEAT_BELOW = 0.2  # s: longer solves are not repeated


@dataclass(frozen=True, kw_only=True)
class LocalSolve(Solved):
    """A row with its answer."""

    answer: Solution

    @cached_property
    def u(self) -> np.ndarray:
        return self.answer.displacement(self.request.scene.probe_points())

    @cached_property
    def field(self) -> np.ndarray:
        return self.answer.displacement(field_points(self.request.scene))

    @property
    def seconds(self) -> float:
        return median(self.samples)


def solve_in_process(model: Resolved[Any], name: str = "", repeats: int = 1, near: Any = None) -> LocalSolve:
    """Solve a model and return its row; name: in place of its own; repeats: of a quick solve; near: a shape
    to start from."""
    answer = solve(model, name, near)
    samples = [answer.solve_seconds]
    with running(progress=silent):
        while len(samples) < repeats and answer.solve_seconds < REPEAT_BELOW:
            samples.append(solve(model).solve_seconds)
    row = {"settings": answer.settings, "load_factor": answer.load_factor, "probes": model.scene.probes}
    row["cost"] = {"samples": samples, "load_average": load.average()}
    status = str(answer.status)
    return LocalSolve(Request(model.scene, model.spec, repeats), status, answer.message, row, answer=answer)


def motion_row(scene: Scene, spec: Spec, history: History) -> Solved:
    """Return the row of a motion; the row of an incomplete motion has no values."""
    request, row = Request(scene, spec, duration=float(history.time[-1])), {"probes": history.probes}
    return Solved(request, str(history.status), history.message, row if history.succeeded else {})


def solve_if_room(scene: Scene, lattice: Lattice) -> Solution | None:
    """Return the answer of a finer lattice, None if it needs too much memory."""
    return solve(resolve(scene, lattice), "lumped on a finer grid") if has_room(scene, lattice) else None
