"""Are promises about errors kept? Bars of the references and advice on scenes drawn at random.

bar      of a component of the displacement at a probe, from the answers on n, ¾ n and ½ n elements
         (`fem_reference.uncertainty`); the truth is the same model on a much finer mesh, graded towards the
         edges: a bar is about the mesh, not about the model. Components below `LEAST` of the largest
         displacement are rounding, and what a support prescribes has no error: neither counts. The rule that
         makes the bars was set on scenes of other seeds (14, 27 and 53)
advice   the tolerance that a choice was requested for; the truth is the shell. Its time is compared with that
         of the cheapest of a dozen rows within the tolerance, all of whole sheets

A scene on which a model does not converge on every mesh is replaced by the next one drawn.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import islice
from typing import Any, Unpack

import numpy as np

from comparisons.advice.advisor import advise
from comparisons.comparison.comparison import error
from comparisons.models.context import running
from comparisons.models.resolve import resolve
from comparisons.models.solve import solve
from comparisons.models.spec import Elements, Spec, lattices, references, spec_of
from comparisons.runs.campaign import CampaignKeywords, Run, carry_out
from comparisons.runs.store import Finished, Store
from comparisons.tradeoff import timing
from fem_reference.edge_layer import missed_by
from fem_reference.uncertainty import coarser, estimate, mesh_size
from sheetbench.scenes import Scene, Status
from studies.promises.answer import Promise
from studies.promises.scenes import SEED, drawn_scenes

TRUTH = {"plate": 48, "shell": 32, "solid": 24}  # elements along the shorter side
MODELS, MESHES, SCENES = tuple(TRUTH), (8, 16), 40
TOLERANCES, COMPARED = (0.005, 0.01, 0.02, 0.05), 20
LEAST = 1e-6


def answer(scene: dict[str, Any], model: str, elements: int, graded: bool = False) -> dict[str, Any]:
    """Return a model's displacement [m] at the scene's probes and its settings; a task, so plain data.

    graded: finer towards the edges, where a model chooses.
    """
    parsed = Scene.model_validate(scene)
    with running(large=True):
        return _found(parsed, Elements(model, elements, graded=graded or None))


def advice(scene: dict[str, Any], tolerance: float) -> dict[str, Any]:
    """Return the advised model and its answer; a task."""
    parsed = Scene.model_validate(scene)
    given = advise(parsed, tolerance)
    if given.choice is None:
        return {"status": "none", "message": given.message}
    return {**_found(parsed, given.choice), "choice": given.document()["choice"]}


def _found(scene: Scene, spec: Spec) -> dict[str, Any]:
    solution = solve(resolve(scene, spec))
    known = {"status": str(solution.status), "message": solution.message, "settings": solution.settings}
    return known | {"displacement": solution.displacement(scene.probe_points())}


def bars(
    store: Store, count: int = SCENES, models: Sequence[str] = MODELS, meshes: Sequence[int] = MESHES,
    truth: Mapping[str, int] = TRUTH, seed: int = SEED, **how: Unpack[CampaignKeywords],
) -> tuple[list[Promise], dict[str, str]]:  # fmt: skip
    """Return the bars of the models on the meshes on `count` drawn scenes, and which scenes were replaced and
    why. truth: elements of the truth by model."""
    sizes = sorted({n for mesh in meshes for n in coarser(mesh) if isinstance(n, int)})
    wanted = [(model, n) for model in models for n in (*sizes, truth[model])]
    found: list[Promise] = []
    solved, skipped = _drawn(store, count, wanted, truth, seed, **how)
    for scene, rows in solved:
        for model in models:
            of_model = {n: row for (name, n), row in rows.items() if name == model}
            found += [row for n in meshes for row in measured(scene, model, n, of_model, truth)]
    return found, skipped


def _drawn(
    store: Store, count: int, wanted: Sequence[tuple[str, int]], truth: Mapping[str, int], seed: int,
    **how: Unpack[CampaignKeywords],
) -> tuple[list[tuple[Scene, dict[tuple[str, int], dict[str, Any]]]], dict[str, str]]:  # fmt: skip
    """Return drawn scenes with the rows of `answer` by model and elements, and the scenes that were replaced.

    Raises RuntimeError where every solve of a draw fails, as after the code has changed under a run: other
    scenes would too.
    """
    endless, skipped = drawn_scenes(seed), dict[str, str]()
    solved: list[tuple[Scene, dict[tuple[str, int], dict[str, Any]]]] = []
    while len(solved) < count:
        drawn = list(islice(endless, count - len(solved)))
        runs = [_run(scene, model, n, n == truth[model]) for scene in drawn for model, n in wanted]
        done = carry_out(runs, store, **how)
        if all(one.status == "failed" for one in done):
            raise RuntimeError(done[0].message)
        for i, scene in enumerate(drawn):
            ends = dict(zip(wanted, done[i * len(wanted) : (i + 1) * len(wanted)], strict=True))
            if failure := next(filter(None, map(_failure, ends.items())), None):
                skipped[scene.name] = failure
            else:
                solved.append((scene, {key: one.row for key, one in ends.items()}))
    return solved, skipped


def _run(scene: Scene, model: str, elements: int, fine: bool) -> Run:
    arguments = {"scene": scene.document(), "model": model, "elements": elements}
    graded = {"graded": True} if fine and model == "plate" else {}  # the others are graded as they are
    return Run(f"{__name__}:answer", arguments | graded, f"{scene.name} {model} {elements}")


def _failure(end: tuple[tuple[str, int], Finished]) -> str | None:
    (model, elements), done = end
    if done.status == Status.CONVERGED:
        return None
    return f"{model} on {elements} elements: {done.status}: {done.message}"


def measured(
    scene: Scene, model: str, elements: int, rows: Mapping[int, Mapping[str, Any]],
    truth: Mapping[str, int] = TRUTH,
) -> Iterator[Promise]:  # fmt: skip
    """Return the bars of a model's components: rows of `answer` by their meshes, that of the truth too."""
    meshes = [n for n in coarser(elements) if isinstance(n, int)]
    answers = [np.array(rows[n]["displacement"]) for n in meshes]
    layers = [missed_by(scene, rows[n]["settings"]) for n in meshes]
    uncertainty = estimate(answers, [mesh_size(scene, n) for n in meshes], layers)
    fine = np.array(rows[truth[model]]["displacement"])
    size = float(np.max(np.abs(fine), initial=0.0))
    changed = ~(uncertainty.trusted & np.isnan(uncertainty.order))
    counted = changed & (np.maximum(np.abs(uncertainty.answer), np.abs(fine)) > LEAST * size)
    for i, axis in zip(*np.nonzero(counted), strict=True):
        where = f"{('ux', 'uy', 'uz')[axis]} of {list(scene.probes)[i]}"
        bar, off = uncertainty.bar[i, axis], abs(uncertainty.answer[i, axis] - fine[i, axis])
        yield Promise("bar", f"{model} {elements}", scene.name, where, float(bar / size), float(off / size))


def advised(
    store: Store, count: int = SCENES, compared: int = COMPARED, tolerances: Sequence[float] = TOLERANCES,
    truth: Mapping[str, int] = TRUTH, seed: int = SEED, **how: Unpack[CampaignKeywords],
) -> tuple[list[Promise], dict[str, str]]:  # fmt: skip
    """Return the tolerances and errors of advice on `count` drawn scenes, on the first `compared` of them its
    cost, and which scenes were replaced and why."""
    solved, skipped = _drawn(store, count, [("shell", truth["shell"])], truth, seed, **how)
    cases = [(scene, tolerance) for scene, _ in solved for tolerance in tolerances]
    runs = [
        Run(f"{__name__}:advice", {"scene": s.document(), "tolerance": t}, f"{s.name} {t:g}", timed=True)
        for s, t in cases
    ]
    outcomes = dict(zip(((s.name, t) for s, t in cases), carry_out(runs, store, **how), strict=True))
    found = []
    for number, (scene, rows) in enumerate(solved):
        fine = np.array(rows["shell", truth["shell"]]["displacement"])
        rivals = rows_of(scene) if number < compared else []
        for tolerance in tolerances:
            row = outcomes[scene.name, tolerance].row
            off = error(np.array(row["displacement"]), fine) if "displacement" in row else None
            actual = float("inf") if off is None else off
            cost = (
                _cost(scene, row["choice"], rivals, tolerance, fine, store, **how)
                if rivals and off is not None
                else None
            )
            found.append(
                Promise("advice", f"{100.0 * tolerance:g} %", scene.name, "", tolerance, actual, cost)
            )
    return found, skipped


def rows_of(scene: Scene) -> list[Spec]:
    """Return the dozen rows that advice is compared with."""
    own = lattices(scene, ["3", "5", "9", "17"], ["consistent"]) + lattices(scene, ["5"], ["uniform"])
    return [*own, *references("plate", ["4"]), *references("shell", ["2", "3", "4", "6", "8", "12"])]


def _cost(
    scene: Scene, choice: dict[str, Any], rivals: Sequence[Spec], tolerance: float, fine: np.ndarray,
    store: Store, **how: Unpack[CampaignKeywords],
) -> float | None:  # fmt: skip
    """Return the time of a choice over that of the cheapest rival within the tolerance, None without one."""
    specs = [spec_of(choice["model"], choice["settings"]), *rivals]
    own, *others = carry_out([timing.run(scene, spec) for spec in specs], store, **how)
    usable = [one for one in others if one.status == Status.CONVERGED]
    errors = [error(np.array([*one.row["probes"].values()]), fine) for one in usable]
    times = [one.row["solve_seconds"]["median"] for one in usable]
    within = [time for time, off in zip(times, errors, strict=True) if off is not None and off <= tolerance]
    return float(own.row["solve_seconds"]["median"] / min(within)) if within else None
