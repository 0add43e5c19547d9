"""Statics of the references: the discrete sheet of a scene on its path to the full load.

A fine shell begins at the equilibrium of a coarse one (`shell.coarse_start`). Where a graded one bends more
than stretched elements stand (`shell.validity`), it is divided evenly after all, and `fallback` says so. Past
limit points under conservative loads its path goes on (see `pseudo_transient`), and `snaps` has the load
factors at which the sheet snapped.
"""

from __future__ import annotations

from functools import partial
from typing import Any, cast

from fem_reference.discrete.answer import Traced, answered, inspected, traced
from fem_reference.sheets import SHEETS, shell
from fem_reference.shell import coarse_start
from fem_reference.shell.coarse_start import Shape
from fem_reference.shell.discrete import DiscreteShell
from fem_reference.shell.validity import STRETCHED, stretched
from fem_reference.surface.borders import has_lines
from fem_reference.surface.mesh import Elements, divisions
from sheetbench.answers.solution import Solution
from sheetbench.choices import BRANCHES
from sheetbench.errors import require_choice
from sheetbench.numerics.continuation.path import Progress
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.rigid_motions import require_static


def solve(
    scene: Scene, model: str, elements: Elements = 16, *, progress: Progress | None = None, **options: Any
) -> Solution:
    """The static equilibrium of a scene; options: as of `sheets.SHEETS`, of the shell also `_solve_shell`'s.
    Raises scenes.SceneError if the supports leave a rigid motion free, BadInput for an unknown option."""
    require_static(scene, "the plate, which is linear," if model == "plate" else "")
    if model == "shell":
        return _solve_shell(scene, divisions(scene.sheet, elements), progress=progress, **options)
    return answered(traced(partial(SHEETS[model], scene, elements, **options), progress=progress))


def _solve_shell(
    scene: Scene,
    counts: tuple[int, int],
    graded: bool = True,
    branch: str = "path",
    near: Shape | None = None,
    progress: Progress | None = None,
    **of_sheet: Any,
) -> Solution:
    """branch: one of `choices.BRANCHES`; "buckled" leaves an unstable equilibrium along its lowest mode for a
    stable one. near: the shape, as `coarse_start.shaped` takes it, of an equilibrium to be sought from first;
    where it leads to no stable one, from flat."""
    require_choice("branch", branch, BRANCHES)
    options = {"progress": progress, "buckled": branch == "buckled"}
    if near is None:
        runs = _runs(scene, counts, graded, of_sheet, **options)
    else:
        begin = partial(coarse_start.shaped, near)
        runs = [_run(scene, counts, graded, of_sheet, near=begin, progress=progress)]
    fallback = ""
    if runs[0].path.fault is STRETCHED:
        fallback = "divided evenly, for it bends much"
        runs = [_run(scene, counts, False, of_sheet, **options), *runs]
    return answered(*runs, fallback=fallback, **({"branch": branch} if branch == "buckled" else {}))


def _runs(
    scene: Scene, counts: tuple[int, int], graded: bool, of_sheet: dict[str, Any], **options: Any
) -> list[Traced]:
    """The run on a mesh of so many elements, then those on coarser ones that it has begun with."""
    few = None if scene.obstacles else coarse_start.coarse(counts, scene)
    rows = graded and has_lines(scene)  # those along an outline are half of a coarse mesh
    on_coarse = {"progress": options["progress"], "limits": coarse_start.LIMITS}
    begun = [] if few is None else _runs(scene, few, rows, of_sheet, **on_coarse)
    near = None
    if begun and coarse_start.plain(begun[0].path):
        near = partial(coarse_start.start, cast(DiscreteShell, begun[0].sheet), begun[0].path.state.q)
    return [_run(scene, counts, graded, of_sheet, near=near, **options), *begun]


def _run(
    scene: Scene, counts: tuple[int, int], graded: bool, of_sheet: dict[str, Any], **options: Any
) -> Traced:
    """The run on one mesh; options: as of `discrete.answer.traced`."""
    make = partial(shell, scene, counts, graded=graded, **of_sheet)
    return traced(make, stretched if graded else inspected, **options)
