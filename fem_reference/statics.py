"""Statics of the references: the discrete sheet of a scene on its path to the full load.

A fine shell begins at the equilibrium of a coarse one (`shell.coarse_start`). A graded shell that bends more
than stretched elements can follow (`shell.validity`) is divided evenly instead, which the answer's `fallback`
reports. Past limit points under conservative loads the path goes on (see `pseudo_transient`), and `snaps` has
the load factors at which the sheet snapped.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any, cast

import numpy as np

from fem_reference.discrete.answer import TracedPath, last_fault, solution_of, trace_sheet
from fem_reference.sensitivity import SheetSensitivity
from fem_reference.sheets import Division
from fem_reference.shell import coarse_start
from fem_reference.shell.coarse_start import Shape
from fem_reference.shell.discrete import DiscreteShell
from fem_reference.shell.validity import STRETCHED, stretched
from sheetbench.answers.solution import Solution
from sheetbench.choices import BRANCHES
from sheetbench.errors import require_choice
from sheetbench.numerics.continuation.path import Progress


def solve(
    division: Division, branch: str = "path", near: Shape | None = None, progress: Progress | None = None
) -> Solution:
    """Return the static equilibrium of a divided sheet. branch, near: of the shell. branch: one of
    `choices.BRANCHES`; "buckled" leaves an unstable equilibrium along its lowest mode for a stable one. near:
    a shape, as in `coarse_start.in_shape`, near the equilibrium that is sought first; where no stable one is
    found from there, the path starts flat."""
    require_choice("branch", branch, BRANCHES)
    divisions, runs, start = [division], list[TracedPath](), near and partial(coarse_start.in_shape, near)
    while near is None and (coarser := divisions[-1].coarser()) is not None:
        divisions.append(coarser)
    buckled, fallback = branch == "buckled", ""
    for level in divisions[::-1]:
        inspect = stretched if level.model == "shell" and level.graded else last_fault
        options = {"buckled": buckled} if level is division else {"limits": coarse_start.LIMITS}
        run = trace_sheet(level.sheet, inspect, start, progress=progress, **options)
        sheet, path = cast(DiscreteShell, run.sheet), run.path
        start = partial(coarse_start.start, sheet, path.state.q) if coarse_start.is_direct(path) else None
        runs.insert(0, run)
    if runs[0].path.fault is STRETCHED:
        fallback = "elements of one size, for the bending"
        runs.insert(0, trace_sheet(division.with_grading(False).sheet, progress=progress, buckled=buckled))
    answer = solution_of(*runs, fallback=fallback, **({"branch": branch} if buckled else {}))
    if (make_again := runs[0].sheet.rebuild()) is None:
        return answer
    return replace(answer, sensitivity=partial(_sensitivity, make_again, runs[0].path.state.q, answer))


def _sensitivity(make_again: Callable[[], Any], q: np.ndarray, answer: Solution) -> SheetSensitivity:
    """Return the derivatives of an answer, from a sheet made again at q (N,)."""
    answer.require_stable()
    return SheetSensitivity(make_again(), q)
