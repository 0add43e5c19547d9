"""An external finite-element code as cross-checks use it, and the base of those that are given a mesh here;
those among the plug-ins, and which of them are installed.
"""

from __future__ import annotations

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
    """A plug-in around another program: its full name (`called`), what it needs to be installed, and the
    numbers of elements along the shorter side, coarsest first, on which its convergence is measured."""

    called: str
    needs: str
    meshes: tuple[int, ...]
    layered: bool  # whether its elements are quadratic and have transverse shear, and so a layer at the edges

    def version(self) -> str | None:
        """Return its version, None where it is not installed."""
        ...


def require_count(elements: Any) -> None:
    """Raise BadInput for what is no number of elements."""
    if type(elements) is not int or elements < 1:
        raise BadInput(f"elements = {elements!r}: a whole number along the shorter side, at least 1")


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


class Reached(NamedTuple):
    """What a code finds at rest: nodal displacement (n, 3) [m] at the last load factor that converged;
    iterations; note: why it ended early, "" if it did not; seconds: of the solve alone; held: unknowns of the
    mesh that supports take."""

    displacement: np.ndarray
    load_factor: float = 0.0
    iterations: int = 0
    note: str = ""
    seconds: float = 0.0
    held: int = 0


class Code(ExternalCode, ABC):
    """Base of the external codes here: status, times and mesh of what a subclass finds."""

    unknowns = 3  # of a node

    @abstractmethod
    def refusal(self, scene: Scene, settings: Mapping[str, Any]) -> str:
        """Return why it cannot solve a scene, "" if it can."""

    @abstractmethod
    def at_rest(self, scene: Scene, settings: Mapping[str, Any], mesh: Any) -> Reached:
        """Return what it finds of a scene that it does not refuse."""

    def mesh(self, scene: Scene, settings: Mapping[str, Any]) -> Any:
        """Return the mesh, `Bricks` or alike. Raises BadInput without the code, or for bad settings."""
        elements, layers, grading = (settings[name] for name in ("elements", "layers", "grading"))
        require_count(elements)
        if type(layers) is not int or layers < 2 or layers % 2:
            raise BadInput(f"layers = {layers!r}: an even number, so that nodes lie in the mid-surface")
        require_choice("grading", grading, GRADINGS)
        self.require_installed()
        return Bricks.of(scene, elements, layers, grading)

    def require_installed(self) -> None:
        """Raise BadInput where it is not installed."""
        if self.version() is None:
            raise BadInput(f"model = '{self.name}': needs {self.needs}")

    def solve(self, scene: Scene, settings: Mapping[str, Any]) -> Solution:
        """Return the static answer. Raises BadInput without the code or for settings it cannot use."""
        began, mesh = perf_counter(), self.mesh(scene, settings)
        note = self.refusal(scene, settings)
        still = np.zeros_like(mesh.positions)
        found = Reached(still, note=note) if note else self.at_rest(scene, settings, mesh)
        status = Status.CONVERGED if found.load_factor == 1.0 and not found.note else Status.DIVERGED
        if not np.isfinite(found.displacement).all():
            status = Status.NON_FINITE
        displacement = np.nan_to_num(found.displacement)

        def sample(points: np.ndarray) -> np.ndarray:
            nodes, weights = mesh.weights(points)
            return np.asarray(np.einsum("pk,pkc->pc", weights, displacement[nodes]))

        return Solution(
            model=self.name,
            label=f"{self.called} {mesh.label}",
            settings={**settings, "elements": list(mesh.counts)},
            status=Status.REFUSED if note else status,
            unknowns=self.unknowns * len(still) - found.held,
            iterations=found.iterations,
            setup_seconds=perf_counter() - began - found.seconds,
            solve_seconds=found.seconds,
            sample=sample,
            reactions={},
            energies={},
            mesh=FieldMesh(mesh.positions, [(mesh.KIND, mesh.elements)], {"displacement": displacement}),
            load_factor=found.load_factor,
            remarks=(found.note,) if found.note else (),
        )


def find_codes(names: Sequence[str] | None = None) -> dict[str, ExternalCode]:
    """Return the external codes of these names, or `FILE.py:OBJECT`, by what selects them; unless given all
    among the plug-ins that can be loaded, absent ones too.

    Raises BadInput for a name that is no external code's, and for a named code that is not installed.
    """
    found: dict[str, Any] = {}
    for name in plugins.names() if names is None else names:
        if names is not None and plugins.from_file(name) is None:
            require_choice("--judges", name, find_codes())
        with suppress(BadInput) if names is None else nullcontext():
            found[name] = plugins.plugin(name)
    if names is None:
        return {name: code for name, code in found.items() if isinstance(code, ExternalCode)}
    for name, code in found.items():
        if not isinstance(code, ExternalCode):
            raise BadInput(f"--judges = '{name}': no external code, it has no meshes or no version()")
        if code.version() is None:
            raise BadInput(f"--judges = '{name}': needs {code.needs}")
    return found
