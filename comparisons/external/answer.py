"""An external finite-element code as cross-checks use it, and the Solution of one that solves on bricks."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any, Protocol, runtime_checkable

import numpy as np

from comparisons.external.bricks import Bricks
from comparisons.external.kratos.problem import Triangles
from comparisons.external.plugins import Model
from sheetbench.answers.history import History
from sheetbench.answers.solution import FieldMesh, Solution, Status
from sheetbench.errors import BadInput, require_choice
from sheetbench.scenes import Chain, EdgeLoad, Scene
from sheetbench.scenes.meaning.kinematics import bent_or_tilted

SUBSTEPS = 8  # of a motion between two samples
BRICK_MOMENTS = "loads on bricks do not follow the edge as a moment does"


@runtime_checkable
class ExternalCode(Model, Protocol):
    """A plug-in around another program: its full name (`called`), what it needs to be installed, and the
    numbers of elements along the shorter side, coarsest first, on which its convergence is measured."""

    @property
    def called(self) -> str: ...

    @property
    def needs(self) -> str: ...

    @property
    def meshes(self) -> tuple[int, ...]: ...

    @property
    def layered(self) -> bool:
        """Whether its elements are quadratic and have transverse shear, and so a layer at the edges."""
        ...

    def version(self) -> str | None:
        """Return its version, None where it is not installed."""
        ...


def require_count(elements: Any) -> None:
    """Raise BadInput for what is no number of elements."""
    if type(elements) is not int or elements < 1:
        raise BadInput(f"elements = {elements!r}: a whole number along the shorter side, at least 1")


def require(elements: Any, layers: Any, grading: str, gradings: Collection[str]) -> None:
    """Raise BadInput for settings of bricks that make no mesh."""
    require_count(elements)
    if type(layers) is not int or layers < 2 or layers % 2:
        raise BadInput(f"layers = {layers!r}: an even number, so that nodes lie in the mid-surface")
    require_choice("grading", grading, gradings)


def refusal(
    scene: Scene, chains: str, moments: str, laws: Collection[str] = (), drawn: Collection[str] = ()
) -> str:
    """Return why an external code cannot solve a scene, "" if it can.

    chains, moments: the reasons of this code against actuator chains and edge moments; laws: the laws of
    rubber that it is given; drawn: the words of `Scene.drawn_by` that it knows.
    """
    unknown = [word for word in scene.drawn_by.split(", ") if word and word not in drawn]
    if unknown:
        known = "sheets without" if drawn else "isotropic whole rectangles that are the same all over"
        return f"{', '.join(unknown)}: it is given {known}"
    if scene.obstacles:
        return "obstacles are not handed over"
    law = scene.material.law
    if law is not None and law not in laws:
        known = (
            f"the laws passed to it are {', '.join(laws)}"
            if laws
            else "only linear materials are passed to it"
        )
        return f"it is not given the material's law '{law}': {known}"
    if any(isinstance(actuator, Chain) for actuator in scene.actuators):
        return chains
    if any(isinstance(load, EdgeLoad) and load.moment_per_length for load in scene.loads):
        return moments
    if any(support.motion is not None for support in scene.supports):
        return (
            'supports that move are not handed over: a clamp may be written as an actuator, kind = "motion"'
        )
    return ""


def refusal_of_motion(scene: Scene) -> str:
    """Return why a scene's motion is not handed over, "" if it is."""
    if scene.masses:
        return "its steps in time have the sheet's inertia alone: leave [[mass]] out"
    material, loads = scene.material, [*filter(None, [scene.gravity]), *scene.loads]
    if material.dashpot_time or material.damping_rate or material.branches.times:
        return "its steps in time have no dampers: leave damping_time, damping_rate and relaxation out"
    if scene.air is not None:
        return "its steps in time have no drag: leave [air] out"
    if scene.initial is not None:
        return "it starts flat: leave [initial] out"
    if any(load.history is not None for load in loads):
        return "loads with a history are not handed over"
    if scene.motions() or bent_or_tilted(scene.supports, scene.sheet):
        return "edges that are driven, or bent or turned before the sheet moves, are not handed over"
    return ""


def moved(
    code: ExternalCode,
    integrator: str,
    scene: Scene,
    settings: Mapping[str, Any],
    mesh: Bricks | Triangles,
    times: np.ndarray,
    found: np.ndarray,
    note: str,
    unknowns: int,
    seconds: tuple[float, float],
) -> History:
    """Return the History of nodal displacements (t, n, 3) [m] at `times` (t,) [s] after a start at rest, of
    SUBSTEPS steps each; note: why it stopped early, "" if it did not; seconds: set-up and solve."""
    still = np.zeros((1, *found.shape[1:]))
    at_probes = np.array([mesh.sample(u, scene.probe_points()) for u in (*still, *found)])
    return History(
        label=f"{code.called} {mesh.label}",
        integrator=integrator,
        settings={**settings, "elements": list(mesh.counts)},
        status=Status.DIVERGED if note else Status.CONVERGED,
        message=note,
        time=np.concatenate([[0.0], times]),
        probes=dict(zip(scene.probes, np.swapaxes(at_probes, 0, 1), strict=True)),
        energies={},
        reactions={},
        actuators={},
        steps=SUBSTEPS * len(found),
        setup_seconds=seconds[0],
        solve_seconds=seconds[1],
        extra={"unknowns": unknowns},
    )


def solution(
    code: ExternalCode,
    settings: Mapping[str, Any],
    mesh: Bricks | Triangles,
    displacement: np.ndarray,
    status: Status,
    load_factor: float,
    note: str,
    iterations: int,
    seconds: tuple[float, float],
    unknowns: int | None = None,
) -> Solution:
    """Return the Solution of nodal displacements (n, 3) [m]; seconds: set-up and solve; unknowns: as many as
    there are components unless given."""
    return Solution(
        model=code.name,
        label=f"{code.called} {mesh.label}",
        settings={**settings, "elements": list(mesh.counts)},
        status=status,
        unknowns=displacement.size if unknowns is None else unknowns,
        iterations=iterations,
        setup_seconds=seconds[0],
        solve_seconds=seconds[1],
        sample=lambda points: mesh.sample(displacement, points),
        reactions={},
        energies={},
        mesh=FieldMesh(mesh.positions, [(mesh.KIND, mesh.elements)], {"displacement": displacement}),
        load_factor=load_factor,
        remarks=(note,) if note else (),
    )
