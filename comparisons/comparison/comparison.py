"""A scene solved by a lattice and a reference, and by what is shown beside them."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from pathlib import Path
from typing import Any

from comparisons.comparison import branches, far_apart, strain_law
from comparisons.comparison.answer import Comparison
from comparisons.comparison.differences import error
from comparisons.comparison.error_bar import CHEAP, error_bar
from comparisons.models.candidate import Candidate
from comparisons.models.expected_error import expected_error
from comparisons.models.grading import Grading
from comparisons.models.grids import Elements, GridLike
from comparisons.models.plugins import shown_name
from comparisons.models.registry import answer, check, check_reference
from comparisons.models.sizes import has_room
from comparisons.models.springs import LatticeSpec, resolve
from comparisons.report.work import Progress, silent
from comparisons.runs.load import average
from comparisons.runs.load import warnings as doubts
from sheetbench.choices import ELEMENTS, REFERENCE
from sheetbench.scenes import Scene, SceneError, Solution, Status, load, require_static

COMPANION = "lumped-uniform"


def compare(
    scene: Scene | str | Path,
    *,
    grid: GridLike = None,
    calibration: str | None = None,
    k: float | None = None,
    layer_distance: float | None = None,
    grading: Grading = None,
    reference: str = REFERENCE,
    elements: Elements = ELEMENTS,
    law: str | None = None,
    uncertainty: bool | None = None,
    symmetry: bool = False,
    branch: str = "path",
    companion: bool = True,
    others: Sequence[Candidate] = (),
    large: bool = False,
    progress: Progress = silent,
    starting: Callable[[str], None] = silent,
    finished: Callable[[Solution], None] = silent,
) -> Comparison:
    """Solve a scene with the lattice and with a reference, and put the answers side by side.

    grid: masses, 9 by default: a number is along the shorter side, with near-square cells; (nx, ny) or "9x13"
    along x and y; (nx, ny, layers). calibration: by default `consistent`, and then the uniform calibration is
    solved too and shown alongside as `lumped-uniform`; where `k` [N/m] is given the default is `uniform`, and
    where the scene brings its own [springs] they are used alone; companion = False leaves it out.
    layer_distance [m]. grading: 0, cells of one size, to 1, finest at the edges, or "auto", as the scene's
    layers need (`comparisons.models.grading`); the companion's cells are of one size. elements: along the
    shorter side, or (nx, ny). law: of strain, where the reference is a shell or solid
    (`sheetbench.choices.STRAIN_LAWS`). uncertainty: find the reference's error bar on coarser meshes too; for
    plate and shell it is unless False, for others if True. symmetry: solve a half or a quarter where scene
    and grid mirror themselves; solids are solved whole. branch: "path", or "buckled", which leaves unstable
    equilibria along their buckling mode; of lattice and shell.
    others: models that stand in the table too, plug-ins or our own. A name that is taken is changed. large:
    even where a model takes more memory than there is. progress: told what is being done, and of every
    iteration (`comparisons.report.work`). `starting` and `finished` are called before and after each model,
    so that a caller can keep what is done.

    Raises SceneError for a scene without a static answer, BadInput for choices that do not exist, and the
    solvers' own errors for settings they cannot use. A solve that fails is data: see each solution's status.
    """
    if not isinstance(scene, Scene):
        scene = load_static(scene)
    require_static(scene)
    own_law = {} if law is None else {"law": law}
    check_reference(reference, elements, own_law)
    mirrored: dict[str, Any] = {"symmetry": True} if symmetry else {}
    cut = mirrored if reference != "solid" else {}
    judge = Candidate(reference, {"elements": elements, **own_law, **cut})
    lattice = LatticeSpec(grid, calibration, k, layer_distance, grading)
    if branch != "path":
        mirrored["branch"] = branch
        check_reference(reference, elements, {**own_law, "branch": branch})
        judge = judge.but(branch=branch)
    first = lattice.candidate.but(**mirrored)
    for candidate in (first, judge, *others):
        check(scene, candidate, large)
    named = {first.model: first, reference: judge}
    left_open = calibration is None and k is None and resolve(scene, lattice).calibration is not None
    if companion and left_open:
        named[COMPANION] = first.but(calibration="uniform", grading=None)
    for other in others:
        named[_unlike(shown_name(other.model), named)] = other
    solutions = []
    for name, candidate in named.items():
        starting(name)
        solutions.append(answer(scene, candidate, name, progress=progress))
        finished(solutions[-1])
    laws = apart = ""
    several = begun = other_branch = False
    one_branch = branches.joined(scene, first, judge, *solutions[:2])
    if one_branch is not None:
        several, begun = True, one_branch[1] is not solutions[1]
        solutions[0], solutions[1], apart = one_branch

    def also(other: Candidate) -> Solution | None:
        fits = large or has_room(scene, other)
        return answer(scene, other, "lumped on a finer grid", progress=progress) if fits else None

    expected = expected_error(scene, first, solutions[0], also)
    bar = None
    alone = begun or solutions[1].status is Status.UNSTABLE  # coarser meshes may be on another branch
    asked = reference in CHEAP if uncertainty is None else uncertainty
    if asked and solutions[1].comparable and not alone:
        starting(f"{reference} on coarser meshes")

        def coarser(n: Elements) -> Solution:
            return answer(scene, judge.but(elements=n), progress=progress)

        bar = error_bar(scene, solutions[1], elements, coarser)
    answers, within = tuple(solutions), None if bar is None else bar.error
    if first.model == "lumped":
        laws = strain_law.said(scene, first, answers, within)
        if not apart:
            apart, other_branch = far_apart.said(scene, first, answers, error, within, also)
    known, busy = several or other_branch, tuple(doubts([average()]))
    return Comparison(scene, answers, bar, laws, apart, expected, known, other_branch, busy, law is not None)


def _unlike(name: str, taken: Collection[str]) -> str:
    """The name, or with the first number after it that makes it a new one."""
    return next(n for n in (name, *(f"{name}-{i}" for i in range(2, len(taken) + 3))) if n not in taken)


def load_static(scene: str | Path) -> Scene:
    """The scene of a catalogue name or file, refused by that name if its supports leave it free to move."""
    loaded = load(scene)
    try:
        require_static(loaded)
    except SceneError as error:
        raise SceneError(f"{scene}: {error}") from None
    return loaded
