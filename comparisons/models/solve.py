"""The one place that knows every solver: a resolved model in, a Solution or a History out.

The solvers are imported when they are first used, so that asking for help stays quick. A model is warmed up
first: what a process pays once, to import and compile, counts neither as set-up nor as solving
(`sheetbench.clock`); the springs of a lattice count as set-up.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import replace
from functools import cache, partial
from subprocess import DEVNULL, Popen
from typing import Any, Literal

import numpy as np

from comparisons.external import plugins
from comparisons.models.context import context
from comparisons.models.resolve import Resolved, resolve
from comparisons.models.sizes import mesh
from comparisons.models.spec import Elements, Lattice
from comparisons.pictures.work import Pace, Work
from sheetbench.answers.history import History
from sheetbench.answers.solution import FieldMesh, Iteration, Solution, Status
from sheetbench.choices import REFERENCES
from sheetbench.clock import now, stopped
from sheetbench.errors import NoMesh
from sheetbench.scenes import Scene, load
from sheetbench.scenes.meaning.composition import composition_at
from sheetbench.scenes.meaning.region import share_of

Watch = Callable[[Iteration], None]  # called once an iteration
EVEN, SETTLED = 0.02, 5.0  # of the duration, or s, until which steps grow and their pace is no estimate
COARSE = (Lattice((3, 3, 2)), *(Elements(kind, 2) for kind in REFERENCES))


def solve(model: Resolved[Any], name: str = "", near: Any = None) -> Solution:
    """Return the static answer of a model, on warm code; name: what to call it instead of its own; near: a
    shape to begin at, as `lumped.solve` and `fem_reference.solve` take it.

    The context's progress is called with what is being done, and with every iteration. A solve that fails is
    a status.
    """
    spec, scene = model.spec, model.scene
    doing = f"solving {name or plugins.shown_name(spec.model)}"
    work = Work(", ".join(filter(None, [doing, mesh(scene, spec)])), model.size)
    progress = context().progress
    progress(work)

    def watch(iteration: Iteration) -> None:
        progress(work.at(iteration.load_factor))

    warm(spec.model)
    began = now()
    if spec.MASSES:
        assert model.springs
    preparing = now() - began
    solution = _solve(model, watch, near)
    spent = solution.setup_seconds + preparing
    drawn = solution.mesh
    if not scene.uniform or scene.pierced:
        drawn = _with_composition(drawn, scene)
    named = name or solution.model
    return replace(solution, model=named, setup_seconds=spent, points=dict(scene.probes), mesh=drawn)


def _with_composition(mesh: FieldMesh, scene: Scene) -> FieldMesh:
    """Return the mesh with what each of its cells is made of, as its middle is, and what share of a lattice's
    lies on the sheet."""
    places = [mesh.points[nodes, :2] for _, nodes in mesh.cells]
    found = [composition_at(scene, at.mean(axis=1)) for at in places]
    of_cells = {name: [one[name] for one in found] for name in found[0]}
    if scene.pierced and mesh.cells[0][0] == "line":
        of_cells["share"] = [share_of(scene, at) for at in places]
    return FieldMesh(mesh.points, mesh.cells, mesh.point_data, {**mesh.cell_data, **of_cells})


def _solve(model: Resolved[Any], watch: Watch | None, near: Any = None) -> Solution:
    spec, scene = model.spec, model.scene
    if isinstance(spec, Lattice):
        import lumped

        branch: Literal["stable", "path"] = "stable" if spec.branch == "buckled" else "path"
        calibrate = None if model.fitted or spec.calibration is None else partial(_springs, model)
        own: dict[str, Any] = {"linear": spec.linear, "branch": branch, "near": near, "calibrate": calibrate}
        solution = lumped.solve(scene, model.springs, progress=watch, **own)
        return replace(solution, settings={**solution.settings, **model.reasons})
    if isinstance(spec, Elements):
        import fem_reference

        elements = tuple(spec.counts(scene)[:2])
        try:
            own = {"elements": elements, "near": near, **spec.options}
            return fem_reference.solve(scene, spec.kind, progress=watch, **own)
        except NoMesh as error:
            return _unanswered(
                scene, spec, f"no mesh of {spec.size} elements, other numbers may have one: {error}"
            )
    outside = plugins.plugin(spec.model)
    return plugins.answer(outside, scene, plugins.settings_of(outside, spec.settings))


def _springs(model: Resolved[Any], scene: Scene) -> Any:
    """Return the springs of a scene with other numbers by the same choices."""
    return model.on(scene).springs


def _unanswered(scene: Scene, spec: Elements, why: str) -> Solution:
    """Return a row without numbers, its mesh the probes alone."""
    points = scene.probe_points()
    places, nowhere = np.column_stack([points, np.zeros(len(points))]), np.full((len(points), 3), np.nan)
    return Solution(
        model=spec.kind,
        label=f"{spec.kind} {spec.size}",
        settings={"elements": spec.counts(scene)[:2], **spec.options},
        status=Status.FAILED,
        unknowns=0,
        iterations=0,
        setup_seconds=0.0,
        solve_seconds=0.0,
        load_factor=0.0,
        sample=lambda points: np.full((len(points), 3), np.nan),
        reactions={},
        energies={},
        mesh=FieldMesh(places, [("vertex", np.arange(len(points))[:, None])], {"displacement": nowhere}),
        remarks=(why,),
    )


def simulate(model: Resolved[Any], duration: float, doing: str = "", **settings: Any) -> History:
    """Return a model's motion over `duration` [s]; doing: what progress calls it; settings: those of its own
    `simulate`.

    Raises BadInput for a plug-in that does not move.
    """
    spec, scene, progress = model.spec, model.scene, context().progress
    doing, pace = doing or f"simulating {plugins.shown_name(spec.model)}", Pace(duration)
    progress(Work(doing))
    began = now()

    def reached(time: float) -> None:
        soon = pace.remaining(time) if time >= EVEN * duration or now() - began > SETTLED else ""
        progress(Work(f"{doing}: {time:.3g} of {duration:g} s{soon}"))

    if isinstance(spec, Elements):
        import fem_reference

        settings |= {"elements": tuple(spec.counts(scene)[:2]), **spec.options, "progress": reached}
        return fem_reference.simulate(scene, spec.kind, duration, **settings)
    if isinstance(spec, Lattice):
        import lumped

        history = lumped.simulate(scene, model.springs, duration, progress=reached, **settings)
        return replace(history, settings={**history.settings, **model.reasons})
    outside = plugins.moving(spec.model)
    return outside.simulate(scene, plugins.settings_of(outside, spec.settings), duration, **settings)


@cache
def warm(model: str) -> None:
    """Import and compile what a model needs, once in a process: solve a coarse sheet, load a plug-in."""
    for coarse in COARSE:
        if coarse.model == model:
            _solve(resolve(load("one-edge-clamped"), coarse), None)
            return
    plugins.plugin(model)


def warm_both(one: str, other: str) -> None:
    """Compile what two models need side by side, the other's in a process of its own."""
    seldom = "import gc; gc.set_threshold(10_000)"  # compiling leaves little garbage
    code = f"{seldom}; from comparisons.models.solve import warm; warm({other!r})"
    command = [sys.executable, "-c", code]
    with stopped(), Popen(command, stdin=DEVNULL, stdout=DEVNULL, stderr=DEVNULL) as beside:
        try:
            warm(one)
            beside.wait()
        finally:
            beside.kill()
