"""Dispatch of a resolved model to its solver, for a Solution or a History.

Solvers are imported on first use, to keep `--help` fast. A model is warmed up first: the time for imports and
compiling, spent once per process, counts neither as set-up nor as solving (`sheetbench.clock`). The
calibration of a lattice counts as set-up.
"""

import sys
from collections.abc import Callable
from dataclasses import replace
from functools import cache
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

OnIteration = Callable[[Iteration], None]  # called at every iteration
EVEN, SETTLED = 0.02, 5.0  # of the duration, or s: until then steps grow and no remaining time is shown
COARSE = (Lattice((3, 3, 2)), *(Elements(kind, 2) for kind in REFERENCES))


def solve(model: Resolved[Any], name: str = "", near: Any = None) -> Solution:
    """Return the static answer of a model after its warm-up; name: shown in place of its own; near: a shape
    to start from, in the form of `lumped.solve` and `fem_reference.solve`. The context's progress is called
    at the start and at every iteration. A failed solve is reported as a status."""
    spec, scene = model.spec, model.scene
    doing = f"solving {name or plugins.shown_name(spec.model)}"
    work = Work(", ".join(filter(None, [doing, mesh(scene, spec)])), model.size)
    progress = context().progress
    progress(work)

    def watch(iteration: Iteration) -> None:
        progress(work.at(iteration.load_factor))

    warm(spec.model)
    start = now()
    if spec.IS_LATTICE:
        assert model.springs
    calibration_seconds = now() - start
    solution = _solve(model, watch, near)
    field_mesh = solution.mesh
    if not scene.uniform or scene.pierced:
        field_mesh = _with_composition(field_mesh, scene)
    return replace(
        solution,
        model=name or solution.model,
        setup_seconds=solution.setup_seconds + calibration_seconds,
        points=dict(scene.probes),
        mesh=field_mesh,
    )


def _with_composition(mesh: FieldMesh, scene: Scene) -> FieldMesh:
    """Return the mesh with material and thickness as cell data, taken at the cells' middles; a lattice's also
    with the share of each cell that lies on the sheet."""
    corners = [mesh.points[nodes, :2] for _, nodes in mesh.cells]
    compositions = [composition_at(scene, at.mean(axis=1)) for at in corners]
    cell_data = {name: [block[name] for block in compositions] for name in compositions[0]}
    if scene.pierced and mesh.cells[0][0] == "line":
        cell_data["share"] = [share_of(scene, at) for at in corners]
    return FieldMesh(mesh.points, mesh.cells, mesh.point_data, {**mesh.cell_data, **cell_data})


def _solve(model: Resolved[Any], watch: OnIteration | None, near: Any = None) -> Solution:
    spec, scene = model.spec, model.scene
    if isinstance(spec, Lattice):
        import lumped

        branch: Literal["stable", "path"] = "stable" if spec.branch == "buckled" else "path"
        options: dict[str, Any] = {"linear": spec.linear, "branch": branch}
        solution = lumped.solve(scene, model.springs, near=near, progress=watch, **options)
        return replace(solution, settings={**solution.settings, **model.reasons})
    if isinstance(spec, Elements):
        import fem_reference

        elements = tuple(spec.counts(scene)[:2])
        try:
            keywords = {"elements": elements, "near": near, **spec.options}
            return fem_reference.solve(scene, spec.kind, progress=watch, **keywords)
        except NoMesh as error:
            return _unanswered(
                scene, spec, f"no mesh of {spec.size} elements, other numbers may have one: {error}"
            )
    outside = plugins.plugin(spec.model)
    return plugins.answer(outside, scene, plugins.settings_of(outside, spec.settings))


def _unanswered(scene: Scene, spec: Elements, reason: str) -> Solution:
    """Return a failed solution with NaN as displacement; its mesh consists of the probes."""
    points = scene.probe_points()
    positions, no_value = np.column_stack([points, np.zeros(len(points))]), np.full((len(points), 3), np.nan)
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
        mesh=FieldMesh(positions, [("vertex", np.arange(len(points))[:, None])], {"displacement": no_value}),
        remarks=(reason,),
    )


def simulate(model: Resolved[Any], duration: float, doing: str = "", **settings: Any) -> History:
    """Return a model's motion over `duration` [s]; doing: text for progress; settings: keywords of the
    model's `simulate`. Raises BadInput for a plug-in without motion."""
    spec, scene, progress = model.spec, model.scene, context().progress
    doing, pace = doing or f"simulating {plugins.shown_name(spec.model)}", Pace(duration)
    progress(Work(doing))
    start = now()

    def report(time: float) -> None:
        remaining = pace.remaining(time) if time >= EVEN * duration or now() - start > SETTLED else ""
        progress(Work(f"{doing}: {time:.3g} of {duration:g} s{remaining}"))

    if isinstance(spec, Elements):
        import fem_reference

        settings |= {"elements": tuple(spec.counts(scene)[:2]), **spec.options, "progress": report}
        return fem_reference.simulate(scene, spec.kind, duration, **settings)
    if isinstance(spec, Lattice):
        import lumped

        history = lumped.simulate(scene, model.springs, duration, progress=report, **settings)
        return replace(history, settings={**history.settings, **model.reasons})
    outside = plugins.moving(spec.model)
    return outside.simulate(scene, plugins.settings_of(outside, spec.settings), duration, **settings)


@cache
def warm(model: str) -> None:
    """Import and compile a model's code, once per process, by a solve of a coarse sheet."""
    for coarse in COARSE:
        if coarse.model == model:
            _solve(resolve(load("one-edge-clamped"), coarse), None)
            return
    plugins.plugin(model)


def warm_both(first: str, second: str) -> None:
    """Compile the code of two models in parallel, the second in a process of its own."""
    few_collections = "import gc; gc.set_threshold(10_000)"  # compiling leaves little garbage
    code = f"{few_collections}; from comparisons.models.solve import warm; warm({second!r})"
    command = [sys.executable, "-c", code]
    with stopped(), Popen(command, stdin=DEVNULL, stdout=DEVNULL, stderr=DEVNULL) as process:
        try:
            warm(first)
            process.wait()
        finally:
            process.kill()
