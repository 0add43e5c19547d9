"""Test of promises about errors: bars of the references and advice on scenes drawn at random.

bar      of a component of the displacement at a probe, from the answers on n, ¾ n and ½ n elements
         (`fem_reference.uncertainty`); the truth is the model on a much finer mesh, graded towards the
         edges: a bar is about the mesh, not about the model. Components below `LEAST` of the largest
         displacement are rounding, and prescribed components have no error: neither counts. The rule that
         makes the bars was set on scenes of other seeds (14, 27 and 53)
advice   the tolerance that a choice was requested for; the truth is the shell. The choice's time is
         compared with the cheapest of a dozen rows within the tolerance, all of whole sheets

Bars of the shell and expected errors of a lattice (`comparisons.models.expected_error`) are also counted by
the kind of scene (`studies.promises.scenes.KINDS`); the truth of both is the shell.

A scene on which a model does not converge on every mesh is replaced by the next one drawn.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import islice
from typing import Any, Unpack

import numpy as np

from comparisons.models.expected_error import NoEstimate, expected_error
from comparisons.models.resolve import resolve
from comparisons.models.solve import solve
from comparisons.models.spec import Elements, Lattice, Spec, lattices, references, spec_of
from comparisons.sweep.campaign import CampaignKeywords, Run, carry_out
from comparisons.sweep.differences import error
from comparisons.sweep.limits import limit
from comparisons.sweep.solved import Request, Solved, sweep
from comparisons.sweep.store import Store
from comparisons.tradeoff.advisor import advise
from fem_reference.uncertainty import coarser
from sheetbench.answers.solution import Status
from sheetbench.scenes import Scene
from studies.promises.answer import Promise
from studies.promises.scenes import KINDS, SEED, drawn_scenes, scenes_of_kinds

TRUE_ELEMENTS = {"plate": 48, "shell": 32, "solid": 24}  # elements along the shorter side
MODELS, MESHES, SCENES = tuple(TRUE_ELEMENTS), (8, 16), 40
MASSES, BY_KIND = 9, 12  # of the lattice, elements of the shell
TOLERANCES, COMPARED = (0.005, 0.01, 0.02, 0.05), 20
LEAST = 1e-6


Row = dict[tuple[str, int], Solved]  # of a scene, by model and elements


def bars(
    store: Store, count: int = SCENES, models: Sequence[str] = MODELS, meshes: Sequence[int] = MESHES,
    truth: Mapping[str, int] = TRUE_ELEMENTS, seed: int = SEED, **how: Unpack[CampaignKeywords],
) -> tuple[list[Promise], dict[str, str]]:  # fmt: skip
    """Return the bars of the models on the meshes on `count` drawn scenes, and the replaced scenes with the
    reason. truth: elements of the truth by model."""
    sizes = sorted({n for mesh in meshes for n in coarser(mesh) if isinstance(n, int)})
    solves = [(model, n) for model in models for n in (*sizes, truth[model])]
    promises: list[Promise] = []
    solved, skipped = _drawn(store, count, solves, truth, drawn_scenes(seed), **how)
    for scene, rows in solved:
        for model in models:
            for n in meshes:
                of_mesh = [rows[model, m] for m in coarser(n) if isinstance(m, int)]
                promises += measured(scene, f"{model} {n}", of_mesh, rows[model, truth[model]])
    return promises, skipped


def by_kind(
    store: Store, count: int = SCENES, kinds: Sequence[str] = KINDS, elements: int = BY_KIND,
    truth: Mapping[str, int] = TRUE_ELEMENTS, seed: int = SEED, **how: Unpack[CampaignKeywords],
) -> tuple[list[Promise], dict[str, str]]:  # fmt: skip
    """Return bars of the shell and expected errors of the lattice on `count` drawn scenes, of the kinds in
    turn, and the replaced scenes with the reason. elements: of the shell; truth: elements of the truth."""
    meshes = [("shell", n) for n in coarser(elements) if isinstance(n, int)]
    fine, scenes = ("shell", truth["shell"]), scenes_of_kinds(kinds, seed)
    solved, skipped = _drawn(store, count, [*meshes, fine], truth, scenes, **how)
    runs = [Run(f"{__name__}:expected", {"scene": scene.document()}, scene.name) for scene, _ in solved]
    bars, errors = list[Promise](), list[Promise]()
    for (scene, rows), run_end in zip(solved, carry_out(runs, store, **how), strict=True):
        of_meshes, row = [rows[mesh] for mesh in meshes], run_end.row
        off = error(np.array([*row["probes"].values()]), rows[fine].u) if "probes" in row else None
        given = row.get("reason", run_end.message), row.get("estimate"), np.inf if off is None else off
        kind = scene.name.rpartition("-")[0]
        bars += measured(scene, f"shell {elements}", of_meshes, rows[fine], kind)
        errors.append(Promise("expected error", f"{MASSES} masses", scene.name, *given, kind=kind))
    return [*bars, *errors], skipped


def expected(scene: dict[str, Any]) -> dict[str, Any]:
    """Return the lattice's answer in the form of `compare`, with the expected error or the reason against
    one; a task."""
    given = Scene.model_validate(scene)
    lattice = resolve(given, Lattice(MASSES))
    answer = solve(lattice)
    estimate = expected_error(given, lattice.spec, answer, lambda finer: solve(resolve(given, finer)))
    if isinstance(estimate, NoEstimate):
        return {**answer.document(given), "reason": estimate.reason}
    return {**answer.document(given), "estimate": estimate.value}


def _drawn(
    store: Store, count: int, solves: Sequence[tuple[str, int]], truth: Mapping[str, int],
    scenes: Iterator[Scene], **how: Unpack[CampaignKeywords],
) -> tuple[list[tuple[Scene, Row]], dict[str, str]]:  # fmt: skip
    """Return drawn scenes with the requested solves of each, and the scenes that were replaced. The truth is
    graded towards the edges, of the plate by request. Raises RuntimeError where every solve of a draw fails,
    as after the code has changed under a run: other scenes would too."""
    skipped, solved = dict[str, str](), list[tuple[Scene, Row]]()
    specs = [Elements(model, n, graded=(model, n) == ("plate", truth[model]) or None) for model, n in solves]
    while len(solved) < count:
        drawn = list(islice(scenes, count - len(solved)))
        done = sweep([Request(scene, spec) for scene in drawn for spec in specs], store, **how)
        if all(finished.status == Status.FAILED for finished in done):
            raise RuntimeError(done[0].message)
        for i, scene in enumerate(drawn):
            of_scene = done[i * len(solves) : (i + 1) * len(solves)]
            if failure := next((finished.ending for finished in of_scene if not finished.stable), None):
                skipped[scene.name] = failure
            else:
                solved.append((scene, dict(zip(solves, of_scene, strict=True))))
    return solved, skipped


def measured(
    scene: Scene, at: str, rows: Sequence[Solved], truth: Solved, kind: str = ""
) -> Iterator[Promise]:
    """Yield the bars of the components of a model's answers on its meshes. kind: of the scene."""
    uncertainty = limit(rows)
    assert uncertainty is not None
    size = float(np.max(np.abs(truth.u), initial=0.0))
    changed = ~(uncertainty.trusted & np.isnan(uncertainty.order))
    counted = changed & (np.maximum(np.abs(uncertainty.answer), np.abs(truth.u)) > LEAST * size)
    for i, axis in zip(*np.nonzero(counted), strict=True):
        where = f"{('ux', 'uy', 'uz')[axis]} of {list(scene.probes)[i]}"
        bar, off = uncertainty.bar[i, axis], abs(uncertainty.answer[i, axis] - truth.u[i, axis])
        yield Promise("bar", at, scene.name, where, float(bar / size), float(off / size), kind=kind)


def advice(scene: dict[str, Any], tolerance: float) -> dict[str, Any]:
    """Return the advised model; a task."""
    given = advise(Scene.model_validate(scene), tolerance)
    return {"status": "none" if given.choice is None else "done", **given.document()}


def advised(
    store: Store, count: int = SCENES, compared: int = COMPARED, tolerances: Sequence[float] = TOLERANCES,
    truth: Mapping[str, int] = TRUE_ELEMENTS, seed: int = SEED, **how: Unpack[CampaignKeywords],
) -> tuple[list[Promise], dict[str, str]]:  # fmt: skip
    """Return the tolerances and errors of advice on `count` drawn scenes, and the replaced scenes with the
    reason. The first `compared` scenes also have its cost."""
    solved, skipped = _drawn(store, count, [("shell", truth["shell"])], truth, drawn_scenes(seed), **how)
    cases = [(number, scene, t) for number, (scene, _) in enumerate(solved) for t in tolerances]
    runs = [
        Run(f"{__name__}:advice", {"scene": s.document(), "tolerance": t}, f"{s.name} {t:g}", timed=True)
        for _, s, t in cases
    ]
    promises = []
    for (number, scene, tolerance), run_end in zip(cases, carry_out(runs, store, **how), strict=True):
        actual, cost = float("inf"), None
        if run_end.row.get("choice"):
            choice = spec_of(run_end.row["choice"]["model"], run_end.row["choice"]["settings"])
            specs = [choice, *(rows_of(scene) if number < compared else ())]
            requests = [Request(scene, spec, repeats=5 if number < compared else 0) for spec in specs]
            (choice_row, *rivals), (fine,) = sweep(requests, store, **how), solved[number][1].values()
            off = error(choice_row.u, fine.u) if choice_row.usable else None
            actual = float("inf") if off is None else off
            cost = _cost(choice_row, rivals, tolerance, fine)
        promises.append(
            Promise("advice", f"{100.0 * tolerance:g} %", scene.name, "", tolerance, actual, cost)
        )
    return promises, skipped


def rows_of(scene: Scene) -> list[Spec]:
    """Return the dozen rows that advice is compared with."""
    specs = lattices(scene, ["3", "5", "9", "17"], ["consistent"]) + lattices(scene, ["5"], ["uniform"])
    return [*specs, *references("plate", ["4"]), *references("shell", ["2", "3", "4", "6", "8", "12"])]


def _cost(choice: Solved, rivals: Sequence[Solved], tolerance: float, fine: Solved) -> float | None:
    """Return the time of a choice over the cheapest rival within the tolerance, None without one."""
    errors = [(rival.seconds, error(rival.u, fine.u)) for rival in rivals if rival.stable]
    times = [time for time, off in errors if time and off is not None and off <= tolerance]
    return choice.seconds / min(times) if times and choice.seconds else None
