"""A scene solved by a lattice and a reference, and by what is shown beside them."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from comparisons.comparison import branches
from comparisons.comparison.answer import Comparison
from comparisons.comparison.error_bar import CHEAP, error_bar
from comparisons.comparison.far_apart import far_apart_note
from comparisons.comparison.settle import require_settling, settled
from comparisons.external.plugins import shown_name
from comparisons.models.context import context
from comparisons.models.expected_error import expected_error
from comparisons.models.grids import Elements as Count
from comparisons.models.resolve import Resolved, resolve
from comparisons.models.solve import warm_both
from comparisons.models.spec import Elements, Lattice, Spec, parse, unlike
from comparisons.sweep.differences import error as error  # where others take it from
from comparisons.sweep.here import here, with_room
from comparisons.sweep.load import average
from comparisons.sweep.load import warnings as doubts
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
    """Return the answers of a lattice and a reference side by side, as `comparisons.cli.compare` says.

    companion: also uniform springs in cells of one size, as `lumped-uniform`, where the lattice leaves its
    calibration open. The reference has the lattice's branch. A name of `models` that is taken is changed.
    settle: begin every model where its motion comes to rest (`comparisons.comparison.settle`).

    Raises SceneError for a scene without a static answer, BadInput for choices that do not exist, and the
    solvers' own errors for settings they cannot use. A solve that fails is data: see each solution's status.
    """
    scene = load_static(scene)
    given = {"elements": elements, "law": law, "branch": lattice.branch}
    against = resolve(scene, Elements.given(reference, given))
    first = resolve(scene, lattice)
    named: dict[str, Resolved[Any]] = {first.spec.model: first, against.spec.model: against}
    left_open = lattice.calibration is None and lattice.k is None and first.spec.calibration is not None
    if companion and left_open and not scene.drawn_by and not settle:
        named[COMPANION] = resolve(scene, lattice.but(calibration="uniform", grading=None))
    for other in models:
        beside = resolve(scene, parse(other))
        named[unlike(shown_name(beside.spec.model), named)] = beside
    if not compiled_before(fronts.__file__) and (os.cpu_count() or 1) > 1:  # the first on this machine
        warm_both(first.spec.model, against.spec.model)
    require_settling(named.values() if settle else ())
    rows = []
    for name, model in named.items():
        near, ended = settled(model) if settle else (None, "")
        row = here(model, name, near=near)
        if settle:
            answer, settings = row.answer, {**row.answer.settings, "begun": "motion"}
            answer = replace(answer, settings=settings, remarks=(*answer.remarks, *filter(None, [ended])))
            row = replace(row, answer=answer)
        rows.append(row)
        context().solved(row.answer)
    solutions = [row.answer for row in rows]
    disagreement = ""
    several, begun, other_branch = settle, settle, False
    one_branch = branches.joined(first, against, *solutions[:2])
    if one_branch is not None:
        several, begun = True, settle or one_branch[1] is not solutions[1]
        solutions[0], solutions[1], disagreement = one_branch
    finer = partial(with_room, scene)
    expected = None if settle else expected_error(scene, first.spec, solutions[0], finer)
    bar = None
    alone = begun or solutions[1].status is Status.UNSTABLE  # coarser meshes may be on another branch
    wanted = against.spec.kind in CHEAP if uncertainty is None else uncertainty
    if wanted and solutions[1].comparable and not alone:
        meshes = [against.spec.but(count=n) for n in coarser(against.spec.elements)[1:]]
        bar = error_bar([rows[1], *map(here, (resolve(scene, mesh) for mesh in meshes))])
    answers, within = tuple(solutions), None if bar is None else bar.error
    if not disagreement:
        disagreement, other_branch = far_apart_note(first, answers, within, finer)
    known, busy = several or other_branch, tuple(doubts([{"load_average": average()}]))
    law_chosen = against.spec.law is not None
    return Comparison(scene, answers, bar, disagreement, expected, known, other_branch, busy, law_chosen)


def load_static(scene: AnyScene) -> Scene:
    """Return the scene, that of a catalogue name or file refused by that name if its supports leave it free
    to move."""
    loaded = scene_of(scene)
    try:
        require_static(loaded)
    except SceneError as free:
        if isinstance(scene, Scene):
            raise
        raise SceneError(f"{scene}: {free}") from None
    return loaded
