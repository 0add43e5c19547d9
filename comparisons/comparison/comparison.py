"""A scene solved by a lattice, a reference, and further models."""

import os
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

from comparisons.comparison import branches
from comparisons.comparison.answer import Comparison
from comparisons.comparison.error_bar import CHEAP, error_bar
from comparisons.comparison.far_apart import far_apart_note
from comparisons.comparison.settle import require_settling, solved_from_motion
from comparisons.external.plugins import shown_name
from comparisons.models.context import context
from comparisons.models.expected_error import expected_error
from comparisons.models.grids import Elements as Count
from comparisons.models.resolve import Resolved, resolve
from comparisons.models.solve import warm_both
from comparisons.models.spec import Elements, Lattice, Spec, parse, unique_name
from comparisons.sweep import load
from comparisons.sweep.in_process import solve_if_room, solve_in_process
from fem_reference.uncertainty import coarser
from sheetbench.answers.solution import Status
from sheetbench.choices import REFERENCE
from sheetbench.kernels import compiled_before
from sheetbench.numerics import fronts
from sheetbench.scenes import AnyScene, Scene, SceneError, require_static, scene_of

COMPANION = "lumped-uniform"


def compare(
    scene: Scene | str | Path,
    lattice: Lattice = Lattice(),  # noqa: B008  # frozen
    reference: Elements | str = REFERENCE,
    *,
    elements: Count | None = None,
    law: str | None = None,
    uncertainty: bool | None = None,
    companion: bool = True,
    models: Sequence[Spec | str] = (),
    settle: bool = False,
) -> Comparison:
    """Return the answers of a lattice, a reference and further models of a scene, with their errors.

    The options are explained in `comparisons.cli.compare`. The reference has the lattice's branch. companion:
    add uniform springs in cells of one size as `lumped-uniform` if the lattice's calibration is open.
    Duplicate model names get a suffix. settle: start every model from the end of its damped motion
    (`comparisons.comparison.settle`).

    Raises SceneError for a scene without a static answer, BadInput for unknown choices, and the solvers' own
    errors for settings they cannot use. A failed solve is reported by its solution's status.
    """
    scene = load_static(scene)
    keywords = {"elements": elements, "law": law, "branch": lattice.branch}
    reference_model = resolve(scene, Elements.given(reference, keywords))
    lattice_model = resolve(scene, lattice)
    by_name: dict[str, Resolved[Any]] = {m.spec.model: m for m in (lattice_model, reference_model)}
    is_open = lattice.calibration is lattice.k is None and lattice_model.spec.calibration is not None
    if companion and is_open and not scene.drawn_by and not settle:
        by_name[COMPANION] = resolve(scene, lattice.but(calibration="uniform", grading=None))
    for spec in models:
        further = resolve(scene, parse(spec))
        by_name[unique_name(shown_name(further.spec.model), by_name)] = further
    if not compiled_before(fronts.__file__) and (os.cpu_count() or 1) > 1:  # the first run on this machine
        warm_both(lattice_model.spec.model, reference_model.spec.model)
    require_settling(by_name.values() if settle else ())
    rows = []
    for name, model in by_name.items():
        rows.append(solved_from_motion(model, name) if settle else solve_in_process(model, name))
        context().solved(rows[-1].answer)
    solutions, disagreement = [row.answer for row in rows], ""
    common = branches.on_one_branch(lattice_model, reference_model, *solutions[:2])
    restarted = settle or (common is not None and common[1] is not solutions[1])
    if common is not None:
        solutions[0], solutions[1], disagreement = common
    solve = partial(solve_if_room, scene)
    expected = None if settle else expected_error(scene, lattice_model.spec, solutions[0], solve)
    bar = None
    branch_may_change = restarted or solutions[1].status is Status.UNSTABLE  # on coarser meshes
    with_bar = reference_model.spec.kind in CHEAP if uncertainty is None else uncertainty
    if with_bar and solutions[1].comparable and not branch_may_change:
        meshes = [reference_model.spec.but(count=n) for n in coarser(reference_model.spec.elements)[1:]]
        bar = error_bar([rows[1], *map(solve_in_process, (resolve(scene, mesh) for mesh in meshes))])
    answers, other_branch = tuple(solutions), False
    if not disagreement:
        bar_value = None if bar is None else bar.error
        disagreement, other_branch = far_apart_note(lattice_model, answers, bar_value, solve)
    return Comparison(
        *(scene, answers, bar, disagreement, expected),
        several=settle or common is not None or other_branch,
        other_branch=other_branch,
        busy=tuple(load.warnings([{"load_average": load.average()}])),
        law_chosen=reference_model.spec.law is not None,
    )


def load_static(scene: AnyScene) -> Scene:
    """Return a scene with a static answer; a refusal names its catalogue name or file."""
    loaded = scene_of(scene)
    try:
        require_static(loaded)
    except SceneError as error:
        if isinstance(scene, Scene):
            raise
        raise SceneError(f"{scene}: {error}") from None
    return loaded
