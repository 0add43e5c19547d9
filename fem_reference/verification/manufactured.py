"""Manufactured solutions of linear elasticity: errors in L² and their order.

A clamped Mindlin square of side 1, for plate and linear shell: the pressure

    p = E h³/12(1 − ν²) (g(x, y) + g(y, x)),    g = 12 b₁(y) q(x) (2 b₂(y) + b₁(x) q(y)),

where q(t) = 5t² − 5t + 1 and b_n(t) = tⁿ (t − 1)ⁿ, bends the plate to the deflection w and the director's
tilt β

    w = b₃(x) b₃(y)/3 − 2h²/(5(1 − ν)) (b₃(y) b₁(x) q(x) + b₃(x) b₁(y) q(y)),
    β = −(b₃(y) b₂(x) (2x − 1), b₃(x) b₂(y) (2y − 1)).

A block of bricks, a unit square of thickness ½, held on all its surface at

    u_i = c_i sin(k_i · x + a_i),    in balance with the body force
    b_j = (λ + μ) Σ_i k_ii k_ij u_i + μ |k_j|² u_j.

Near ν = ½ the field keeps the volume (k_ii = 0), as required of a nearly incompressible body.
Biquadratic and triquadratic fields: order 3. Source: Chinosi & Lovadina, Comput. Mech. 16 (1995) 36–44.
"""

from collections.abc import Callable, Iterator

import numpy as np
from skfem import Basis, ElementQuad2, Functional, LinearForm

from fem_reference.plate.discrete import DiscretePlate
from fem_reference.shell.discrete import DiscreteShell
from fem_reference.solid.discrete import DiscreteSolid
from fem_reference.solid.element import reference, shape
from fem_reference.solid.materials import lame
from fem_reference.surface.materials import section_of
from fem_reference.surface.mesh import rectangle
from fem_reference.verification.rows import Row, convergence
from fem_reference.verification.specimens import linear_step, specimen, supports
from sheetbench.numerics.direct import DirectSolver
from sheetbench.scenes import Clamped, Material, Scene, Sheet

ORDER = 3.0
LARGEST = {"deflection": 5e-4, "tilt": 1.2e-3, "block": 1e-3}  # error on the finest mesh
ELEMENTS, BRICKS = (8, 16), (4, 8)
RATIOS = (0.001, 0.1)  # h/L
MATERIAL = Material(young=1e7, poisson=0.3, density=1000.0)
MODELS: dict[str, type[DiscreteShell]] = {"plate": DiscretePlate, "shell": DiscreteShell}

BLOCK = Sheet(length_x=1.0, length_y=1.0, thickness=0.5)
SIZE = np.array([1.0, -0.7, 0.8])
WAVE = np.array([[2.0, 1.0, -0.5], [0.7, -1.8, 1.2], [1.1, 0.6, 2.1]])
WAVES = {0.3: WAVE, 0.4999: WAVE - np.diag(np.diag(WAVE))}  # by Poisson's ratio
PHASE = np.array([0.3, 1.1, -0.4])

Field = Callable[[np.ndarray, np.ndarray], np.ndarray]


def plate() -> Iterator[Row]:
    """Yield errors on the finest mesh, and the order of the last refinement, of plate and shell."""
    for model in MODELS:
        for ratio in RATIOS:
            scene = specimen(Sheet(1.0, 1.0, ratio), MATERIAL, supports(Clamped))
            errors = np.transpose([_errors(model, scene, n) for n in ELEMENTS])
            mesh = f"{model} {ELEMENTS[-1]} × {ELEMENTS[-1]}"
            for name, of_field in zip(("deflection", "tilt"), errors, strict=True):
                of = f"in L², {name} at h/L = {ratio:g}"
                yield from convergence(of, mesh, of_field, LARGEST[name], ORDER, "Chinosi & Lovadina 1995")


def solid() -> Iterator[Row]:
    """Yield the error on the finest mesh, and the order of the last refinement."""
    mesh = f"solid {BRICKS[-1]} × {BRICKS[-1]} × {BRICKS[-1] // 2}"
    for poisson in WAVES:
        errors = [_block_error(poisson, n) for n in BRICKS]
        yield from convergence(f"in L² at ν = {poisson:g}", mesh, errors, LARGEST["block"], ORDER)


def _errors(model: str, scene: Scene, elements: int) -> tuple[float, float]:
    """Return relative errors in L² of deflection and tilt along x on elements × elements. The answer is the
    first linear step from the flat sheet."""
    sheet = MODELS[model](rectangle(scene.sheet, elements), scene)
    basis, (pressure, deflection, tilt) = Basis(sheet.plan.mesh, ElementQuad2()), _fields(scene)
    upwards = LinearForm(lambda v, w: pressure(*w.x) * v).assemble(basis)
    force = sheet.on_coordinates(np.outer(upwards, [0.0, 0.0, 1.0]))
    moved, turned = linear_step(sheet, force).reshape(2, -1, 3)

    def error(nodal: np.ndarray, exact: Field) -> float:
        off = Functional(lambda w: (w.u - exact(*w.x)) ** 2).assemble(basis, u=basis.interpolate(nodal))
        return float(np.sqrt(off / Functional(lambda w: exact(*w.x) ** 2).assemble(basis)))

    return error(moved[:, 2], deflection), error(turned[:, 0], tilt)


def _fields(scene: Scene) -> tuple[Field, Field, Field]:
    """Return p [Pa], w [m] and the tilt of the director along x, as functions of x and y."""
    thick = scene.sheet.thickness
    by_shear = 2.0 * thick**2 / (5.0 * (1.0 - scene.material.poisson))
    rigidity = section_of(scene.material, thick).bending[0, 0]

    def b(t: np.ndarray, power: int) -> np.ndarray:
        return t**power * (t - 1.0) ** power

    def q(t: np.ndarray) -> np.ndarray:
        return 5.0 * t**2 - 5.0 * t + 1.0

    def g(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return 12.0 * b(y, 1) * q(x) * (2.0 * b(y, 2) + b(x, 1) * q(y))

    def deflection(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        shear = b(y, 3) * b(x, 1) * q(x) + b(x, 3) * b(y, 1) * q(y)
        return b(x, 3) * b(y, 3) / 3.0 - by_shear * shear

    return (
        lambda x, y: rigidity * (g(x, y) + g(y, x)),
        deflection,
        lambda x, y: -b(y, 3) * b(x, 2) * (2.0 * x - 1.0),
    )


def _block_error(poisson: float, elements: int) -> float:
    """Return the relative error in L² on elements × elements × elements/2 bricks."""
    waves, material = WAVES[poisson], Material(young=1.0, poisson=poisson, density=1.0)
    scene = Scene(name="manufactured", sheet=BLOCK, material=material)
    sheet = DiscreteSolid(rectangle(BLOCK, elements), scene, layers=elements // 2)
    bricks, rest, (lame_first, lame_second) = sheet.element, np.zeros(sheet.size), lame(material)

    def exact(points: np.ndarray) -> np.ndarray:
        return SIZE * np.sin(points @ waves.T + PHASE)

    values, volumes = shape(reference().points)[0], bricks.volumes[..., None]
    points = values.T @ bricks.positions  # (m, q, 3)
    u = exact(points)
    body_force = (lame_first + lame_second) * (u * np.diag(waves)) @ waves
    body_force += lame_second * np.sum(waves**2, axis=1) * u
    force = sheet.scatter(values @ (volumes * body_force))
    positions = sheet.columns.positions.reshape(-1, 3)
    inside = np.all(np.abs(positions - [0.5, 0.5, 0.0]) < np.array([0.5, 0.5, 0.25]) - 1e-9, axis=1)
    displacement, free = np.where(inside[:, None], 0.0, exact(positions)).ravel(), np.repeat(inside, 3)
    matrix = sheet.tangent(sheet.shape(rest, 0.0), rest, 0.0, 0.0)[free]
    displacement[free] = DirectSolver().factor(matrix[:, free]).solve(force[free] - matrix @ displacement)
    off = values.T @ sheet.gather(displacement) - u
    return float(np.sqrt(np.sum(volumes * off**2) / np.sum(volumes * u**2)))
