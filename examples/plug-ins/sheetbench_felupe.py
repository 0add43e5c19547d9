"""FElupe as a model: 20-node bricks with reduced integration and St Venant–Kirchhoff's or a rubber's law.

FElupe interpolates, integrates and assembles; law and supports (`comparisons.external.bricks`) are given to
it, as its boundary conditions know no turned axes: u = T q + u₀ with the free components q, and Newton's
method on Tᵀ r(u) = 0, the load in steps that are halved where it does not converge. 2 × 2 × 2 points a brick,
without which thin sheets lock.

Everything of a scene but chains and edge moments. Needs FElupe.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib import metadata
from time import perf_counter
from typing import Any, ClassVar

import numpy as np
from scipy.sparse import csr_matrix, lil_matrix
from scipy.sparse.linalg import splu

from comparisons.external.answer import BRICK_MOMENTS, Code, CodeAnswer, refusal
from comparisons.external.bricks import Bricks, Held, forces, held
from sheetbench.scenes import Material, Pressure, Scene

CORRECTION = 1e-9  # of the displacement: where a step ends
ITERATIONS, LEAST = 15, 1.0 / 64.0  # of a step, and the smallest step

LAWS = ("neo-hookean", "mooney-rivlin", "yeoh", "gent")
ONE = np.eye(3)
EACH = 0.5 * (np.einsum("ik,jl->ijkl", ONE, ONE) + np.einsum("il,jk->ijkl", ONE, ONE))

CHAINS = "actuators are not supported: FElupe's nodes have no rotations"


class FElupe(Code):
    """The plug-in.

    settings: elements along the shorter side, near-square; layers of bricks, an even number; grading "edges"
    or "uniform".
    """

    name, called, needs = "felupe", "FElupe", "FElupe; pip install felupe"
    meshes, layered = (4, 6, 8), True
    settings: ClassVar[dict[str, Any]] = {"elements": 8, "layers": 2, "grading": "edges"}

    def version(self) -> str | None:
        """Return the version of FElupe, None where it is not installed."""
        try:
            return metadata.version("felupe")
        except metadata.PackageNotFoundError:
            return None

    def refusal(self, scene: Scene, settings: Mapping[str, Any]) -> str:
        return refusal(scene, CHAINS, BRICK_MOMENTS, LAWS)

    def at_rest(self, scene: Scene, settings: Mapping[str, Any], mesh: Bricks) -> CodeAnswer:
        equilibrium, supports = _equilibrium(scene, mesh), held(scene, mesh)
        began = perf_counter()
        path = _traced(equilibrium, supports)
        seconds = perf_counter() - began
        return CodeAnswer(path.displacement, path.load_factor, path.iterations, seconds=seconds)


def _law(material: Material) -> tuple[Callable[[Any], Any], Callable[[Any], Any]]:
    """Return the first Piola–Kirchhoff stress P = F S of F (3, 3, …), and dP/dF (3, 3, 3, 3, …)."""
    response = _linear(material) if material.law is None else _rubber(material)

    def stress(x: Any) -> Any:
        return [np.einsum("im...,mj...->ij...", x[0], response(x[0])[0]), x[-1]]

    def elasticity(x: Any) -> Any:
        second, moduli = response(x[0])
        out = np.einsum("im...,kp...,mjpl...->ijkl...", x[0], x[0], moduli, optimize=True)
        return [out + np.einsum("ik,jl...->ijkl...", ONE, second)]

    return stress, elasticity


Response = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]  # F → S (3, 3, …), ∂S/∂E (3, 3, 3, 3, …)


def _linear(material: Material) -> Response:
    """Return S = λ tr E + 2 μ E."""
    young, poisson = material.young, material.poisson
    shear = young / (2.0 * (1.0 + poisson))
    first = young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson))
    moduli = first * np.einsum("ij,kl->ijkl", ONE, ONE) + 2.0 * shear * EACH

    def response(f: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        strain = 0.5 * (np.einsum("mi...,mj...->ij...", f, f) - ONE[(...,) + (None,) * (f.ndim - 2)])
        constant = np.broadcast_to(moduli[(...,) + (None,) * (f.ndim - 2)], (3, 3, 3, 3, *f.shape[2:]))
        return np.einsum("ijkl,kl...->ij...", moduli, strain), constant

    return response


def _rubber(material: Material) -> Response:
    """Return S = 2 (f′ + c₀₁ I₁) − 2 c₀₁ C + (Λ ln J − m) C⁻¹ of the energy of `scenes.objects.material`."""
    energy, bulk = material.energy, material.energy.volume(material.poisson)

    def response(f: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        c = np.einsum("mi...,mj...->ij...", f, f)
        last = np.moveaxis(c, (0, 1), (-2, -1))
        inverse, first = np.moveaxis(np.linalg.inv(last), (-2, -1), (0, 1)), np.einsum("mm...->...", c)
        pull = 0.5 * bulk * np.log(np.linalg.det(last)) - 2.0 * energy.c10 - 4.0 * energy.c01
        x = first - 3.0
        if energy.limit:
            left = np.where(x < energy.limit, 1.0 - x / energy.limit, np.nan)
            slope, bend = energy.c10 / left, energy.c10 / (energy.limit * left**2)
        else:
            slope = energy.c10 + 2.0 * energy.c20 * x + 3.0 * energy.c30 * x**2
            bend = 2.0 * energy.c20 + 6.0 * energy.c30 * x
        even = np.einsum("ij,...->ij...", ONE, slope + energy.c01 * first)
        stress = 2.0 * even - 2.0 * energy.c01 * c + pull * inverse
        moduli = 4.0 * np.einsum("ij,kl,...->ijkl...", ONE, ONE, bend + energy.c01)
        moduli -= 4.0 * energy.c01 * EACH[(...,) + (None,) * (f.ndim - 2)]
        moduli += bulk * np.einsum("ij...,kl...->ijkl...", inverse, inverse)
        across = np.einsum("ik...,jl...->ijkl...", inverse, inverse)
        return stress, moduli - pull * (across + across.swapaxes(2, 3))

    return response


Equilibrium = Callable[[np.ndarray, float], tuple[np.ndarray, csr_matrix]]


def _equilibrium(scene: Scene, bricks: Bricks) -> Equilibrium:
    """Return the function of displacement (n, 3) [m] and load factor: residual (3 n,) [N] and its tangent."""
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
    """Return the equilibrium under the whole load, or the last converged on the way."""
    free = _free(supports)
    fixed = np.einsum("nrc,nr->nc", supports.axes, np.where(supports.fixed, supports.value, 0.0))
    path, step = _Path(np.zeros_like(fixed), 0.0, 0), 1.0
    while path.load_factor < 1.0 and step >= LEAST:
        target = min(path.load_factor + step, 1.0)
        displacement, iterations = _newton(equilibrium, free, path, fixed, target)
        path = _Path(path.displacement, path.load_factor, path.iterations + iterations)
        if displacement is None:
            step /= 2.0
        else:
            path = _Path(displacement, target, path.iterations)
    return path


def _free(supports: Held) -> csr_matrix:
    """Return T (3 n, free): the displacement of the free components along the nodes' axes, and of the nodes
    that are tied to others of their column."""
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
    """Return the displacement at a load factor, None where it did not converge; and iterations.

    The first step goes along the tangent of the start, and takes the held components to where they belong.
    """
    u, jump = start.displacement, (load_factor - start.load_factor) * fixed.ravel()
    for iteration in range(1, ITERATIONS + 1):
        residual, tangent = equilibrium(u, load_factor)
        if not np.isfinite(residual).all():  # as beyond Gent's limit
            return None, iteration
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
