"""Kratos' thin shell as a model: `ShellThinElementCorotational3D3N`, Kirchhoff's, with drilling rotations.

The element has no transverse shear. Edges with a free director keep a twist there that a plate with shear
loses within about its thickness, so the model is stiffer than our shell by a fraction of h over the length.

Kratos solves in a process of its own (`process`), under the load in one step, then in 4 and in 16 steps if
that does not converge. All parts of a scene but chains and edge moments are supported. Needs the extra
[kratos].

The process gets arrays: triangles of a flat sheet, supports and forces. Each cell of a grid is cut in two,
with alternating diagonals, so that the mesh is symmetric if the number of cells is even. A node has a
displacement and a rotation vector as unknowns. A clamp holds all six components, a hinge the displacement.
SI.
"""

import sys
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from importlib import metadata
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, ClassVar, Self

import numpy as np
from scipy.spatial.transform import Rotation
from skfem import MeshQuad

from comparisons.external.answer import Code, CodeAnswer, refusal, require_count
from comparisons.external.bricks import SITES, point_loads
from comparisons.external.output import Failed, output_of
from fem_reference.surface.location import locate
from fem_reference.surface.mesh import rectangle
from sheetbench.scenes import (
    EdgeLoad,
    Pressure,
    Scene,
    held_axes,
    holds_director,
    tilt_axes,
)
from sheetbench.scenes.meaning.kinematics import DrivenEdge, MovedEdge, bent_or_tilted
from sheetbench.scenes.objects.grid import near_square
from sheetbench.scenes.objects.sheet import Sheet


@dataclass(frozen=True)
class Triangles:
    """A mesh of triangles; plan: cells, each cut in two; counts: number of cells along x and y."""

    KIND: ClassVar = "triangle"
    plan: MeshQuad
    counts: tuple[int, int]

    @classmethod
    def of(cls, sheet: Sheet, elements: int) -> Self:
        """Mesh a sheet with near-square cells of one size; elements: cells along the shorter side."""
        counts = near_square(sheet, elements)
        return cls(rectangle(sheet, counts), counts)

    @property
    def label(self) -> str:
        """The number of triangles in words."""
        return f"{' × '.join(map(str, self.counts))} × 2 triangles"

    @cached_property
    def positions(self) -> np.ndarray:
        """Positions of the nodes (n, 3) [m]."""
        return np.column_stack([self.plan.p.T, np.zeros(self.plan.nvertices)])

    @cached_property
    def elements(self) -> np.ndarray:
        """Nodes of the triangles (2 nx ny, 3), normal along +z."""
        cells, (nx, ny) = self.plan.t[[0, 3, 2, 1]].T, self.counts  # the plan's cells run clockwise
        places = self.plan.p[:, cells].mean(axis=2) / self.plan.p.max(axis=1)[:, None]
        falling = np.floor(places * [[nx], [ny]]).sum(axis=0) % 2 == 1
        cells[falling] = np.roll(cells[falling], -1, axis=1)
        return np.vstack([cells[:, :3], cells[:, [0, 2, 3]]])

    def edge(self, name: str) -> np.ndarray:
        """Return the nodes on an edge, along it."""
        return np.unique(self.plan.facets[:, self.plan.boundaries[name]])

    def weights(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the corners of the cells at plan points (p, 2) [m], and their bilinear weights, (p, 4)."""
        element, place = locate(self.plan, points)
        shares = 0.25 * np.prod(1.0 + SITES[:4] * place.T[:, None], axis=2)
        return self.plan.t[:, element].T, shares


def problem(scene: Scene, mesh: Triangles, load_factors: np.ndarray) -> dict[str, np.ndarray]:
    """Return the arrays that `comparisons.external.kratos.process` reads."""
    held, value = _held(scene, mesh, load_factors)
    material, none = scene.material, np.zeros(3)
    return {
        "positions": mesh.positions,
        "elements": mesh.elements,
        "material": np.array([material.young, material.poisson, material.density, scene.sheet.thickness]),
        "acceleration": none if scene.gravity is None else np.array(scene.gravity.last_acceleration),
        "force": _forces(scene, mesh),
        "pressure": np.array(sum(p.last_factor * p.value for p in scene.loads if isinstance(p, Pressure))),
        "held": held,
        "value": value,
        "load_factors": load_factors,
    }


def _held(scene: Scene, mesh: Triangles, load_factors: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return whether unknowns are prescribed (n, 6), and at what values (steps, n, 6) [m, rad]."""
    held = np.zeros((len(mesh.positions), 6), dtype=bool)
    value = np.zeros((len(load_factors), *held.shape))
    for support in scene.supports:
        nodes = mesh.edge(support.edge)
        held[nodes[:, None], held_axes(support)] = True
        if holds_director(support):
            held[nodes, 3:] = True
        elif axes := tilt_axes(support):
            held[nodes[:, None], (4 - axes[0], 5)] = True
    driven: list[DrivenEdge] = [*bent_or_tilted(scene.supports, scene.sheet)]
    driven += [MovedEdge(motion, scene.sheet) for motion in scene.motions().values()]
    for edge in driven:
        nodes = mesh.edge(edge.edge)
        held[nodes] = True
        for step, load_factor in enumerate(load_factors.tolist()):
            displaced = edge.displaced(mesh.positions[nodes, :2], load_factor)
            value[step, nodes, :3] = displaced.displacement
            value[step, nodes, 3:] = Rotation.from_matrix(np.eye(3) + displaced.turn).as_rotvec()
    return held, value


def _forces(scene: Scene, mesh: Triangles) -> np.ndarray:
    """Return nodal forces (n, 3) [N] of point loads and edge loads."""
    out = point_loads(scene, mesh)
    for load in scene.loads:
        if isinstance(load, EdgeLoad):
            nodes = mesh.edge(load.edge)
            spans = np.linalg.norm(np.diff(mesh.positions[nodes], axis=0), axis=1)
            pull = load.last_factor * np.outer(spans, load.force_per_length)
            out[nodes[:-1]] += 0.5 * pull
            out[nodes[1:]] += 0.5 * pull
    return out


STEPS = (1, 4, 16)
PACKAGES = (
    "KratosMultiphysics",
    "KratosStructuralMechanicsApplication",
    "KratosLinearSolversApplication",
)

CHAINS = "actuators are not supported: Kratos' shell has no joint with a rest angle between rigid edges"
MOMENTS = "moments on Kratos' nodes do not follow the edge"


class Kratos(Code):
    """Kratos as a plug-in. settings: elements, near-square cells along the shorter side, each of two
    triangles; time_limit [s] of each attempt."""

    name, called = "kratos", "Kratos' thin shell"
    needs = "the wheels of Kratos; pip install 'sheetbench[kratos]'"
    meshes, layered = (8, 12, 16), False
    settings: ClassVar[dict[str, Any]] = {"elements": 16, "time_limit": 600.0}
    unknowns = 6

    def version(self) -> str | None:
        """Return the version of the wheels, None if one is missing."""
        try:
            return {metadata.version(package) for package in PACKAGES}.pop()
        except metadata.PackageNotFoundError:
            return None

    def refusal(self, scene: Scene, settings: Mapping[str, Any]) -> str:
        return refusal(scene, CHAINS, MOMENTS)

    def mesh(self, scene: Scene, settings: Mapping[str, Any]) -> Triangles:
        require_count(settings["elements"])
        self.require_installed()
        return Triangles.of(scene.sheet, settings["elements"])

    def at_rest(self, scene: Scene, settings: Mapping[str, Any], mesh: Triangles) -> CodeAnswer:
        reached = CodeAnswer(np.zeros_like(mesh.positions))
        for steps in STEPS:
            arrays = problem(scene, mesh, np.arange(1, steps + 1) / steps)
            try:
                answer = _solve_in_process(arrays, settings["time_limit"])
            except Failed as error:
                return reached._replace(note=f"Kratos: {error}")
            reached = CodeAnswer(
                answer["displacement"],
                float(answer["load_factor"]),
                reached.iterations + int(answer["iterations"]),
                seconds=reached.seconds + float(answer["seconds"]),
                held=int(arrays["held"].sum()),
            )
            if reached.load_factor == 1.0 and np.isfinite(reached.displacement).all():
                break
        return reached


def _solve_in_process(problem: Mapping[str, Any], limit: float) -> dict[str, np.ndarray]:
    """Run `comparisons.external.kratos.process` and return its arrays. Raises Failed without an answer."""
    with TemporaryDirectory(prefix="sheetbench-kratos-") as folder:
        question, answer = Path(folder) / "problem.npz", Path(folder) / "answer.npz"
        np.savez(question, **problem)
        module = "comparisons.external.kratos.process"
        output_of([sys.executable, "-m", module, str(question), str(answer)], Path(folder), limit)
        try:
            with np.load(answer) as arrays:
                return dict(arrays)
        except (OSError, ValueError) as error:
            raise Failed(f"left no answer that can be read ({error})") from None


MODEL = Kratos()
