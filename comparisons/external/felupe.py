"""FElupe as a model: 20-node bricks with reduced integration and St Venant–Kirchhoff's law.

FElupe interpolates, integrates and assembles; law and supports (`comparisons.external.bricks`) are given to
it, as its boundary conditions know no turned axes: u = T q + u₀ with the free components q, and Newton's
method on Tᵀ r(u) = 0, the load in steps that are halved where it does not converge. 2 × 2 × 2 points a brick,
without which thin sheets lock.

Everything of a scene but chains and edge moments. Needs the extra [felupe].
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib import metadata
from time import perf_counter
from typing import Any, ClassVar

import numpy as np
from scipy.sparse import csr_matrix, lil_matrix
from scipy.sparse.linalg import splu

from comparisons.external.answer import BRICK_MOMENTS, refusal, require, solution_on_bricks
from comparisons.external.bricks import GRADINGS, Bricks, Held, forces, held
from sheetbench.errors import BadInput
from sheetbench.scenes import Material, Pressure, Scene, Solution, Status

CORRECTION = 1e-9  # of the displacement: where a step ends
ITERATIONS, LEAST = 15, 1.0 / 64.0  # of a step, and the smallest step

CHAINS = "FElupe is given no chains: its points do not turn, so that no joint could want an angle"


@dataclass(frozen=True)
class FElupe:
    """The plug-in.

    settings: elements along the shorter side, near-square; layers of bricks, an even number; grading "edges"
    or "uniform".
    """

    name: str = "felupe"
    called: str = "FElupe"
    needs: str = "FElupe; pip install 'sheetbench[felupe]'"
    meshes: tuple[int, ...] = (4, 6, 8)
    layered: bool = True
    settings: ClassVar[dict[str, Any]] = {"elements": 8, "layers": 2, "grading": "edges"}

    def version(self) -> str | None:
        """Of the package, None where it is not installed."""
        try:
            return metadata.version("felupe")
        except metadata.PackageNotFoundError:
            return None

    def solve(self, scene: Scene, settings: Mapping[str, Any]) -> Solution:
        """The static answer. Raises BadInput without FElupe or for settings it cannot use."""
        require(settings["elements"], settings["layers"], settings["grading"], GRADINGS)
        if self.version() is None:
            raise BadInput(f"model = 'felupe': needs {self.needs}")
        bricks = Bricks.of(scene.sheet, settings["elements"], settings["layers"], settings["grading"])
        began, note = perf_counter(), refusal(scene, CHAINS, BRICK_MOMENTS)
        path = _Path(np.zeros_like(bricks.positions), 0.0, 0)
        ready, status = began, Status.REFUSED
        if not note:
            equilibrium, supports = _equilibrium(scene, bricks), held(scene, bricks)
            ready = perf_counter()
            path = _traced(equilibrium, supports)
            status = Status.CONVERGED if path.load_factor == 1.0 else Status.DIVERGED
        return solution_on_bricks(
            self,
            scene,
            settings,
            bricks,
            path.displacement,
            status,
            path.load_factor,
            note,
            path.iterations,
            (ready - began, perf_counter() - ready),
        )


def _law(material: Material) -> tuple[Callable[[Any], Any], Callable[[Any], Any]]:
    """First Piola–Kirchhoff stress P = F S, S = λ tr E + 2 μ E, of F (3, 3, …), and dP/dF (3, 3, 3, 3, …)."""
    young, poisson, one = material.young, material.poisson, np.eye(3)
    shear = young / (2.0 * (1.0 + poisson))
    first = young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson))

    def second(gradient: np.ndarray) -> np.ndarray:
        strain = 0.5 * (np.einsum("mi...,mj...->ij...", gradient, gradient) - one[..., None, None])
        trace = np.einsum("mm...->...", strain)
        return first * np.einsum("ij,...->ij...", one, trace) + 2.0 * shear * strain

    def stress(x: Any) -> Any:
        return [np.einsum("im...,mj...->ij...", x[0], second(x[0])), x[-1]]

    def elasticity(x: Any) -> Any:
        f = x[0]
        left = np.einsum("im...,km...->ik...", f, f)
        out = np.einsum("ik,jl...->ijkl...", one, second(f)) + first * np.einsum("ij...,kl...->ijkl...", f, f)
        out += shear * np.einsum("ik...,jl->ijkl...", left, one)
        return [out + shear * np.einsum("il...,kj...->ijkl...", f, f)]

    return stress, elasticity


Equilibrium = Callable[[np.ndarray, float], tuple[np.ndarray, csr_matrix]]


def _equilibrium(scene: Scene, bricks: Bricks) -> Equilibrium:
    """Displacement (n, 3) [m] and load factor → residual (3 n,) [N] and its tangent."""
    import felupe

    stress, elasticity = _law(scene.material)
    law = felupe.Material(stress, elasticity)
    mesh = felupe.Mesh(bricks.positions, bricks.elements, "hexahedron20")
    points = felupe.GaussLegendre(order=1, dim=3)
    region = felupe.RegionQuadraticHexahedron(mesh, quadrature=points)
    field = felupe.FieldContainer([felupe.Field(region, dim=3)])
    solid = felupe.SolidBody(law, field)
    dead = forces(scene, bricks).ravel()
    if scene.gravity is not None:
        weight = scene.material.density * np.array(scene.gravity.last_acceleration)
        dead = dead + felupe.SolidBodyForce(field, values=weight).assemble.vector(field).toarray().ravel()
    pressure = sum(load.last_factor * load.value for load in scene.loads if isinstance(load, Pressure))
    faces = []
    for sign, height in ((1.0, bricks.z[0]), (-1.0, bricks.z[-1])) if pressure else ():
        on = felupe.RegionQuadraticHexahedronBoundary(mesh, mask=bricks.positions[:, 2] == height)
        outside = felupe.FieldContainer([felupe.Field(on, dim=3)])
        faces.append((sign, felupe.SolidBodyPressure(outside)))

    def at(displacement: np.ndarray, load_factor: float) -> tuple[np.ndarray, csr_matrix]:
        field[0].values[:] = displacement
        residual = solid.assemble.vector(field).toarray().ravel() - load_factor * dead
        tangent = solid.assemble.matrix(field)
        for sign, face in faces:
            face.field[0].values[:] = displacement
            push = 0.5 * sign * load_factor * pressure
            residual = residual - face.assemble.vector(face.field, pressure=push).toarray().ravel()
            tangent = tangent - face.assemble.matrix(face.field)
        return residual, csr_matrix(tangent)

    return at


@dataclass(frozen=True)
class _Path:
    """Displacement (n, 3) [m] at the load factor reached, and iterations until there."""

    displacement: np.ndarray
    load_factor: float
    iterations: int


def _traced(equilibrium: Equilibrium, supports: Held) -> _Path:
    """The equilibrium under the whole load, or the last that was found on the way."""
    free = _free(supports)
    fixed = np.einsum("nrc,nr->nc", supports.axes, np.where(supports.fixed, supports.value, 0.0))
    path, step = _Path(np.zeros_like(fixed), 0.0, 0), 1.0
    while path.load_factor < 1.0 and step >= LEAST:
        target = min(path.load_factor + step, 1.0)
        found, iterations = _newton(equilibrium, free, path, fixed, target)
        path = _Path(path.displacement, path.load_factor, path.iterations + iterations)
        if found is None:
            step /= 2.0
        else:
            path = _Path(found, target, path.iterations)
    return path


def _free(supports: Held) -> csr_matrix:
    """T (3 n, free): the displacement of the free components along the nodes' axes, and of the nodes that are
    tied to others of their column."""
    free = ~supports.fixed
    for tie in supports.tied:
        free[tie.nodes[0], tie.axis] = False
    node, axis = np.nonzero(free)
    rows = (3 * node[:, None] + np.arange(3)).ravel()
    columns = np.repeat(np.arange(len(node)), 3)
    own = csr_matrix((supports.axes[node, axis].ravel(), (rows, columns)), (free.size, len(node)))
    follow = lil_matrix((free.size, free.size))
    for tie in supports.tied:
        first, *others = 3 * tie.nodes + tie.axis
        follow[first, others] = -tie.weights[1:] / tie.weights[0]
    return (own + follow.tocsr() @ own).tocsr()


def _newton(
    equilibrium: Equilibrium, free: csr_matrix, start: _Path, fixed: np.ndarray, load_factor: float
) -> tuple[np.ndarray | None, int]:
    """The displacement at a load factor, None where it was not found; and iterations.

    The first step goes along the tangent of the start, and takes the held components to where they belong.
    """
    u, jump = start.displacement, (load_factor - start.load_factor) * fixed.ravel()
    for iteration in range(1, ITERATIONS + 1):
        residual, tangent = equilibrium(u, load_factor)
        held = jump if iteration == 1 else np.zeros_like(jump)
        step = held - free @ splu((free.T @ tangent @ free).tocsc()).solve(
            free.T @ (residual + tangent @ held)
        )
        u = u + step.reshape(u.shape)
        if not np.isfinite(u).all():
            return None, iteration
        if np.max(np.abs(step)) <= CORRECTION * np.max(np.abs(u), initial=0.0):
            return u, iteration
    return None, ITERATIONS


MODEL = FElupe()
