"""Where each model of a scene holds, degrades, refuses or fails, as one thing about the sheet is varied.

load         the weight and all loads, times a factor
slenderness  the thickness, times a factor
young        Young's modulus, times a factor
obstacle     the distance of obstacles from the flat sheet, times a factor
grid         the cells of the lattice, the elements of the references, along the shorter side
damping      the damping time, such that the lowest mode has a share of critical damping: how runs of every
             integrator with its default steps end, and the largest stable step of the explicit ones
time-step    the steps of every integrator: shares of the largest of explicit ones, else of the lowest period

At rest, an error is the one at the probes against the reference on the same sheet, on the grid study against
its finest mesh; in motion, the largest difference from a run of the midpoint rule with a fine step, over the
largest displacement.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Collection, Iterator, Mapping
from functools import partial
from typing import Any, Unpack

import numpy as np

import lumped
from comparisons.models.grids import Elements as Count
from comparisons.models.resolve import resolve
from comparisons.models.spec import Elements, Lattice, Spec
from comparisons.stability.answer import Stability
from comparisons.stability.rows import Row
from comparisons.sweep.campaign import CampaignKeywords
from comparisons.sweep.differences import error
from comparisons.sweep.solved import Ask, Solved, sweep
from comparisons.sweep.store import Store
from sheetbench.answers.solution import Status
from sheetbench.choices import INTEGRATORS, REFERENCE, VARIED
from sheetbench.errors import BadInput
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.distances import farther
from sheetbench.scenes.meaning.parameters import put
from sheetbench.scenes.objects.layers import Layer
from sheetbench.scenes.objects.orthotropy import MODULI
from sheetbench.scenes.objects.patches import Patch

Cell = tuple[Ask, Ask | str | None]  # a run, and what its error is against, or why it is refused
FACTORS = {
    "load": (0.001, 0.01, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 1000.0),
    "slenderness": (0.03, 0.1, 0.3, 1.0, 3.0, 10.0),
    "young": (0.001, 0.01, 0.1, 1.0, 10.0, 100.0, 1000.0),
    "obstacle": (0.1, 0.3, 1.0, 2.0, 3.0),
}
CELLS = {"lumped": (2, 4, 8, 16, 32), "references": (2, 4, 8)}  # along the shorter side
DAMPING = (0.0, 0.01, 0.1, 1.0, 10.0, 100.0)  # of the lowest mode's critical one
SHARES = (0.3, 0.9, 1.1)  # of the largest stable step
DIVISIONS = (200, 50, 20, 8, 4, 2, 1)  # steps a period
FINE, SAMPLES = 400, 40  # steps of the midpoint rule and samples, a period
PERIODS = 3.0  # of a run
PARTS = ("patches", "layers")
RUN_STEPS, RUN_PERIODS = 500, 2.0  # of a run with default steps: explicit steps, lowest periods, at most


def stability(
    scene: Scene,
    store: Store,
    *,
    varied: Collection[str] = tuple(VARIED),
    lattice: Lattice = Lattice(),  # noqa: B008  # frozen
    reference: str = REFERENCE,
    elements: Count = 12,
    **how: Unpack[CampaignKeywords],
) -> Stability:
    """Vary a scene's sheet and solve it by every model, through a campaign's store.

    varied: some of `choices.VARIED`. lattice: with what is not varied. elements: of the references, along the
    shorter side or along x and y. Raises BadInput for what cannot be varied, for settings that contradict
    each other, and for models that take more memory than there is.
    """
    resolve(scene, lattice, "motion")
    resolve(scene, Elements(reference, elements))
    kinds = dict.fromkeys(("plate", "shell", reference))
    models = {lattice.model: lattice, **{kind: Elements(kind, elements) for kind in kinds}}
    moving = not {"damping", "time-step"}.isdisjoint(varied)
    period = lumped.shortest_period(scene, resolve(scene, lattice).springs) if moving else 0.0
    truth = models[reference]
    makers: dict[str, Callable[[], Iterator[Cell]]] = {
        **{name: partial(_scaled, scene, name, models, truth) for name in FACTORS},
        "grid": partial(_grids, scene, models, truth),
        "damping": partial(_damped, scene, lattice, period),
        "time-step": partial(_stepped, scene, lattice, period),
    }
    cells = [cell for name in VARIED if name in varied for cell in makers[name]()]
    asks = [one for cell in cells if not isinstance(cell[1], str) for one in cell if isinstance(one, Ask)]
    solved = {id(row.ask): row for row in sweep(asks, store, **how)}
    refused = str(Status.REFUSED)
    rows = tuple(
        _row(solved.get(id(ask)) or Solved(ask, refused, str(why)), solved.get(id(why))) for ask, why in cells
    )
    return Stability(scene, reference, period or None, rows)


def _tags(study: str, **cell: Any) -> dict[str, Any]:
    return {"study": study, "cell": cell}


def _scaled(scene: Scene, name: str, models: Mapping[str, Spec], truth: Spec) -> Iterator[Cell]:
    there_is = {"load": scene.gravity or scene.loads, "obstacle": scene.obstacles}
    if not there_is.get(name, True):
        return
    for factor in FACTORS[name]:
        label, refusal, there = f"{name} × {factor:g}", "", scene
        try:
            there = scaled(scene, name, factor)
        except BadInput as impossible:
            refusal = str(impossible)
        against = Ask(there, truth, label=f"{truth.model} {label}")
        for model, spec in models.items():
            tags = _tags(name, factor=factor, model=model)
            yield Ask(there, spec, tags=tags, label=f"{model} {label}"), refusal or against


def _grids(scene: Scene, models: Mapping[str, Any], truth: Any) -> Iterator[Cell]:
    meshes = {n: n for n in CELLS["references"]} | {min(truth.counts(scene)[:2]): truth.count}
    finest = max(meshes)
    against = Ask(scene, truth.but(count=meshes[finest]), label=f"{truth.model} {finest} cells")
    for model, spec in models.items():
        for count in CELLS.get(model) or sorted(meshes):
            sized = spec.but(grid=count + 1) if spec.MASSES else spec.but(count=meshes[count])
            tags = _tags("grid", cells=count, model=model)
            yield Ask(scene, sized, tags=tags, label=f"{model} {count} cells"), against


def _damped(scene: Scene, lattice: Lattice, period: float) -> Iterator[Cell]:
    for ratio in (None, *DAMPING):
        there = scene
        if ratio is not None:
            damping = {"damping_time": ratio * period / np.pi, "damping_rate": 0.0}
            there = scene.replace(material=scene.material.replace(**damping))
        springs = resolve(there, lattice, "springs").springs
        for name, integrator in lumped.INTEGRATORS.items():
            tags, duration = _tags("damping", damping_ratio=ratio, integrator=name), RUN_PERIODS * period
            if integrator.explicit and not scene.chains():  # else it is refused
                flat = there.replace(gravity=None, loads=())
                equations = lumped.System(flat, lumped.build_problem(flat, springs))
                limit = integrator.limit(equations, np.zeros_like(equations.problem.loads.dead))
                assert limit is not None
                tags |= {"computed": limit.step, "advised": limit.advised}
                duration = min(duration, RUN_STEPS * limit.advised)
            label = f"{name} {'own damping' if ratio is None else f'damping {ratio:g}'}"
            how: dict[str, Any] = {"duration": duration, "every": duration / SAMPLES, "label": label}
            yield Ask(there, lattice, run={"integrator": name}, tags=tags, **how), None


def _stepped(scene: Scene, lattice: Lattice, period: float) -> Iterator[Cell]:
    def ask(name: str, step: float) -> Ask:
        return Ask(
            scene,
            lattice,
            duration=PERIODS * period,
            every=max(step, period / SAMPLES),
            run={"integrator": name, "step": step},
            tags=_tags("time-step", integrator=name, step=step),
            label=f"{name} {step:.3g} s",
        )

    against = ask("midpoint", period / FINE)
    for name in INTEGRATORS:
        steps = [period / n for n in DIVISIONS]
        if lumped.INTEGRATORS[name].explicit and not scene.chains():  # else it is refused
            limit = lumped.explicit_limit(name, scene, resolve(scene, lattice).springs)
            steps = [share * limit for share in SHARES]
        yield from ((ask(name, step), against) for step in steps)


def scaled(scene: Scene, name: str, factor: float) -> Scene:
    """Return the scene with its load, thickness, moduli or distance from obstacles times a factor, those of
    patches and layers too. Raises BadInput where it cannot be."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # extremes are implausible
        if name == "young":
            parts = {key: tuple(_stiffer(each, factor) for each in getattr(scene, key)) for key in PARTS}
            return put(scene, "young", factor * scene.material.young).replace(**parts)
        if name == "slenderness":
            patches = [
                patch.replace(thickness=factor * patch.thickness) if patch.thickness else patch
                for patch in scene.patches
            ]
            return put(scene, "thickness", factor * scene.sheet.thickness).replace(patches=tuple(patches))
        if name == "obstacle":
            return scene.replace(obstacles=tuple(farther(scene, one, factor) for one in scene.obstacles))
        acting = {"loads": tuple(load.times(factor) for load in scene.loads)}
        return scene.replace(gravity=scene.gravity and scene.gravity.times(factor), **acting)


def _stiffer(part: Patch | Layer, factor: float) -> Patch | Layer:
    """Return a patch or a layer, its own moduli times a factor."""
    own = {key: factor * part.own[key] for key in ("young", *MODULI) if key in part.own}
    return part.replace(**own) if own else part


def _row(found: Solved, truth: Solved | None) -> Row:
    """Return a cell's row: how it ended, and its error where its reference has an answer too."""
    steps = found.row.get("iterations") or found.row.get("steps")
    row: Row = {**found.ask.tags, "error": None, "iterations": steps, "seconds": found.run_seconds}
    row |= {"status": found.status, "message": found.message}
    if truth is None or not found.stable or not truth.stable:
        return row
    if (found.ask.spec, found.ask.run) == (truth.ask.spec, truth.ask.run):
        return row
    if found.ask.duration is not None:
        return {**row, "error": _motion_error(found.row, truth.row)}
    return {**row, "error": error(found.u, truth.u)}


def _motion_error(row: Mapping[str, Any], truth: Mapping[str, Any]) -> float | None:
    """Return the largest difference of the probes' displacements over the largest displacement, None at
    rest."""
    largest = off = 0.0
    for name, known in truth["probes"].items():
        expected = np.transpose([np.interp(row["time"], truth["time"], axis) for axis in np.transpose(known)])
        off = max(off, float(np.abs(np.array(row["probes"][name]) - expected).max()))
        largest = max(largest, float(np.abs(known).max()))
    return off / largest if largest > 0.0 else None
