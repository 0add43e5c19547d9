"""Runs of every model of a scene for extreme values of one parameter at a time.

load         weight and all loads, times a factor slenderness  thickness, times a factor young        Young's
modulus, times a factor obstacle     distance of obstacles from the flat sheet, times a factor grid
cells of the lattice, elements of the references, along the shorter side damping      damping time, for a
fraction of critical damping of the lowest mode: runs of every integrator with its default steps, and the
largest stable step of explicit integrators time-step    step of every integrator: fractions of the largest
stable step of explicit integrators, else of the lowest period

Errors at rest are errors at the probes against the reference on the sheet with equal parameters, in the grid
study against its finest mesh. Errors in motion are the largest difference from a run of the midpoint rule
with a fine step, over the largest displacement.
"""

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
from comparisons.sweep.solved import Request, Solved, sweep
from comparisons.sweep.store import Store
from sheetbench.answers.solution import Status
from sheetbench.choices import INTEGRATORS, REFERENCE, VARIED
from sheetbench.errors import BadInput
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.distances import scale_distance
from sheetbench.scenes.meaning.parameters import put
from sheetbench.scenes.objects.layers import Layer
from sheetbench.scenes.objects.orthotropy import MODULI
from sheetbench.scenes.objects.patches import Patch

# a run, and the run its error refers to, or the reason of a refusal
Cell = tuple[Request, Request | str | None]
FACTORS = {
    "load": (0.001, 0.01, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 1000.0),
    "slenderness": (0.03, 0.1, 0.3, 1.0, 3.0, 10.0),
    "young": (0.001, 0.01, 0.1, 1.0, 10.0, 100.0, 1000.0),
    "obstacle": (0.1, 0.3, 1.0, 2.0, 3.0),
}
CELLS = {"lumped": (2, 4, 8, 16, 32), "references": (2, 4, 8)}  # along the shorter side
DAMPING = (0.0, 0.01, 0.1, 1.0, 10.0, 100.0)  # of the lowest mode's critical damping
SHARES = (0.3, 0.9, 1.1)  # of the largest stable step
DIVISIONS = (200, 50, 20, 8, 4, 2, 1)  # steps per period
FINE_STEPS, SAMPLES = 400, 40  # per period: steps of the midpoint rule, samples
PERIODS = 3.0  # duration of a run
PARTS = ("patches", "layers")
RUN_STEPS, RUN_PERIODS = 500, 2.0  # longest run with default steps: explicit steps, lowest periods


def stability(
    scene: Scene,
    store: Store,
    *,
    varied: Collection[str] = tuple(VARIED),
    lattice: Lattice = Lattice(),  # noqa: B008  # frozen
    reference: str = REFERENCE,
    elements: Count = 12,
    **campaign: Unpack[CampaignKeywords],
) -> Stability:
    """Vary a scene's sheet and solve it by every model, through a campaign's store.

    varied: some of `choices.VARIED`. lattice: settings that are not varied. elements: of the references,
    along the shorter side or along x and y. Raises BadInput for an impossible variation, contradictory
    settings, and models that need more memory than is free.
    """
    resolve(scene, lattice, "motion")
    resolve(scene, Elements(reference, elements))
    kinds = dict.fromkeys(("plate", "shell", reference))
    models = {lattice.model: lattice, **{kind: Elements(kind, elements) for kind in kinds}}
    in_motion = not {"damping", "time-step"}.isdisjoint(varied)
    period = lumped.shortest_period(scene, resolve(scene, lattice).springs) if in_motion else 0.0
    truth = models[reference]
    makers: dict[str, Callable[[], Iterator[Cell]]] = {
        **{name: partial(_scaled, scene, name, models, truth) for name in FACTORS},
        "grid": partial(_grids, scene, models, truth),
        "damping": partial(_damped, scene, lattice, period),
        "time-step": partial(_stepped, scene, lattice, period),
    }
    cells = [cell for name in VARIED if name in varied for cell in makers[name]()]
    solvable = (cell for cell in cells if not isinstance(cell[1], str))
    requests = [one for cell in solvable for one in cell if isinstance(one, Request)]
    solved = {id(row.request): row for row in sweep(requests, store, **campaign)}
    refused = str(Status.REFUSED)
    rows = tuple(
        _row(solved.get(id(request)) or Solved(request, refused, str(other)), solved.get(id(other)))
        for request, other in cells
    )
    return Stability(scene, reference, period or None, rows)


def _tags(study: str, **cell: Any) -> dict[str, Any]:
    return {"study": study, "cell": cell}


def _scaled(scene: Scene, name: str, models: Mapping[str, Spec], truth: Spec) -> Iterator[Cell]:
    scalable = {"load": scene.gravity or scene.loads, "obstacle": scene.obstacles}
    if not scalable.get(name, True):
        return
    for factor in FACTORS[name]:
        label, refusal, variant = f"{name} × {factor:g}", "", scene
        try:
            variant = scaled(scene, name, factor)
        except BadInput as error:
            refusal = str(error)
        reference = Request(variant, truth, label=f"{truth.model} {label}")
        for model, spec in models.items():
            tags = _tags(name, factor=factor, model=model)
            yield Request(variant, spec, tags=tags, label=f"{model} {label}"), refusal or reference


def _grids(scene: Scene, models: Mapping[str, Any], truth: Any) -> Iterator[Cell]:
    meshes = {n: n for n in CELLS["references"]} | {min(truth.counts(scene)[:2]): truth.count}
    finest = max(meshes)
    reference = Request(scene, truth.but(count=meshes[finest]), label=f"{truth.model} {finest} cells")
    for model, spec in models.items():
        for count in CELLS.get(model) or sorted(meshes):
            sized = spec.but(grid=count + 1) if spec.IS_LATTICE else spec.but(count=meshes[count])
            tags = _tags("grid", cells=count, model=model)
            yield Request(scene, sized, tags=tags, label=f"{model} {count} cells"), reference


def _damped(scene: Scene, lattice: Lattice, period: float) -> Iterator[Cell]:
    for ratio in (None, *DAMPING):
        variant = scene
        if ratio is not None:
            damping = {"damping_time": ratio * period / np.pi, "damping_rate": 0.0}
            variant = scene.replace(material=scene.material.replace(**damping))
        springs = resolve(variant, lattice, "springs").springs
        for name, integrator in lumped.INTEGRATORS.items():
            tags, duration = _tags("damping", damping_ratio=ratio, integrator=name), RUN_PERIODS * period
            if integrator.explicit and not scene.chains():  # explicit integrators refuse chains
                flat = variant.replace(gravity=None, loads=())
                equations = lumped.System(flat, lumped.build_problem(flat, springs))
                limit = integrator.limit(equations, np.zeros_like(equations.problem.loads.dead))
                assert limit is not None
                tags |= {"computed": limit.step, "advised": limit.advised}
                duration = min(duration, RUN_STEPS * limit.advised)
            label = f"{name} {'own damping' if ratio is None else f'damping {ratio:g}'}"
            times: Any = {"duration": duration, "every": duration / SAMPLES}
            run = {"integrator": name}
            yield Request(variant, lattice, run=run, tags=tags, label=label, **times), None


def _stepped(scene: Scene, lattice: Lattice, period: float) -> Iterator[Cell]:
    def at_step(name: str, step: float) -> Request:
        return Request(
            scene,
            lattice,
            duration=PERIODS * period,
            every=max(step, period / SAMPLES),
            run={"integrator": name, "step": step},
            tags=_tags("time-step", integrator=name, step=step),
            label=f"{name} {step:.3g} s",
        )

    reference = at_step("midpoint", period / FINE_STEPS)
    for name in INTEGRATORS:
        steps = [period / n for n in DIVISIONS]
        if lumped.INTEGRATORS[name].explicit and not scene.chains():  # explicit integrators refuse chains
            limit = lumped.explicit_limit(name, scene, resolve(scene, lattice).springs)
            steps = [share * limit for share in SHARES]
        yield from ((at_step(name, step), reference) for step in steps)


def scaled(scene: Scene, name: str, factor: float) -> Scene:
    """Return the scene with its load, thickness, moduli or distance from obstacles times a factor, including
    patches and layers. Raises BadInput for an impossible value."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # extremes are implausible
        if name == "young":
            parts = {key: tuple(_stiffer(part, factor) for part in getattr(scene, key)) for key in PARTS}
            return put(scene, "young", factor * scene.material.young).replace(**parts)
        if name == "slenderness":
            patches = [
                patch.replace(thickness=factor * patch.thickness) if patch.thickness else patch
                for patch in scene.patches
            ]
            return put(scene, "thickness", factor * scene.sheet.thickness).replace(patches=tuple(patches))
        if name == "obstacle":
            obstacles = tuple(scale_distance(scene, obstacle, factor) for obstacle in scene.obstacles)
            return scene.replace(obstacles=obstacles)
        loads = tuple(load.times(factor) for load in scene.loads)
        return scene.replace(gravity=scene.gravity and scene.gravity.times(factor), loads=loads)


def _stiffer(part: Patch | Layer, factor: float) -> Patch | Layer:
    """Return a patch or a layer with its own moduli times a factor."""
    moduli = {key: factor * part.own[key] for key in ("young", *MODULI) if key in part.own}
    return part.replace(**moduli) if moduli else part


def _row(solved: Solved, truth: Solved | None) -> Row:
    """Return a cell's row, with its error if both the run and its reference have an answer."""
    steps = solved.row.get("iterations") or solved.row.get("steps")
    row: Row = {**solved.request.tags, "error": None, "iterations": steps, "seconds": solved.run_seconds}
    row |= {"status": solved.status, "message": solved.message}
    if truth is None or not solved.stable or not truth.stable:
        return row
    if (solved.request.spec, solved.request.run) == (truth.request.spec, truth.request.run):
        return row
    if solved.request.duration is not None:
        return {**row, "error": _motion_error(solved.row, truth.row)}
    return {**row, "error": error(solved.u, truth.u)}


def _motion_error(row: Mapping[str, Any], truth: Mapping[str, Any]) -> float | None:
    """Return the largest difference at the probes over the largest displacement, None if that is 0."""
    largest = difference = 0.0
    for name, values in truth["probes"].items():
        expected = np.transpose(
            [np.interp(row["time"], truth["time"], axis) for axis in np.transpose(values)]
        )
        difference = max(difference, float(np.abs(np.array(row["probes"][name]) - expected).max()))
        largest = max(largest, float(np.abs(values).max()))
    return difference / largest if largest > 0.0 else None
