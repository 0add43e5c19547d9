"""External finite-element codes: their protocol in cross-checks, a base class for codes that are given a mesh
of ours, and the search for installed ones among the plug-ins.
"""

from abc import ABC, abstractmethod
from collections.abc import Collection, Mapping, Sequence
from contextlib import nullcontext, suppress
from time import perf_counter
from typing import Any, NamedTuple, Protocol, runtime_checkable

import numpy as np

from comparisons.external import plugins
from comparisons.external.bricks import GRADINGS, Bricks
from comparisons.external.plugins import Model
from sheetbench.answers.solution import FieldMesh, Solution, Status
from sheetbench.errors import BadInput, require_choice
from sheetbench.scenes import Chain, EdgeLoad, Scene

BRICK_MOMENTS = "loads on bricks do not follow the edge as a moment does"


@runtime_checkable
class ExternalCode(Model, Protocol):
    """A plug-in around another program. called: full name of the program; needs: the packages or programs to
    install; meshes: numbers of elements along the shorter side on which its convergence is measured, coarsest
    first."""

    called: str
    needs: str
    meshes: tuple[int, ...]
    layered: bool  # whether its elements are quadratic and have transverse shear, and so a layer at the edges

    def version(self) -> str | None:
        """Return the program's version, None if it is not installed."""
        ...


def require_count(elements: Any) -> None:
    """Raise BadInput if `elements` is not a positive whole number."""
    if type(elements) is not int or elements < 1:
        raise BadInput(f"elements = {elements!r}: a whole number along the shorter side, at least 1")


def refusal(
    scene: Scene, chains: str, moments: str, laws: Collection[str] = (), drawn: Collection[str] = ()
) -> str:
    """Return the reason why an external code cannot solve a scene, "" if it can.

    chains, moments: reasons of the code against actuator chains and edge moments; laws: the rubber laws it
    accepts; drawn: the features of `Scene.drawn_by` it accepts.
    """
    unsupported = [word for word in scene.drawn_by.split(", ") if word and word not in drawn]
    if unsupported:
        accepted = "sheets without" if drawn else "isotropic whole rectangles that are the same all over"
        return f"{', '.join(unsupported)}: it supports {accepted}"
    if scene.obstacles:
        return "obstacles are not passed to it"
    law = scene.material.law
    if law is not None and law not in laws:
        accepted = (
            f"the laws passed to it are {', '.join(laws)}"
            if laws
            else "only linear materials are passed to it"
        )
        return f"the material's law '{law}' is not passed to it: {accepted}"
    if any(isinstance(actuator, Chain) for actuator in scene.actuators):
        return chains
    if any(isinstance(load, EdgeLoad) and load.follows for load in scene.loads):
        return moments
    if any(support.motion is not None for support in scene.supports):
        return 'moving supports are not passed to it: write a clamp as an actuator, kind = "motion"'
    return ""


class CodeAnswer(NamedTuple):
    """A static answer of a code: nodal displacement (n, 3) [m] at the last load factor that converged. note:
    the reason for an early end, "" if there was none; seconds: time of the solve alone; held: number of
    unknowns fixed by supports."""

    displacement: np.ndarray
    load_factor: float = 0.0
    iterations: int = 0
    note: str = ""
    seconds: float = 0.0
    held: int = 0


class Code(ExternalCode, ABC):
    """Base class of external codes: makes a `Solution` from the `CodeAnswer` of a subclass."""

    unknowns = 3  # per node

    @abstractmethod
    def refusal(self, scene: Scene, settings: Mapping[str, Any]) -> str:
        """Return the reason why the code cannot solve a scene, "" if it can."""

    @abstractmethod
    def at_rest(self, scene: Scene, settings: Mapping[str, Any], mesh: Any) -> CodeAnswer:
        """Solve a scene at rest that `refusal` accepts."""

    def mesh(self, scene: Scene, settings: Mapping[str, Any]) -> Any:
        """Return the mesh, of bricks by default. Raises BadInput for a missing code or bad settings."""
        elements, layers, grading = (settings[name] for name in ("elements", "layers", "grading"))
        require_count(elements)
        if type(layers) is not int or layers < 2 or layers % 2:
            raise BadInput(f"layers = {layers!r}: an even number, so that nodes lie in the mid-surface")
        require_choice("grading", grading, GRADINGS)
        self.require_installed()
        return Bricks.of(scene, elements, layers, grading)

    def require_installed(self) -> None:
        """Raise BadInput if the code is not installed."""
        if self.version() is None:
            raise BadInput(f"model = '{self.name}': needs {self.needs}")

    def solve(self, scene: Scene, settings: Mapping[str, Any]) -> Solution:
        """Return the static answer. Raises BadInput for a missing code or bad settings."""
        start, mesh = perf_counter(), self.mesh(scene, settings)
        note = self.refusal(scene, settings)
        undeformed = np.zeros_like(mesh.positions)
        reached = CodeAnswer(undeformed, note=note) if note else self.at_rest(scene, settings, mesh)
        status = Status.CONVERGED if reached.load_factor == 1.0 and not reached.note else Status.DIVERGED
        if not np.isfinite(reached.displacement).all():
            status = Status.NON_FINITE
        displacement = np.nan_to_num(reached.displacement)

        def sample(points: np.ndarray) -> np.ndarray:
            nodes, weights = mesh.weights(points)
            return np.asarray(np.einsum("pk,pkc->pc", weights, displacement[nodes]))

        return Solution(
            model=self.name,
            label=f"{self.called} {mesh.label}",
            settings={**settings, "elements": list(mesh.counts)},
            status=Status.REFUSED if note else status,
            unknowns=self.unknowns * len(undeformed) - reached.held,
            iterations=reached.iterations,
            setup_seconds=perf_counter() - start - reached.seconds,
            solve_seconds=reached.seconds,
            sample=sample,
            reactions={},
            energies={},
            mesh=FieldMesh(mesh.positions, [(mesh.KIND, mesh.elements)], {"displacement": displacement}),
            load_factor=reached.load_factor,
            remarks=(reached.note,) if reached.note else (),
        )


def find_codes(names: Sequence[str] | None = None) -> dict[str, ExternalCode]:
    """Return external codes by name or `FILE.py:OBJECT`; by default every code among the loadable plug-ins,
    installed or not.

    Raises BadInput for a name that belongs to no external code, and for a named code that is not installed.
    """
    models: dict[str, Any] = {}
    for name in plugins.names() if names is None else names:
        if names is not None and plugins.from_file(name) is None:
            require_choice("--judges", name, find_codes())
        with suppress(BadInput) if names is None else nullcontext():
            models[name] = plugins.plugin(name)
    if names is None:
        return {name: code for name, code in models.items() if isinstance(code, ExternalCode)}
    for name, code in models.items():
        if not isinstance(code, ExternalCode):
            raise BadInput(f"--judges = '{name}': not an external code, it lacks meshes or version()")
        if code.version() is None:
            raise BadInput(f"--judges = '{name}': needs {code.needs}")
    return models
