"""Does the error bar hold the error? How many components lie inside their bars, on drawn scenes.

    error    |u − u_true| of a component of the displacement at a probe
    bar      what `fem_reference.uncertainty` makes of the answers on n, ¾ n and ½ n elements
    inside   error ≤ bar
    loose    bar/error, its median over the components

The truth is the same model's answer on a much finer mesh that is graded towards the edges (`TRUTH`): a bar
speaks of the mesh, not of the model. A scene on which one of the models does not converge on every mesh is
replaced by the next. Components below `LEAST` of the scene's largest displacement are rounding and count for
nothing, as do those that no mesh changes but by rounding: what a support prescribes has no error. The rule
that makes the bars was set on the scenes of other seeds (14, 27 and 53) than `SEED`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import islice
from typing import Any, Unpack

import numpy as np

from comparisons.models.context import running
from comparisons.models.resolve import resolve
from comparisons.models.solve import solve
from comparisons.models.spec import Elements
from comparisons.runs.campaign import CampaignKeywords, Run, carry_out
from comparisons.runs.store import Finished, Store
from fem_reference.edge_layer import missed_by
from fem_reference.uncertainty import coarser, estimate, mesh_size
from sheetbench.scenes import Scene, Status
from studies.coverage.answer import Component, Coverage
from studies.coverage.scenes import SEED, drawn_scenes

TRUTH = {"plate": 48, "shell": 32, "solid": 24}  # elements along the shorter side
MODELS = tuple(TRUTH)
MESHES = (8, 16)
SCENES = 40
LEAST = 1e-6


def answer(scene: dict[str, Any], model: str, elements: int, graded: bool = False) -> dict[str, Any]:
    """Return a model's displacement [m] at the scene's probes and its settings; a task, so plain data.

    graded: finer towards the edges, where a model chooses.
    """
    parsed = Scene.model_validate(scene)
    with running(large=True):
        solution = solve(resolve(parsed, Elements(model, elements, graded=graded or None)))
    return {
        "status": str(solution.status),
        "message": solution.message,
        "settings": solution.settings,
        "displacement": solution.displacement(parsed.probe_points()),
    }


def coverage(
    store: Store,
    *,
    count: int = SCENES,
    models: Sequence[str] = MODELS,
    meshes: Sequence[int] = MESHES,
    truth: Mapping[str, int] = TRUTH,
    seed: int = SEED,
    **how: Unpack[CampaignKeywords],
) -> Coverage:
    """Measure the bars of the models on the meshes on `count` drawn scenes, through a campaign's store.

    truth: elements of the truth by model. Raises RuntimeError where every solve of a draw fails, as after the
    code has changed under a run: other scenes would too.
    """
    sizes = sorted({n for mesh in meshes for n in coarser(mesh) if isinstance(n, int)})

    def answers(scenes: Sequence[Scene]) -> list[dict[tuple[str, int], Finished]]:
        """Solve on every mesh; on fine ones only the scenes that have answers on the coarser."""
        outcomes: list[dict[tuple[str, int], Finished]] = [{} for _ in scenes]
        for batch in (sizes[:1], sizes[1:], None):
            left = [i for i, one in enumerate(outcomes) if _failure(one) is None]
            runs = [
                (i, (model, n), _run(scenes[i], model, n, batch is None))
                for i in left
                for model in models
                for n in ([truth[model]] if batch is None else batch)
            ]
            done = carry_out([run for *_, run in runs], store, **how)
            for (i, key, _), outcome in zip(runs, done, strict=True):
                outcomes[i][key] = outcome
        return outcomes

    endless, chosen, skipped = drawn_scenes(seed), list[str](), dict[str, str]()
    components: list[Component] = []
    while len(chosen) < count:
        drawn = list(islice(endless, count - len(chosen)))
        of_scenes = answers(drawn)
        ends = [list(outcomes.values())[-1] for outcomes in of_scenes]
        if all(end.status == "failed" for end in ends):
            raise RuntimeError(ends[0].message)
        for scene, outcomes in zip(drawn, of_scenes, strict=True):
            if (failure := _failure(outcomes)) is not None:
                skipped[scene.name] = failure
                continue
            chosen.append(scene.name)
            for model in models:
                of_model = {n: done.row for (name, n), done in outcomes.items() if name == model}
                components += [c for n in meshes for c in measured(scene, model, n, of_model, truth)]
    return Coverage(tuple(components), tuple(chosen), skipped, truth)


def measured(
    scene: Scene,
    model: str,
    elements: int,
    rows: Mapping[int, Mapping[str, Any]],
    truth: Mapping[str, int] = TRUTH,
) -> Iterator[Component]:
    """The components of a model's answers: rows of `answer` by their meshes, that of the truth too."""
    meshes = [n for n in coarser(elements) if isinstance(n, int)]
    answers = [np.array(rows[n]["displacement"]) for n in meshes]
    layers = [missed_by(scene, rows[n]["settings"]) for n in meshes]
    uncertainty = estimate(answers, [mesh_size(scene, n) for n in meshes], layers)
    fine = np.array(rows[truth[model]]["displacement"])
    least = LEAST * float(np.max(np.abs(fine), initial=0.0))
    changed = ~(uncertainty.trusted & np.isnan(uncertainty.order))
    for i, probe in enumerate(scene.probes):
        for axis, name in enumerate(("ux", "uy", "uz")):
            values = (
                float(a[i, axis]) for a in (uncertainty.answer, fine, uncertainty.bar, uncertainty.order)
            )
            one = Component(scene.name, model, elements, probe, name, *values)
            if changed[i, axis] and max(abs(one.answer), abs(one.truth)) > least:
                yield one


def _run(scene: Scene, model: str, elements: int, fine: bool) -> Run:
    arguments = {"scene": scene.document(), "model": model, "elements": elements}
    graded = {"graded": True} if fine and model == "plate" else {}  # the others are graded as they are
    return Run("studies.coverage.study:answer", arguments | graded, f"{scene.name} {model} {elements}")


def _failure(outcomes: dict[tuple[str, int], Finished]) -> str | None:
    """The first model and mesh without a converged answer, and how that ended."""
    for (model, elements), done in outcomes.items():
        if done.status != Status.CONVERGED:
            return f"{model} on {elements} elements: {done.status}: {done.message}"
    return None
