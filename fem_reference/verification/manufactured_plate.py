"""A manufactured solution of the clamped Mindlin square: errors of plate and linear shell, and their order.

With q(t) = 5t² − 5t + 1, b_n(t) = tⁿ (t − 1)ⁿ and side 1, the pressure

    p = E h³/12(1 − ν²) (g(x, y) + g(y, x)),    g = 12 b₁(y) q(x) (2 b₂(y) + b₁(x) q(y))

bends the plate to the deflection w and the director's tilt β

    w = b₃(x) b₃(y)/3 − 2h²/(5(1 − ν)) (b₃(y) b₁(x) q(x) + b₃(x) b₁(y) q(y)),
    β = −(b₃(y) b₂(x) (2x − 1), b₃(x) b₂(y) (2y − 1)).

Biquadratic fields: order 3. Source: Chinosi & Lovadina, Comput. Mech. 16 (1995) 36–44.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from skfem import Basis, ElementQuad2, Functional, LinearForm

from fem_reference.discrete.items import Dead
from fem_reference.discrete.static import Static
from fem_reference.plate.discrete import DiscretePlate
from fem_reference.shell.discrete import DiscreteShell
from fem_reference.surface.materials import bending_stiffness
from fem_reference.surface.mesh import rectangle
from fem_reference.verification.rows import Row, convergence
from fem_reference.verification.specimens import around, specimen
from sheetbench.numerics.direct import DirectSolver
from sheetbench.scenes import Clamped, Material, Scene, Sheet

SOURCE = "Chinosi & Lovadina 1995"
ORDER = 3.0
LARGEST = {"deflection": 5e-4, "tilt": 1.2e-3}  # error on the finest mesh
ELEMENTS = (8, 16)
RATIOS = (0.001, 0.1)  # h/L
MATERIAL = Material(young=1e7, poisson=0.3, density=1000.0)
MODELS: dict[str, type[DiscreteShell]] = {"plate": DiscretePlate, "shell": DiscreteShell}


def rows() -> Iterator[Row]:
    """Errors on the finest mesh, and the order of the last refinement, of plate and shell."""
    for model in MODELS:
        for ratio in RATIOS:
            scene = specimen(Sheet(1.0, 1.0, ratio), MATERIAL, around(Clamped))
            errors = zip(*(errors_on(model, scene, n) for n in ELEMENTS), strict=True)
            mesh = f"{model} {ELEMENTS[-1]} × {ELEMENTS[-1]}"
            for (name, largest), of_field in zip(LARGEST.items(), errors, strict=True):
                of = f"in L², {name} at h/L = {ratio:g}"
                yield from convergence(of, mesh, of_field, largest, ORDER, SOURCE)


def errors_on(model: str, scene: Scene, elements: int) -> tuple[float, float]:
    """Relative errors in L² of deflection and tilt along x, of the first linear step from the flat sheet on
    elements × elements."""
    sheet = MODELS[model](rectangle(scene.sheet, elements), scene)
    basis, static = Basis(sheet.plan.mesh, ElementQuad2()), Static(sheet)
    density = pressure(scene)
    upwards = LinearForm(lambda v, w: density(*w.x) * v).assemble(basis)
    force = np.outer(upwards, [0.0, 0.0, 1.0])
    sheet.items.append(Dead(sheet.on_coordinates(force), None))
    rest = static.rest()
    forces = static.forces(rest, 1.0)
    matrix, right = static.linearised(rest, forces, 1.0, mixed=False)
    step = DirectSolver().factor(matrix).solve(right)
    moved, turned = static.advance(rest, forces, 1.0, step).q.reshape(2, -1, 3)

    def error(nodal: np.ndarray, exact: Callable[..., np.ndarray]) -> float:
        off = Functional(lambda w: (w.u - exact(*w.x)) ** 2).assemble(basis, u=basis.interpolate(nodal))
        return float(np.sqrt(off / Functional(lambda w: exact(*w.x) ** 2).assemble(basis)))

    return error(moved[:, 2], deflection(scene)), error(turned[:, 0], tilt_x)


def _bubble(t: np.ndarray, power: int) -> np.ndarray:
    return t**power * (t - 1.0) ** power


def _quadratic(t: np.ndarray) -> np.ndarray:
    return 5.0 * t**2 - 5.0 * t + 1.0


def deflection(scene: Scene) -> Callable[..., np.ndarray]:
    """w(x, y) [m]."""
    by_shear = 2.0 * scene.sheet.thickness**2 / (5.0 * (1.0 - scene.material.poisson))

    def w(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        shear = _bubble(y, 3) * _bubble(x, 1) * _quadratic(x) + _bubble(x, 3) * _bubble(y, 1) * _quadratic(y)
        return _bubble(x, 3) * _bubble(y, 3) / 3.0 - by_shear * shear

    return w


def tilt_x(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """The tilt of the director along x."""
    return -_bubble(y, 3) * _bubble(x, 2) * (2.0 * x - 1.0)


def pressure(scene: Scene) -> Callable[..., np.ndarray]:
    """p(x, y) [Pa]."""
    rigidity = bending_stiffness(scene.material, scene.sheet.thickness)[0, 0]

    def half(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return 12.0 * _bubble(y, 1) * _quadratic(x) * (2.0 * _bubble(y, 2) + _bubble(x, 1) * _quadratic(y))

    return lambda x, y: rigidity * (half(x, y) + half(y, x))
