"""Statics of the references: the discrete sheet of a scene on its path to the full load.

A fine shell begins at the equilibrium of a coarse one (`shell.coarse_start`). Where a graded one bends more
than stretched elements stand (`shell.validity`), it is divided evenly after all, and `fallback` says so. Past
limit points under conservative loads its path goes on (see `pseudo_transient`), and `snaps` has the load
factors at which the sheet snapped.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any, cast

import numpy as np

from fem_reference.discrete.answer import Traced, answered, inspected, traced
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
    """Return the static equilibrium of a divided sheet.

    branch, near: of the shell. branch: one of `choices.BRANCHES`; "buckled" leaves an unstable equilibrium
    along its lowest mode for a stable one. near: the shape, as `coarse_start.shaped` takes it, of an
    equilibrium to be sought from first; where it leads to no stable one, from flat."""
    require_choice("branch", branch, BRANCHES)
    divisions, runs, begin = [division], list[Traced](), near and partial(coarse_start.shaped, near)
    while near is None and (coarser := divisions[-1].coarser()) is not None:
        divisions.append(coarser)
    buckled, fallback = branch == "buckled", ""
    for each in divisions[::-1]:
        inspect = stretched if each.model == "shell" and each.graded else inspected
        own = {"buckled": buckled} if each is division else {"limits": coarse_start.LIMITS}
        run = traced(each.sheet, inspect, begin, progress=progress, **own)
        sheet, path = cast(DiscreteShell, run.sheet), run.path
        begin = partial(coarse_start.start, sheet, path.state.q) if coarse_start.plain(path) else None
        runs.insert(0, run)
    if runs[0].path.fault is STRETCHED:
        fallback = "divided evenly, for it bends much"
        runs.insert(0, traced(division.with_grading(False).sheet, progress=progress, buckled=buckled))
    found = answered(*runs, fallback=fallback, **({"branch": branch} if buckled else {}))
    if (again := runs[0].sheet.again()) is None:
        return found
    return replace(found, sensitivity=partial(_sensitivity, again, runs[0].path.state.q, found))


def _sensitivity(again: Callable[[], Any], q: np.ndarray, answer: Solution) -> SheetSensitivity:
    """Return what has the derivatives of an answer, of a sheet made again at q (N,)."""
    answer.require_stable()
    return SheetSensitivity(again(), q)
