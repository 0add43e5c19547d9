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
from dataclasses import asdict, dataclass
from functools import partial
from itertools import islice
from typing import Any, Unpack

import numpy as np

from comparisons.runs.campaign import CampaignKeywords, Run, carry_out
from comparisons.runs.store import Finished, Store
from sheetbench.answers.answer import Answer
from sheetbench.answers.files import write_text
from sheetbench.answers.report import Write
from sheetbench.answers.table import Table
from sheetbench.scenes import Scene, Status
from sheetbench.scenes.summary import few
from studies.coverage import tables
from studies.coverage.scenes import SEED, drawn_scenes

TRUTH = {"plate": 48, "shell": 32, "solid": 24}  # elements along the shorter side
MODELS = tuple(TRUTH)
MESHES = (8, 16)
SCENES = 40
GOAL, LOOSE = 0.95, 5.0  # share inside, and median of bar/error, that are asked for
LEAST = 1e-6


@dataclass(frozen=True)
class Component:
    """A component of the displacement at a probe: answer, truth and bar [m], observed order, nan if none."""

    scene: str
    model: str
    elements: int
    probe: str
    component: str
    answer: float
    truth: float
    bar: float
    order: float

    @property
    def error(self) -> float:
        """|u − u_true| [m]."""
        return abs(self.answer - self.truth)

    @property
    def inside(self) -> bool:
        """Whether the bar holds the error."""
        return self.error <= self.bar


@dataclass(frozen=True, repr=False)
class Coverage(Answer):
    """components: of all scenes, models and meshes; scenes: their names; skipped: scenes that were replaced,
    and why; truth: elements of the truth by model."""

    file_name = "coverage"

    components: tuple[Component, ...]
    scenes: tuple[str, ...]
    skipped: dict[str, str]
    truth: Mapping[str, int]

    def rows(self) -> list[dict[str, Any]]:
        """A row per model and mesh."""
        keys = dict.fromkeys((c.model, c.elements) for c in self.components)
        return [_row(model, n, self.of(model, n)) for model, n in keys]

    def of(self, model: str, elements: int) -> list[Component]:
        """The components of a model on a mesh."""
        return [c for c in self.components if (c.model, c.elements) == (model, elements)]

    @property
    def succeeded(self) -> bool:
        """Whether every bar holds as often as is asked for, and is no looser."""
        return all(row["met"] for row in self.rows())

    def heading(self) -> tuple[str, str, str]:
        return "coverage", "how often the references' error bars hold the error, on drawn scenes", ""

    def document(self) -> dict[str, Any]:
        return {
            "rows": self.rows(),
            "scenes": list(self.scenes),
            "skipped": self.skipped,
            "truth": dict(self.truth),
            "components": [{**asdict(c), "inside": c.inside} for c in self.components],
        }

    def tables(self) -> tuple[Table, ...]:
        return tables.shares(self), tables.misses(self)

    def notes(self) -> list[str]:
        inside = (
            "inside: error ≤ bar. The truth is the same model on a finer graded mesh. Asked for: at least "
            "95 % inside, and a median bar of no more than five times the error."
        )
        replaced = f"Replaced, for a model did not converge on a mesh: {', '.join(self.skipped)}."
        return [inside, *([replaced] if self.skipped else [])]

    def complaints(self) -> list[str]:
        return [
            f"{row['model']}, {row['elements']} elements: {100.0 * row['inside']:.1f} % inside, "
            f"the median bar {few(row['loose'])} times the error"
            for row in self.rows()
            if not row["met"]
        ]

    def files(self) -> dict[str, Write]:
        return {"components.csv": partial(write_text, text=tables.components(self).to_csv())}

    def choices(self) -> dict[str, Any]:
        return {"scenes": len(self.scenes)}


def _row(model: str, elements: int, components: Sequence[Component]) -> dict[str, Any]:
    inside = float(np.mean([c.inside for c in components]))
    ratios = [c.bar / c.error for c in components if c.error > 0.0]
    loose = float(np.median(ratios)) if ratios else float("nan")
    return {
        "model": model,
        "elements": elements,
        "scenes": len({c.scene for c in components}),
        "components": len(components),
        "inside": inside,
        "loose": loose,
        "farthest": max((c.error / c.bar for c in components if c.bar > 0.0), default=float("nan")),
        "met": inside >= GOAL and not loose > LOOSE,
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
    from fem_reference.uncertainty import coarser

    sizes = sorted({n for mesh in meshes for n in coarser(mesh) if isinstance(n, int)})

    def answers(scenes: Sequence[Scene]) -> list[dict[tuple[str, int], Finished]]:
        """Of every scene on every mesh, the dear ones on scenes that the cheap ones have not ruled out."""
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
    """The components of a model's answers: rows of `tasks.answer` by their meshes, that of the truth too."""
    from fem_reference.edge_layer import missed_by
    from fem_reference.uncertainty import coarser, estimate, mesh_size

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
    return Run("studies.coverage.tasks:answer", arguments | graded, f"{scene.name} {model} {elements}")


def _failure(outcomes: dict[tuple[str, int], Finished]) -> str | None:
    """The first model and mesh without a converged answer, and how that ended."""
    for (model, elements), done in outcomes.items():
        if done.status != Status.CONVERGED:
            return f"{model} on {elements} elements: {done.status}: {done.message}"
    return None
